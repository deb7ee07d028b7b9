import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hsr8
from hsr8.errors import UsageError
from hsr8.plugin_decisions import PluginGaze, PluginPlanner
from hsr8.robot_builder import decision_limits, field_of_view, known_beacons, neck
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout
from navigation.baselines.choice import build_planner
from navigation.decision import GazeDecision, MotionDecision
from navigation.gaze.planner import GazePlanner

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=3.0"]
FORMS = (list, tuple, np.array, lambda values: np.array(values, np.float32))
LIMITS = decision_limits(hsr8.load_scenario("quick"))
speeds = st.floats(-1.0, 1.0, width=32)


class Fixed:
    """Planner and gaze with a constant decision."""

    def __init__(self, decision):
        self.decision = decision

    def plan(self, belief, task):
        return self.decision

    def choose(self, belief, task, motion):
        return self.decision


class Empty(Fixed, list):
    """Falsy, as every empty container."""


class InPlace:
    """Modifies its arguments in place."""

    def plan(self, belief, task):
        task.target[:] -= belief.pose[:2]
        belief.pose[:] = 9.0
        belief.pose_covariance[:] = 9.0
        for track in belief.tracks:
            track.position[:] += 1.0
        return MotionDecision(np.zeros(3))

    def choose(self, belief, task, motion):
        self.plan(belief, task)
        motion.velocity[:] = 9.0
        return GazeDecision(0.0, 0.0)


def quick(*settings):
    return hsr8.load_scenario("quick", [*STAND_INS, *settings])


@given(values=st.tuples(speeds, speeds, speeds), form=st.sampled_from(FORMS))
def test_a_velocity_of_any_sequence_type_is_accepted_exactly(values, form):
    planner = PluginPlanner(Fixed(MotionDecision(form(values), np.float32(0.5))), LIMITS)
    motion = planner.plan(None, None)
    assert motion.velocity.dtype == np.float64
    assert tuple(motion.velocity) == values
    assert type(motion.direction) is float


@given(pan=speeds, number=st.sampled_from((float, np.float32, np.float64, np.array)))
def test_a_scalar_gaze_is_accepted_exactly_and_an_array_refused(pan, number):
    gaze = PluginGaze(Fixed(GazeDecision(number(pan), 0)), LIMITS)
    if number is np.array:
        with pytest.raises(UsageError, match="pan"):
            gaze.choose(None, None, None)
    else:
        decision = gaze.choose(None, None, None)
        assert (decision.pan, decision.tilt) == (pan, 0.0)
        assert {type(decision.pan), type(decision.tilt)} == {float}


@pytest.mark.parametrize(
    "velocity",
    [
        [0.1, 0.0],
        np.zeros((1, 3)),
        [np.nan, 0.0, 0.0],
        [np.inf, 0.0, 0.0],
        [1j, 0.0, 0.0],
        [None, 0.0, 0.0],
        [[0.1], 0.0, 0.0],
        "abc",
        None,
    ],
)
def test_an_invalid_velocity_is_refused_with_the_expected_one(velocity):
    with pytest.raises(UsageError, match=r"Fixed: velocity must be .*vx, vy and wz \[m/s"):
        PluginPlanner(Fixed(MotionDecision(velocity)), LIMITS).plan(None, None)


@pytest.mark.parametrize(
    ("decision", "expected"),
    [
        (None, "must return a MotionDecision, got NoneType"),
        (np.zeros(3), "must return a MotionDecision, got ndarray of shape"),
        (MotionDecision(np.zeros(3), direction=None), "direction"),
        (MotionDecision(np.zeros(3), speed=np.nan), "speed"),
        (MotionDecision(np.zeros(3), situation=None), "situation"),
        (MotionDecision(np.zeros(3), field=object()), "field"),
    ],
)
def test_an_invalid_motion_is_refused(decision, expected):
    with pytest.raises(UsageError, match=f"planner Fixed: .*{expected}"):
        PluginPlanner(Fixed(decision), LIMITS).plan(None, None)


@pytest.mark.parametrize(
    ("decision", "expected"),
    [
        ((0.0, 0.0), "must return a GazeDecision, got tuple"),
        (GazeDecision(np.nan, 0.0), "pan"),
        (GazeDecision(0.0, "up"), "tilt"),
        (GazeDecision(0.0, 0.0, psi_ob=np.inf), "psi_ob"),
        (GazeDecision(0.0, 0.0, gaze_map=None), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=np.ones(3)), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=np.full((2, 2), np.nan)), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=-np.ones((2, 2))), "gaze_map"),
    ],
)
def test_an_invalid_gaze_is_refused(decision, expected):
    with pytest.raises(UsageError, match=f"gaze Fixed: .*{expected}"):
        PluginGaze(Fixed(decision), LIMITS).choose(None, None, None)


def test_arithmetic_in_place_changes_neither_belief_nor_mission(fake):
    frame, other = fake.frame(0.0), fake.frame(0.0)
    PluginPlanner(InPlace(), LIMITS).plan(frame.belief, frame.task)
    PluginGaze(InPlace(), LIMITS).choose(frame.belief, frame.task, frame.motion)
    assert np.array_equal(frame.belief.pose, other.belief.pose)
    assert np.array_equal(frame.belief.pose_covariance, other.belief.pose_covariance)
    assert np.array_equal(frame.task.target, other.task.target)
    assert np.array_equal(frame.motion.velocity, other.motion.velocity)
    for track, same in zip(frame.belief.tracks, other.belief.tracks, strict=True):
        assert np.array_equal(track.position, same.position)


def test_the_built_in_planner_and_gaze_decide_the_same_as_plugins():
    scenario, seed = quick(), 4
    layout, limits = draw_layout(scenario, seed), scenario.speed_limits()
    planner = build_planner(scenario.navigation, limits, named_rng(seed, "planner"))
    fov = field_of_view(scenario)
    beacons = known_beacons(scenario, layout)
    gaze = GazePlanner(scenario.navigation, limits, beacons, fov, neck(scenario))
    plugins = hsr8.run(scenario, seed=seed, planner=planner, gaze=gaze)
    assert plugins.metrics["state_hash"] == hsr8.run(scenario, seed=seed).metrics["state_hash"]


def test_a_falsy_planner_is_used():
    planner = Empty(MotionDecision(np.zeros(3)))
    assert not planner
    assert hsr8.run(quick(), seed=4, planner=planner).metrics["path_length_m"] < 0.01


@pytest.mark.parametrize("kind", ["planner", "gaze", "walker"])
def test_an_unsuitable_object_is_refused_before_the_run(kind, tmp_path):
    for plugin, expected in ((Fixed, rf"{kind}=Fixed\(\)"), (object(), "has no method")):
        with pytest.raises(UsageError, match=expected):
            hsr8.run(quick(), out=tmp_path, **{kind: plugin})
    assert list(tmp_path.iterdir()) == []


def test_a_walk_takes_no_planner():
    with pytest.raises(UsageError, match="section command"):
        hsr8.run("walk", settings=STAND_INS, planner=Fixed(None))


class Started(Fixed):
    """Planner and gaze that receive the limits."""

    def start(self, limits):
        self.limits = limits


def test_a_planner_and_a_gaze_receive_the_limits_before_the_run():
    planner, gaze = (
        Started(MotionDecision(np.zeros(3))),
        Started(GazeDecision(0.0, 0.0)),
    )
    hsr8.run("quick", settings=["duration=0.1", *STAND_INS[:2]], planner=planner, gaze=gaze)
    assert planner.limits.speed == hsr8.load_scenario("quick").speed_limits()
    assert gaze.limits.neck == pytest.approx(np.radians([[-90.0, 90.0], [-60.0, 20.0]]), abs=1e-4)


def test_a_start_that_fails_is_reported():
    planner = Started(MotionDecision(np.zeros(3)))
    planner.start = lambda limits: 1 / 0
    with pytest.raises(UsageError, match="planner Started: start failed: ZeroDivisionError: div"):
        PluginPlanner(planner, LIMITS)
