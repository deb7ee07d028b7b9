"""The robot's decisions at a camera frame: where to go, how to move, where to look."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief
from navigation.belief.prediction import predict
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.observation import CameraView, Frame
from walking.value import value

Array = NDArray[np.float64]


@value
class Now:
    """The moment a decision is made for, as the body knows it.

    Attributes:
        time: simulated time [s].
        odometry: pose of R in the odometry frame (3,) [m, m, rad].
        view: where the camera looks.
        step_count: footsteps made so far.
    """

    time: float
    odometry: Array
    view: CameraView
    step_count: int


@value
class Decided:
    """What was decided.

    Attributes:
        belief: what the robot believes now; the estimate, carried on to now.
        task: where it is going.
        motion: how it moves; the decision in force, new once per footstep.
        gaze: where it looks.
        fresh: nothing was in force before: the first frame, or the first after a fall.
    """

    belief: Belief
    task: Task
    motion: MotionDecision
    gaze: GazeDecision
    fresh: bool


class Goes(Protocol):
    """Knows where to go next."""

    def update(self, pose: Array) -> Task:
        """Task at the believed pose (3,)."""


class GazeController(Protocol):
    """Chooses where to look."""

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Gaze for this frame."""


class MotionPlanner(Protocol):
    """Chooses how to move."""

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """Motion for the next footstep; landmarks near are among the tracks of `belief`."""


class Decisions:
    """Mission, motion and gaze, one after the other.

    Args:
        mission: sequence of destinations.
        planner: motion planner.
        gaze: gaze planner.
        landmarks: what the planner must avoid beside the tracks; the gaze looks at them as
            landmarks alone.
        footstep: time between two motion decisions [s].
    """

    def __init__(
        self,
        *,
        mission: Goes,
        planner: MotionPlanner,
        gaze: GazeController,
        landmarks: LandmarkObstacles,
        footstep: float,
    ) -> None:
        self._mission = mission
        self._planner = planner
        self._gaze = gaze
        self._landmarks = landmarks
        self._footstep = footstep
        self._motion: MotionDecision | None = None
        self._planned_at = -np.inf
        self._planned_step = -1

    def make(self, estimate: Belief, measured: Frame, now: Now) -> Decided:
        """Decide.

        Args:
            estimate: what is believed of the time of the capture.
            measured: the frame it comes from.
            now: later than the capture by the camera's latency.
        """
        belief = estimate
        if now.time > measured.time:
            belief = predict(estimate, measured.odometry, now.odometry, now.time, now.view)
        task = self._mission.update(belief.pose)
        fresh = self._motion is None
        motion = self._move(now, belief, task)
        return Decided(belief, task, motion, self._gaze.choose(belief, task, motion), fresh)

    def forget(self) -> None:
        """Drop the decision in force; the next frame plans anew."""
        self._motion = None

    def _move(self, now: Now, belief: Belief, task: Task) -> MotionDecision:
        """A new decision once per footstep, or after a footstep's time when standing."""
        since = now.time - self._planned_at
        due = now.step_count != self._planned_step or since >= self._footstep
        if self._motion is None or due:
            self._motion = self._planner.plan(self._landmarks.added_to(belief), task)
            self._planned_at = now.time
            self._planned_step = now.step_count
        return self._motion
