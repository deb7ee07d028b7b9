from dataclasses import replace

import numpy as np
import pytest

from hsr8.decisions import Decisions
from navigation.decision import GazeDecision, MotionDecision
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters

FOOTSTEP = 0.34


class Parts:
    """Mission, motion planner and gaze planner that record their arguments."""

    def __init__(self, task):
        self.task, self.poses, self.plans, self.looks = task, [], [], []
        self.avoided, self.beliefs, self.directions = [], [], []
        self.body_direction = None

    def update(self, pose):
        self.poses.append(pose)
        return self.task

    def plan(self, belief, task, look):
        assert task is self.task
        self.directions.append(look)
        self.plans.append(belief.time)
        self.avoided.append([track.label for track in belief.tracks])
        return MotionDecision(np.array([0.1 * len(self.plans), 0.0, 0.0]))

    def choose(self, belief, task, motion):
        self.looks.append(motion)
        self.beliefs.append(belief)
        return GazeDecision(0.0, 0.0, body_direction=self.body_direction)


@pytest.fixture
def made(fake):
    """Return decisions, their parts, and a function that decides at a time and step count."""
    parts = Parts(fake.frame(0.0).decision.task)
    positions = {"far": (1.5, 0.0), "near": (0.5, 0.0)}
    landmarks = LandmarkObstacles(positions, 0.05, LandmarkParameters())
    decisions = Decisions(
        mission=parts, planner=parts, gaze=parts, landmarks=landmarks, footstep=FOOTSTEP
    )

    def make(time, steps, late=0.0, moved=(0.0, 0.0, 0.0)):
        frame = fake.frame(time)
        context = replace(
            frame.context,
            time=time + late,
            step_count=steps,
            odometry=frame.context.odometry + moved,
        )
        return decisions.make(frame.estimate, frame.measured, context)

    return decisions, parts, make


def test_motion_is_decided_once_a_footstep_and_gaze_every_frame(made):
    _, parts, make = made
    decisions = [make(0.06 * k, k // 5) for k in range(15)]
    assert parts.plans == pytest.approx([0.0, 0.30, 0.60])
    assert len(parts.looks) == 15
    assert [d.fresh for d in decisions] == [True] + [False] * 14
    assert all(d.motion is looked for d, looked in zip(decisions, parts.looks, strict=True))


def test_a_robot_that_stands_decides_after_the_time_of_a_footstep(made):
    _, parts, make = made
    for k in range(13):
        make(0.06 * k, 0)
    assert parts.plans == pytest.approx([0.0, 0.36, 0.72])


def test_after_a_fall_motion_is_decided_again(made):
    decisions, parts, make = made
    make(0.0, 0)
    decisions.forget()
    assert make(0.06, 0).fresh
    assert len(parts.plans) == 2


def test_the_body_turns_to_the_latest_gaze_until_a_fall(made):
    decisions, parts, make = made
    parts.body_direction = 0.5
    make(0.0, 0)
    make(0.06, 1)
    decisions.forget()
    make(0.12, 1)
    assert parts.directions == [None, 0.5, None]


def test_a_late_frame_is_predicted_to_the_present(made):
    _, parts, make = made
    decision = make(0.0, 0, late=0.1, moved=(0.02, 0.0, 0.0))
    assert decision.belief.time == pytest.approx(0.1)
    assert np.allclose(parts.poses[0], (0.02, 0.0, 0.0))
    assert np.allclose(make(1.0, 9).belief.pose, 0.0)


def test_only_the_motion_planner_avoids_landmarks(made):
    _, parts, make = made
    decision = make(0.0, 0)
    tracks = [track.label for track in decision.belief.tracks]
    assert parts.avoided == [["near", *tracks]]
    assert parts.beliefs == [decision.belief]
