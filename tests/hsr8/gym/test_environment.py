"""Gymnasium environments, compared with native runs."""

import warnings
from math import sin

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from numba.core import event

import hsr8
from hsr8.errors import UsageError
from hsr8.gym import Environment
from navigation.decision import GazeDecision, MotionDecision

FAST = ["robot.body=kinematic", "camera.source=analytic"]
RENDERED = [FAST[0], "duration=2.0"]


@pytest.fixture
def make():
    made = []

    def environment(name="Gaze", scenario="quick", settings=FAST, **options):
        arguments = {"scenario": scenario, "settings": settings, **options}
        made.append(gymnasium.make(f"hsr8.gym:hsr8/{name}-v0", **arguments))
        return made[-1]

    yield environment
    for env in made:
        env.close()


def test_an_environment_that_is_not_closed_leaves_no_listener_of_compilations():
    def listeners():
        return sum(map(len, event._registered.values()))

    gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=FAST).reset(seed=4)
    before = listeners()
    gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=FAST).reset(seed=4)
    assert listeners() == before


def play(env, policy, seed=4):
    """Return the observations, rewards and the last step of a run."""
    observation, info = env.reset(seed=seed)
    observations, rewards = [observation], []
    while True:
        observation, reward, *ends, info = env.step(policy(observation, info))
        observations.append(observation)
        rewards.append(reward)
        if any(ends):
            return observations, rewards, ends, info


def without_times(metrics):
    """Return the metrics that do not depend on the speed of the machine."""
    measured = ("wall_time", "real_time", "walk_tick")
    return {key: value for key, value in metrics.items() if not key.startswith(measured)}


class Clock:
    """Decisions by the number of calls: as actions, and as a planner and gaze."""

    def __init__(self):
        self.calls = 0

    def gaze(self, *_):
        self.calls += 1
        return np.array([sin(0.3 * self.calls), -0.4])

    def motion(self, *_):
        self.calls += 1
        return np.array([0.1, 0.02, 0.4 * sin(0.3 * self.calls)])

    def choose(self, belief, task, motion):
        return GazeDecision(*self.gaze(belief).tolist())

    def plan(self, belief, task):
        return MotionDecision(velocity=self.motion(belief))


def test_the_checker_has_no_complaint(make):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = make("GazeAndNavigate", observe=["local_map"])
        check_env(env.unwrapped)


@pytest.mark.gl
def test_the_checker_has_no_complaint_about_images(make):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = make(settings=RENDERED, observe=["image"], render_mode="rgb_array")
        check_env(env.unwrapped)
    first, _ = env.reset(seed=4)
    assert first["image"].shape == (240, 320, 3)
    before = env.render()
    for _ in range(8):
        env.step(np.array([1.0, 0.0], np.float32))
    assert before.shape == (480, 640, 3)
    assert before.std() > 10.0
    assert not np.array_equal(before, env.render())


@pytest.mark.parametrize(
    "settings",
    [
        pytest.param([*FAST, "duration=2.5", "camera.latency_ms=30"], id="latency"),
    ],
)
def test_the_same_decisions_are_the_same_run(make, settings):
    native = hsr8.run("quick", seed=4, settings=settings, gaze=Clock())
    *_, info = play(make(settings=settings, normalized=False), Clock().gaze)
    assert without_times(info["metrics"]) == without_times(native.metrics)


def test_the_velocity_of_an_action_counts_at_footsteps(make):
    settings = [*FAST, "duration=3.0"]
    native = hsr8.run("quick", seed=4, settings=settings, planner=Clock(), gaze=Clock())
    look, motion = Clock(), Clock()
    last = np.zeros(3)

    def both(observation, info):
        nonlocal last
        if info["motion_due"]:
            last = motion.motion(observation)
        return np.concatenate([last, look.gaze(observation)])

    env = make("GazeAndNavigate", settings=settings, normalized=False)
    *_, info = play(env, both)
    assert info["metrics"]["state_hash"] == native.metrics["state_hash"]


def test_zero_is_standing_and_the_middle_of_the_neck(make):
    env = make("GazeAndNavigate", settings=[*FAST, "duration=3.0"])
    *_, info = play(env, lambda *_: np.zeros(5, np.float32))
    observations, *_ = play(env, lambda *_: np.array([1.0, -1.0, 0.0, 1.0, -1.0], np.float32))
    assert info["metrics"]["path_length_m"] < 0.02
    assert observations[-1]["velocity"] == pytest.approx([0.2, -0.08, 0.0])
    assert observations[-1]["head"] == pytest.approx([np.pi / 2, -np.pi / 3], abs=0.05)


def test_observations_are_within_the_space_and_fresh(make):
    env = make(
        "GazeAndNavigate", settings=[*FAST, "duration=2.0"], scenario="crowd", observe=["local_map"]
    )
    env.action_space.seed(1)
    observations, rewards, *_ = play(env, lambda *_: env.action_space.sample())
    assert all(observation in env.observation_space for observation in observations)
    assert any(observation["track_mask"].any() for observation in observations)
    arrays = [id(array) for observation in observations for array in observation.values()]
    assert len(set(arrays)) == len(arrays)
    assert np.isfinite(rewards).all()


def test_tracks_are_in_the_frame_of_the_robot_nearest_first(make):
    env = make(scenario="crowd", settings=[*FAST, "duration=2.0"], max_tracks=3)
    observations, _, _, info = play(env, lambda *_: np.zeros(2, np.float32))
    assert observations[-1]["tracks"].shape == (3, 9)
    tracks = observations[-1]["tracks"][observations[-1]["track_mask"] == 1]
    distances = np.hypot(*tracks[:, :2].T)
    assert len(tracks)
    assert (np.diff(distances) >= 0.0).all()
    x, y, heading = info["truth"]["robot"]
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    believed = tracks[:, :2] @ turn.T + (x, y)
    errors = np.hypot(*(believed[:, None] - info["truth"]["obstacle_positions"]).T)
    assert errors.min(axis=0).max() < 0.3


def test_a_seed_is_that_of_a_run_and_layouts_differ_reproducibly(make):
    def robots(env, first):
        infos = [env.reset(seed=first)[1], *(env.reset()[1] for _ in range(2))]
        return [info["seed"] for info in infos], [
            tuple(info["truth"]["obstacle_positions"].ravel().tolist()) for info in infos
        ]

    seeds, layouts = robots(make(), 7)
    assert seeds[0] == 7
    assert len(set(layouts)) == len(set(seeds)) == 3
    assert robots(make(), 7) == (seeds, layouts)
    assert robots(make(), 8)[1][1:] != layouts[1:]


def test_a_goal_is_a_success(make):
    _, rewards, ends, info = play(make(), lambda *_: np.zeros(2, np.float32), seed=2)
    assert ends == [True, False]
    assert info["exit_reason"] == "goal"
    assert info["is_success"] is info["metrics"]["success"] is True
    assert info["reward_terms"]["outcome"] == 5.0
    assert 2.0 < sum(rewards) < 8.0


def test_a_contact_is_a_failure_unless_runs_go_on(make):
    ahead = np.array([1.0, 0.0, 0.0], np.float32)
    _, _, ends, info = play(make("Navigate", "dense"), lambda *_: ahead, seed=1)
    assert ends == [True, False]
    assert info["exit_reason"] == "contact"
    assert not info["is_success"]
    assert info["metrics"]["collisions"] == 1
    assert info["reward_terms"]["outcome"] == -5.0
    time = info["time"]
    env = make("Navigate", "dense", [*FAST, f"duration={time + 0.5}"], end_on_contact=False)
    _, _, ends, info = play(env, lambda *_: ahead, seed=1)
    assert ends == [False, True]
    assert info["exit_reason"] == "timeout"
    assert info["metrics"]["collisions"] >= 1


def test_a_fall_is_a_failure(make):
    push = 'fault=[{kind="push",start=0.8,magnitude=4.0,direction_deg=0}]'
    env = make(settings=["camera.source=analytic", "duration=6.0", push])
    _, _, ends, info = play(env, lambda *_: np.zeros(2, np.float32))
    assert ends == [True, False]
    assert info["exit_reason"] == "fall"
    assert info["reward_terms"]["outcome"] == -5.0


def test_weights_of_the_reward(make):
    weights = {"progress": 2.0, "time": 0.0, "tracking": 0.0}
    settings = [*FAST, "duration=1.5"]
    _, default, *_ = play(make(settings=settings), lambda *_: np.zeros(2, np.float32))
    _, given, _, info = play(
        make(settings=settings, reward=weights), lambda *_: np.zeros(2, np.float32)
    )
    assert set(info["reward_terms"]) == {"progress", "time", "tracking", "outcome"}
    assert sum(given) > 2.0 * sum(default)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"render_mode": "ansi"}, UsageError, r"render_mode: .*got 'ansi'; expected rgb_array"),
        ({"name": "Navigate", "scenario": "walk"}, UsageError, r"mission\.kind = 'walk'"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*render_mode")
def test_invalid_arguments_are_refused(make, options, error, message):
    with pytest.raises(error, match=message):
        make(**options)


def test_actions_are_clipped_to_the_space(make):
    settings = [*FAST, "duration=1.2"]
    for name, size in (("Gaze", 2), ("Navigate", 3)):
        runs = [
            play(make(name, settings=settings), lambda *_, k=k, n=size: np.full(n, k))[3]
            for k in (1.0, 7.5)
        ]
        assert runs[0]["metrics"]["state_hash"] == runs[1]["metrics"]["state_hash"]


def test_actions_of_another_shape_or_not_finite_are_refused():
    env = Environment("quick", decides=("gaze",), settings=FAST)
    with pytest.raises(RuntimeError, match=r"step: no run has begun; expected reset"):
        env.step(np.zeros(2))
    env.reset(seed=1)
    for action in ([0.0, np.nan], [0.0, np.inf], [0.0], "left"):
        with pytest.raises(UsageError, match=r"action: got .*; expected 2 finite numbers"):
            env.step(action)
    env.close()


@pytest.mark.gl
def test_an_image_from_outside_is_the_same_until_the_next_step(make):
    env = make(settings=RENDERED, render_mode="rgb_array")
    env.reset(seed=1)
    for _ in range(5):
        env.step(env.action_space.high)
    image = env.render()
    for _ in range(3):
        assert np.array_equal(env.render(), image)
