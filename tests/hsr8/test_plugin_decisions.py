import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hsr8
from hsr8.errors import UsageError
from hsr8.plugin_decisions import PluginGaze, PluginPlanner
from hsr8.robot_builder import field_of_view, head_camera, known_beacons
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout
from navigation.baselines.choice import build_planner
from navigation.decision import GazeDecision, MotionDecision
from navigation.gaze.planner import GazePlanner

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=3.0"]
FORMS = (list, tuple, np.array, lambda values: np.array(values, np.float32))
speeds = st.floats(-1.0, 1.0, width=32)


class Says:
    """Planner and gaze that always answer the same."""

    def __init__(self, answer):
        self.answer = answer

    def plan(self, belief, task):
        return self.answer

    def choose(self, belief, task, motion):
        return self.answer


class Empty(Says, list):
    """Is false, as everything of length zero."""


class Computes:
    """Does its arithmetic in place."""

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
def test_a_velocity_arrives_as_it_was_meant_in_any_form(values, form):
    planner = PluginPlanner(Says(MotionDecision(form(values), np.float32(0.5))))
    motion = planner.plan(None, None)
    assert motion.velocity.dtype == np.float64
    assert tuple(motion.velocity) == values
    assert type(motion.direction) is float


@given(pan=speeds, number=st.sampled_from((float, np.float32, np.float64, np.array)))
def test_a_gaze_arrives_as_it_was_meant_or_not_at_all(pan, number):
    gaze = PluginGaze(Says(GazeDecision(number(pan), 0)))
    if number is np.array:
        with pytest.raises(UsageError, match="pan"):
            gaze.choose(None, None, None)
    else:
        found = gaze.choose(None, None, None)
        assert (found.pan, found.tilt) == (pan, 0.0)
        assert {type(found.pan), type(found.tilt)} == {float}


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
def test_what_is_no_velocity_is_refused_with_what_it_should_be(velocity):
    with pytest.raises(UsageError, match=r"Says: velocity must be .*vx, vy and wz \[m/s"):
        PluginPlanner(Says(MotionDecision(velocity))).plan(None, None)


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        (None, "no MotionDecision but NoneType"),
        (np.zeros(3), "no MotionDecision but ndarray of shape"),
        (MotionDecision(np.zeros(3), direction=None), "direction"),
        (MotionDecision(np.zeros(3), speed=np.nan), "speed"),
        (MotionDecision(np.zeros(3), situation=None), "situation"),
        (MotionDecision(np.zeros(3), look_request=np.inf), "look_request"),
        (MotionDecision(np.zeros(3), field=object()), "field"),
    ],
)
def test_what_is_no_motion_is_refused(answer, told):
    with pytest.raises(UsageError, match=f"the planner Says: .*{told}"):
        PluginPlanner(Says(answer)).plan(None, None)


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        ((0.0, 0.0), "no GazeDecision but tuple"),
        (GazeDecision(np.nan, 0.0), "pan"),
        (GazeDecision(0.0, "up"), "tilt"),
        (GazeDecision(0.0, 0.0, psi_ob=np.inf), "psi_ob"),
        (GazeDecision(0.0, 0.0, gaze_map=None), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=np.ones(3)), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=np.full((2, 2), np.nan)), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=-np.ones((2, 2))), "gaze_map"),
    ],
)
def test_what_is_no_gaze_is_refused(answer, told):
    with pytest.raises(UsageError, match=f"the gaze Says: .*{told}"):
        PluginGaze(Says(answer)).choose(None, None, None)


def test_arithmetic_in_place_changes_neither_belief_nor_mission(fake):
    frame, other = fake.frame(0.0), fake.frame(0.0)
    PluginPlanner(Computes()).plan(frame.belief, frame.task)
    PluginGaze(Computes()).choose(frame.belief, frame.task, frame.motion)
    assert np.array_equal(frame.belief.pose, other.belief.pose)
    assert np.array_equal(frame.belief.pose_covariance, other.belief.pose_covariance)
    assert np.array_equal(frame.task.target, other.task.target)
    assert np.array_equal(frame.motion.velocity, other.motion.velocity)
    for track, same in zip(frame.belief.tracks, other.belief.tracks, strict=True):
        assert np.array_equal(track.position, same.position)


def test_the_planner_and_gaze_that_come_with_hsr8_decide_the_same_as_ones_own():
    scenario, seed = quick(), 4
    layout, limits = draw_layout(scenario, seed), scenario.speed_limits()
    planner = build_planner(scenario.navigation, limits, named_rng(seed, "planner"))
    fov = field_of_view(scenario, head_camera(scenario))
    gaze = GazePlanner(scenario.navigation, limits, known_beacons(scenario, layout), *fov)
    own = hsr8.run(scenario, seed=seed, planner=planner, gaze=gaze)
    assert own.metrics["state_hash"] == hsr8.run(scenario, seed=seed).metrics["state_hash"]


def test_a_planner_that_is_false_plans_all_the_same():
    planner = Empty(MotionDecision(np.zeros(3)))
    assert not planner
    assert hsr8.run(quick(), seed=4, planner=planner).metrics["path_length_m"] < 0.01


@pytest.mark.parametrize("kind", ["planner", "gaze"])
def test_what_cannot_answer_is_told_before_the_run(kind, tmp_path):
    for given_, told in ((Says, rf"{kind}=Says\(\)"), (object(), "has no method")):
        with pytest.raises(UsageError, match=told):
            hsr8.run(quick(), out=tmp_path, **{kind: given_})
    assert list(tmp_path.iterdir()) == []


def test_a_walk_takes_no_planner():
    with pytest.raises(UsageError, match="section command"):
        hsr8.run("walk", settings=STAND_INS, planner=Says(None))
