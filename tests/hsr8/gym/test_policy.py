"""Policies as plugins, compared with the same actions in the environments."""

import gymnasium
import numpy as np
import pytest

import hsr8
from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.gym import as_gaze, as_planner

SETTINGS = ["robot.body=kinematic", "camera.source=analytic", "duration=3.0"]
WEIGHTS = np.random.default_rng(1).normal(size=(8, 5))


def features(observation):
    parts = [observation["head"], observation["target"], observation["velocity"]]
    return np.concatenate(parts)


class Model:
    """Policy with the interface of stable-baselines3 that counts its calls in its state."""

    def __init__(self, columns=slice(None)):
        self.columns = columns

    def predict(self, observation, state=None, episode_start=None, deterministic=False):
        assert deterministic
        assert bool(episode_start[0]) is (state is None)
        calls = 0 if state is None else state
        values = np.tanh(features(observation) @ WEIGHTS) * np.cos(0.1 * calls)
        return values[self.columns].astype(np.float32), calls + 1


def joint(observation):
    """Policy without a state that decides motion and gaze."""
    return np.tanh(features(observation) @ WEIGHTS)


def state_hash(name, predict, settings, **options):
    """Return the hash of an episode with the actions of a policy."""
    env = gymnasium.make(f"hsr8.gym:hsr8/{name}-v0", scenario="crowd", settings=settings, **options)
    observation, _ = env.reset(seed=4)
    ended = False
    while not ended:
        observation, _, *ends, info = env.step(predict(observation))
        ended = any(ends)
    env.close()
    return info["metrics"]["state_hash"]


def stateful(model):
    state = None

    def predict(observation):
        nonlocal state
        start = np.array([state is None])
        action, state = model.predict(observation, state, start, deterministic=True)
        return action

    return predict


@pytest.mark.parametrize("settings", [[*SETTINGS, "camera.latency_ms=30"]])
def test_a_gaze_is_the_same_in_both(settings):
    expected = state_hash("Gaze", stateful(Model(slice(3, 5))), settings)
    gaze = as_gaze(lambda: Model(slice(3, 5)))()
    native = hsr8.run("crowd", seed=4, settings=settings, gaze=gaze)
    assert native.metrics["state_hash"] == expected


def test_both_decisions_of_a_policy_are_the_same_in_both():
    expected = state_hash("GazeAndNavigate", joint, SETTINGS, max_tracks=2)
    plugins = {"planner": as_planner(joint)(), "gaze": as_gaze(lambda: joint)()}
    native = hsr8.run("crowd", seed=4, settings=SETTINGS, **plugins)
    assert native.metrics["state_hash"] == expected


def test_a_file_with_a_policy_takes_part_in_commands(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(
        "import hsr8.gym\n"
        "def load():\n"
        "    return lambda observation: -0.5 * observation['head'] - 0.2\n"
        "Mine = hsr8.gym.as_gaze(load)\n"
    )
    words = ["--body", "kinematic", "--camera", "analytic", "--duration", "3"]
    assert entry(["run", "quick", *words, "--set", "plugin.gaze=mine.py:Mine"]) in (0, 1)
    assert entry(["verify", "runs/quick", "--trust"]) == 0
    assert capsys.readouterr().out.count("bit for bit") == 3


@pytest.mark.parametrize(
    ("policy", "message"),
    [
        (lambda: 3, "policy: got int 3; expected an object with predict"),
        (
            lambda: lambda _: np.zeros(3),
            "action: .*ndarray of shape .*expected 2 or 5 finite numbers",
        ),
    ],
)
def test_invalid_policies_are_refused(policy, message):
    with pytest.raises(UsageError, match=message):
        hsr8.run("quick", settings=SETTINGS, gaze=as_gaze(policy)())


def test_images_are_refused():
    with pytest.raises(UsageError, match="observe: plugins receive the belief, got 'image'"):
        as_gaze(joint, observe=["image"])
