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
class DecisionContext:
    """Robot state that a decision is made for.

    Attributes:
        time: simulated time [s].
        odometry: pose of R in the odometry frame (3,) [m, m, rad].
        view: pose of the camera.
        step_count: footsteps made so far.
    """

    time: float
    odometry: Array
    view: CameraView
    step_count: int


@value
class Decision:
    """Task, motion and gaze decided at one frame.

    Attributes:
        belief: the estimate, predicted to the time of the decision.
        task: current destination.
        motion: motion decision in force, new once per footstep.
        gaze: gaze decision.
        fresh: first decision of the run, or first after a fall.
    """

    belief: Belief
    task: Task
    motion: MotionDecision
    gaze: GazeDecision
    fresh: bool


class MissionPlanner(Protocol):
    """Sequence of destinations."""

    def update(self, pose: Array) -> Task:
        """Return the task at the believed pose (3,)."""


class GazeController(Protocol):
    """Gaze planner."""

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Return the gaze for this frame."""


class MotionPlanner(Protocol):
    """Motion planner."""

    def plan(self, belief: Belief, task: Task, look: float | None) -> MotionDecision:
        """Return the motion of the next footstep.

        Args:
            belief: of the robot; its tracks include nearby landmarks.
            task: of the mission.
            look: direction in W that the body turns to for a fixed camera, if any [rad].
        """


class Decisions:
    """Mission, motion planner and gaze planner, called in this order.

    Args:
        mission: sequence of destinations.
        planner: motion planner.
        gaze: gaze planner.
        landmarks: landmarks that the motion planner avoids as obstacles; the gaze planner
            sees them as landmarks only.
        footstep: maximum time between two motion decisions [s].
    """

    def __init__(
        self,
        *,
        mission: MissionPlanner,
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
        self._look: float | None = None
        self._planned_at = -np.inf
        self._planned_step = -1

    def make(self, estimate: Belief, measured: Frame, context: DecisionContext) -> Decision:
        """Decide task, motion and gaze.

        Args:
            estimate: belief at the time of the capture.
            measured: frame that `estimate` comes from.
            context: state now, later than the capture by the latency of the camera.
        """
        belief = estimate
        if context.time > measured.time:
            belief = predict(
                estimate, measured.odometry, context.odometry, context.time, context.view
            )
        task = self._mission.update(belief.pose)
        fresh = self._motion is None
        motion = self._move(context, belief, task)
        gaze = self._gaze.choose(belief, task, motion)
        self._look = gaze.body_direction
        return Decision(belief, task, motion, gaze, fresh)

    def forget(self) -> None:
        """Drop the motion decision in force."""
        self._motion, self._look = None, None

    def _move(self, context: DecisionContext, belief: Belief, task: Task) -> MotionDecision:
        """Return a new motion decision once per footstep, or per footstep time when standing."""
        elapsed = context.time - self._planned_at
        due = context.step_count != self._planned_step or elapsed >= self._footstep
        if self._motion is None or due:
            self._motion = self._planner.plan(self._landmarks.added_to(belief), task, self._look)
            self._planned_at = context.time
            self._planned_step = context.step_count
        return self._motion
