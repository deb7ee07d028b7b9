from dataclasses import replace

import numpy as np
import pytest

from hsr8.simulation.decisions import Decisions
from navigation.decision import GazeDecision, MotionDecision
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters
from navigation.parameters.navigation import NavigationParameters

FOOTSTEP = 0.34


class Mission:
    """Mission that records the poses."""

    def __init__(self, task):
        self.task, self.poses = task, []

    def update(self, pose):
        self.poses.append(pose)
        return self.task


class MotionPlanner:
    """Planner whose memory counts its decisions; it records its arguments."""

    def __init__(self):
        self.memories, self.scenes, self.begun = [], [], 0

    def begin(self):
        self.begun += 1
        return 0

    def plan(self, memory, scene):
        self.memories.append(memory)
        self.scenes.append(scene)
        return MotionDecision(np.array([0.1 * len(self.scenes), 0.0, 0.0])), memory + 1


class GazePlanner:
    """Gaze whose memory counts its decisions; it records its arguments."""

    def __init__(self):
        self.memories, self.scenes, self.motions = [], [], []
        self.body_direction = None

    def begin(self):
        return 0

    def choose(self, memory, scene, motion):
        self.memories.append(memory)
        self.scenes.append(scene)
        self.motions.append(motion)
        return GazeDecision(0.0, 0.0, body_direction=self.body_direction), memory + 1


class Made:
    """Decisions with their parts, made at a time and step count."""

    def __init__(self, fake):
        self.mission = Mission(fake.frame(0.0).decision.task)
        self.planner, self.gaze = MotionPlanner(), GazePlanner()
        self._fake = fake
        positions = {"far": (1.5, 0.0), "near": (0.5, 0.0)}
        self.decisions = Decisions(
            parameters=NavigationParameters(),
            mission=self.mission,
            planner=self.planner,
            gaze=self.gaze,
            landmarks=LandmarkObstacles(positions, 0.05, LandmarkParameters()),
            footstep=FOOTSTEP,
        )

    def assess(self, time, steps, late=0.0, moved=(0.0, 0.0, 0.0), lost=False):
        frame = self._fake.frame(time, lost=lost)
        context = replace(
            frame.context,
            time=time + late,
            step_count=steps,
            odometry=frame.context.odometry + moved,
        )
        return self.decisions.assess(frame.estimate, frame.measured, context)

    def __call__(self, time, steps, **details):
        return self.decisions.decide(self.assess(time, steps, **details))


@pytest.fixture
def made(fake):
    return Made(fake)


def test_motion_is_decided_once_a_footstep_and_gaze_every_frame(made):
    decisions = [made(0.06 * k, k // 5) for k in range(15)]
    assert [s.belief.time for s in made.planner.scenes] == pytest.approx([0.0, 0.30, 0.60])
    assert len(made.gaze.scenes) == 15
    assert [d.fresh for d in decisions] == [True] + [False] * 14
    assert all(d.motion is m for d, m in zip(decisions, made.gaze.motions, strict=True))


def test_a_robot_that_stands_decides_after_the_time_of_a_footstep(made):
    for k in range(13):
        made(0.06 * k, 0)
    assert [s.belief.time for s in made.planner.scenes] == pytest.approx([0.0, 0.36, 0.72])


def test_each_planner_gets_the_memory_that_it_returned(made):
    for k in range(10):
        made(0.06 * k, k // 5)
    assert made.planner.memories == [0, 1]
    assert made.gaze.memories == list(range(10))


def test_after_a_fall_motion_is_decided_again_from_the_start(made):
    made(0.0, 0)
    made.decisions.forget()
    assert made(0.06, 0).fresh
    assert made.planner.memories == [0, 0]
    assert made.gaze.memories == [0, 0]


def test_a_relocalization_resets_both_memories(made):
    """Directions, sides and densities of the former pose are wrong."""
    for k, lost in enumerate((False, False, True, True, False, False)):
        made(0.06 * k, k, lost=lost)
    assert made.planner.memories == [0, 1, 2, 3, 0, 1]
    assert made.gaze.memories == [0, 1, 2, 3, 0, 1]


def test_a_relocalization_resets_the_memory_of_a_motion_decided_later(made):
    """Found between two footsteps: the gaze begins at once, the motion with its next decision."""
    for k, lost in enumerate((False, True, False, False)):
        made(0.06 * k, 0 if k < 3 else 1, lost=lost)
    assert made.planner.memories == [0, 0]
    assert made.gaze.memories == [0, 1, 0, 1]


def test_the_body_turns_to_the_latest_gaze_until_a_fall(made):
    made.gaze.body_direction = 0.5
    made(0.0, 0)
    made(0.06, 1)
    made.decisions.forget()
    made(0.12, 1)
    assert [s.look for s in made.planner.scenes] == [None, 0.5, None]


def test_the_direction_of_a_fixed_camera_ends_with_a_relocalization(made):
    """It is in W, as the pose before estimated it."""
    made.gaze.body_direction = 0.5
    for k, lost in enumerate((False, True, False, False)):
        made(0.06 * k, k, lost=lost)
    assert [s.look for s in made.planner.scenes] == [None, 0.5, None, 0.5]


def test_the_scene_has_the_velocity_in_force(made):
    for k in range(3):
        made(0.06 * k, k)
    assert [s.body.tolist() for s in made.planner.scenes] == [[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]]


def test_a_late_frame_is_predicted_to_the_present(made):
    decision = made(0.0, 0, late=0.1, moved=(0.02, 0.0, 0.0))
    assert decision.belief.time == pytest.approx(0.1)
    assert np.allclose(made.mission.poses[0], (0.02, 0.0, 0.0))
    assert np.allclose(made(1.0, 9).belief.pose, 0.0)


def test_motion_and_gaze_share_one_scene_with_the_landmarks_first(made):
    decision = made(0.0, 0)
    (scene,) = made.planner.scenes
    assert made.gaze.scenes == [scene]
    labels = [track.label for track in decision.belief.tracks]
    assert [t.label for t in scene.obstacles] == ["near", *labels]
    assert scene.landmarks == 1
    assert (scene.belief, scene.task) == (decision.belief, decision.task)


def test_given_decisions_replace_those_of_the_planners_and_leave_their_memories(made):
    made(0.0, 0)
    motion, gaze = MotionDecision(np.ones(3)), GazeDecision(0.1, 0.2)
    given = made.decisions.decide(made.assess(0.06, 1), motion, gaze)
    assert (given.motion, given.gaze) == (motion, gaze)
    made(0.12, 2)
    assert made.planner.memories == [0, 1]
    assert made.gaze.memories == [0, 1]
    assert np.array_equal(made.planner.scenes[-1].body, np.ones(3))
