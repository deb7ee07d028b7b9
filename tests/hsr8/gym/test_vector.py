"""Environments in processes, and the environment checker of stable-baselines3."""

import importlib
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import hsr8
from hsr8.errors import UsageError
from hsr8.gym import Environment, as_gaze

SETTINGS = ["robot.body=kinematic", "camera.source=analytic", "duration=1.0"]


def test_without_gymnasium_the_extra_is_named(monkeypatch):
    for name in [name for name in sys.modules if name.startswith("hsr8.gym")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(ImportError, match=r"hsr8\.gym: .*gymnasium.*; pip install -e '\.\[gym\]'"):
        importlib.import_module("hsr8.gym")


@pytest.mark.timeout(300)
def test_processes_run_the_seeds_of_their_environments():
    vector_options = {"context": "forkserver", "autoreset_mode": AutoresetMode.SAME_STEP}
    envs = gymnasium.make_vec(
        "hsr8.gym:hsr8/Gaze-v0",
        2,
        vectorization_mode="async",
        vector_kwargs=vector_options,
        scenario="quick",
        settings=SETTINGS,
    )
    try:
        envs.reset(seed=[4, 5])
        ended = np.zeros(2, bool)
        while not ended.any():
            _, _, terminated, truncated, infos = envs.step(np.zeros((2, 2), np.float32))
            ended = terminated | truncated
    finally:
        envs.close()
    gaze = hsr8.gym.as_gaze(lambda: lambda _: np.zeros(2))
    expected = [
        hsr8.run("quick", seed=seed, settings=SETTINGS, gaze=gaze()).metrics["state_hash"]
        for seed in (4, 5)
    ]
    assert infos["final_info"]["metrics"]["state_hash"].tolist() == expected


def test_stable_baselines3_has_no_complaint():
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    for decides in (("gaze",), ("motion",), ("motion", "gaze")):
        env = Environment("quick", decides=decides, settings=SETTINGS, observe=["local_map"])
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)
            warnings.filterwarnings("ignore", ".*unconventional shape")  # of the tracks (n, 9)
            checker.check_env(env)
        env.close()


FAST = {"robot.body": "kinematic", "camera.source": "analytic"}
COMMON = [
    ({"observe": ["local-map"]}, UsageError, "observe: .*got 'local-map'.*did you mean 'local_map"),
    ({"max_tracks": 0}, UsageError, "max_tracks: out of range, got 0; expected at least 1"),
    ({"normalised": True}, TypeError, "normalised"),
]


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        *COMMON,
        ({"decides": ["look"]}, UsageError, "decides: .*got 'look'; expected motion, gaze"),
        ({"reward": {"speed": 1.0}}, UsageError, "reward: .*got 'speed'; expected progress, time"),
    ],
)
def test_an_environment_refuses_an_invalid_option(options, error, message):
    with pytest.raises(error, match=message):
        gymnasium.make("hsr8.gym:hsr8/Gaze-v0", **({"settings": FAST} | options))


@pytest.mark.parametrize("plugin", [as_gaze])
@pytest.mark.parametrize(("options", "error", "message"), COMMON)
def test_a_plugin_refuses_an_invalid_option(plugin, options, error, message):
    with pytest.raises(error, match=message):
        plugin(lambda _: np.zeros(5), **options)


def test_a_run_may_follow_a_refused_reset():
    env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=FAST)
    with pytest.raises(UsageError, match="seed"):
        env.reset(seed=2**63)
    with pytest.raises(RuntimeError, match="expected reset"):
        env.step(np.zeros(2, np.float32))
    env.reset(seed=1)
    observation, *_ = env.step(np.zeros(2, np.float32))
    assert observation in env.observation_space
    env.close()
