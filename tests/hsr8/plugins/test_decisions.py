from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hsr8
from hsr8.errors import UsageError
from hsr8.plugins.decisions import PluginGaze, PluginPlanner
from hsr8.seeds import named_rng
from hsr8.simulation.command_schedule import ScheduledMission
from hsr8.simulation.decisions import Decisions
from hsr8.simulation.robot_builder import decision_limits, known_beacons, neck
from hsr8.world.field.generator import draw_layout
from navigation.baselines.choice import build_planner
from navigation.decision import GazeDecision, MotionDecision
from navigation.gaze.planner import GazePlanner
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene

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


class Remembering:
    """Planner and gaze that take and return a memory, the list of the times of their frames."""

    def __init__(self):
        self.memories = []

    def plan(self, memory, scene):
        return MotionDecision(np.zeros(3)), self._kept(memory, scene)

    def choose(self, memory, scene, motion):
        return GazeDecision(0.0, 0.0), self._kept(memory, scene)

    def _kept(self, memory, scene):
        self.memories.append(memory)
        return [*(memory or []), round(scene.belief.time, 2)]


class Returns:
    """Planner and gaze that return a constant from the methods with memory."""

    def __init__(self, result):
        self.result = result

    def plan(self, memory, scene):
        return self.result

    def choose(self, memory, scene, motion):
        return self.result


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


class SceneInPlace:
    """Modifies scene, motion and memory in place."""

    def plan(self, memory, scene):
        InPlace().plan(scene.belief, scene.task)
        scene.obstacles.position[:] += 1.0
        scene.s_oe[:] = scene.psi_ob[:] = scene.body[:] = 9.0
        return MotionDecision(np.zeros(3)), memory

    def choose(self, memory, scene, motion):
        self.plan(memory, scene)
        motion.velocity[:] = 9.0
        return GazeDecision(0.0, 0.0), memory


@pytest.fixture
def scene(fake):
    """Builds the scene of a frame, with a landmark nearby."""
    landmarks = LandmarkObstacles({"post": (0.5, 0.0)}, 0.05, LandmarkParameters())

    def scene(frame=None):
        frame = frame or fake.frame(0.0)
        return Scene.of(
            frame.belief,
            frame.task,
            NavigationParameters(),
            body=np.zeros(3),
            landmarks=landmarks.near(frame.belief.pose[:2]),
        )

    return scene


def quick(*words):
    return hsr8.load_scenario("quick", [*STAND_INS, *words])


def motion_of(planner, scene):
    """First motion of a user-defined planner."""
    plugin = PluginPlanner(planner, LIMITS)
    motion, _ = plugin.plan(plugin.begin(), scene)
    return motion


def gaze_of(gaze, scene, motion=None):
    """First gaze of a user-defined gaze."""
    plugin = PluginGaze(gaze, LIMITS)
    decision, _ = plugin.choose(plugin.begin(), scene, motion)
    return decision


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(values=st.tuples(speeds, speeds, speeds), form=st.sampled_from(FORMS))
def test_a_velocity_of_any_sequence_type_is_accepted_exactly(values, form, scene):
    motion = motion_of(Fixed(MotionDecision(form(values), np.float32(0.5))), scene())
    assert motion.velocity.dtype == np.float64
    assert tuple(motion.velocity) == values
    assert type(motion.direction) is float


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(pan=speeds, number=st.sampled_from((float, np.float32, np.float64, np.array)))
def test_a_scalar_gaze_is_accepted_exactly_and_an_array_refused(pan, number, scene):
    gaze = Fixed(GazeDecision(number(pan), 0))
    if number is np.array:
        with pytest.raises(UsageError, match="pan"):
            gaze_of(gaze, scene())
    else:
        decision = gaze_of(gaze, scene())
        assert (decision.pan, decision.tilt) == (pan, 0.0)
        assert {type(decision.pan), type(decision.tilt)} == {float}


@pytest.mark.parametrize(
    "velocity",
    [
        [0.1, 0.0],
        [np.nan, 0.0, 0.0],
        [[0.1], 0.0, 0.0],
        "abc",
    ],
)
def test_an_invalid_velocity_is_refused_with_the_expected_one(velocity, scene):
    with pytest.raises(UsageError, match=r"Fixed: velocity must be .*vx, vy and wz \[m/s"):
        motion_of(Fixed(MotionDecision(velocity)), scene())


@pytest.mark.parametrize(
    ("decision", "expected"),
    [
        (None, "must return a MotionDecision, got NoneType"),
        (MotionDecision(np.zeros(3), speed=np.nan), "speed"),
    ],
)
def test_an_invalid_motion_is_refused(decision, expected, scene):
    with pytest.raises(UsageError, match=f"planner Fixed: .*{expected}"):
        motion_of(Fixed(decision), scene())


@pytest.mark.parametrize(
    ("decision", "expected"),
    [
        ((0.0, 0.0), "must return a GazeDecision, got tuple"),
        (GazeDecision(np.nan, 0.0), "pan"),
        (GazeDecision(0.0, 0.0, gaze_map=np.full((2, 2), np.nan)), "gaze_map"),
        (GazeDecision(0.0, 0.0, gaze_map=-np.ones((2, 2))), "gaze_map"),
    ],
)
def test_an_invalid_gaze_is_refused(decision, expected, scene):
    with pytest.raises(UsageError, match=f"gaze Fixed: .*{expected}"):
        gaze_of(Fixed(decision), scene())


@pytest.mark.parametrize(
    "result",
    [
        None,
        (MotionDecision(np.zeros(3)),),
        (1, MotionDecision(np.zeros(3))),
    ],
)
def test_anything_but_a_motion_and_a_memory_is_refused(result, scene):
    with pytest.raises(UsageError, match=r"planner Returns: .*pair of MotionDecision and memory"):
        motion_of(Returns(result), scene())


@pytest.mark.parametrize("result", [GazeDecision(0.0, 0.0), (MotionDecision(np.zeros(3)), 1)])
def test_anything_but_a_gaze_and_a_memory_is_refused(result, scene):
    with pytest.raises(UsageError, match=r"gaze Returns: .*pair of GazeDecision and memory"):
        gaze_of(Returns(result), scene())


def test_a_plugin_gets_its_own_memory_back_and_none_at_first(fake):
    """Also after a relocalization, in the place of the built-in planners."""
    planner, gaze = Remembering(), Remembering()
    frames = [fake.frame(0.1 * k, lost=lost) for k, lost in enumerate((False, True, False, False))]
    decisions = Decisions(
        parameters=NavigationParameters(),
        mission=ScheduledMission(),
        planner=PluginPlanner(planner, LIMITS),
        gaze=PluginGaze(gaze, LIMITS),
        landmarks=LandmarkObstacles({}, 0.05, LandmarkParameters()),
        footstep=0.0,
    )
    for frame in frames:
        context = replace(frame.context, time=frame.time)
        decisions.make(frame.estimate, frame.measured, context)
    assert planner.memories == gaze.memories == [None, [0.0], None, [0.2]]


def test_a_planner_of_belief_and_task_gets_the_landmarks_among_the_tracks(scene):
    class Noted:
        def plan(self, belief, task):
            self.labels, self.task = [t.label for t in belief.tracks], task
            return MotionDecision(np.zeros(3))

    noted, here = Noted(), scene()
    motion_of(noted, here)
    assert noted.labels == ["post", *(t.label for t in here.belief.tracks)]
    assert np.array_equal(noted.task.target, here.task.target)
    plugin = PluginPlanner(noted, LIMITS)
    assert plugin.plan(plugin.begin(), here)[1] is None


@pytest.mark.parametrize("plugin", [InPlace(), SceneInPlace()])
def test_arithmetic_in_place_changes_neither_belief_nor_mission(plugin, scene, fake):
    frame, other = fake.frame(0.0), fake.frame(0.0)
    here, same = scene(frame), scene(other)
    motion_of(plugin, here)
    gaze_of(plugin, here, frame.motion)
    assert np.array_equal(frame.belief.pose, other.belief.pose)
    assert np.array_equal(frame.belief.pose_covariance, other.belief.pose_covariance)
    assert np.array_equal(frame.task.target, other.task.target)
    assert np.array_equal(frame.motion.velocity, other.motion.velocity)
    for name in ("s_oe", "psi_ob", "body"):
        assert np.array_equal(getattr(here, name), getattr(same, name))
    for mine, theirs in (
        (frame.belief.tracks, other.belief.tracks),
        (here.obstacles, same.obstacles),
    ):
        for track, untouched in zip(mine, theirs, strict=True):
            assert np.array_equal(track.position, untouched.position)


def test_the_built_in_planner_and_gaze_decide_the_same_as_plugins():
    scenario, seed = quick(), 4
    layout, limits = draw_layout(scenario, seed), scenario.speed_limits()
    planner = build_planner(scenario.navigation, limits, named_rng(seed, "planner"))
    beacons = known_beacons(scenario, layout)
    gaze = GazePlanner(scenario.navigation, limits, beacons, neck(scenario))
    plugins = hsr8.run(scenario, seed=seed, planner=planner, gaze=gaze)
    assert plugins.metrics["state_hash"] == hsr8.run(scenario, seed=seed).metrics["state_hash"]


class WithoutInputs:
    """Planner, gaze and walker whose methods take nothing."""

    def plan(self):
        raise AssertionError

    choose = step = plan


@pytest.mark.parametrize("kind", ["planner", "gaze", "walker"])
def test_an_unsuitable_object_is_refused_before_the_run(kind, tmp_path):
    unsuitable = (
        (Fixed, rf"{kind}=Fixed\(\)"),
        (object(), "has no method"),
        (WithoutInputs(), rf"{kind} WithoutInputs: expected \w+\(\w+, .*\), got \w+\(\)"),
    )
    for plugin, expected in unsuitable:
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
