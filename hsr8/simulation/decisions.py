"""The robot's decisions at a camera frame: where to go, how to move, where to look."""

from dataclasses import dataclass
from math import nan
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.belief.belief import Belief
from navigation.belief.estimator import predict
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.memory import Memory
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.observation import CameraView, Frame
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene
from vision.detection import Detection

Array = NDArray[np.float64]
Image = NDArray[np.uint8]


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
class Situation:
    """Inputs of the decisions at one frame.

    Attributes:
        belief: the estimate, predicted to the time of the decision.
        task: current destination.
        context: state of the robot.
        motion: latest motion decision; None before the first.
        motion_due: whether a motion is decided, once per footstep.
        image: image that arrived (height, width, 3); None with an analytic camera.
    """

    belief: Belief
    task: Task
    context: DecisionContext
    motion: MotionDecision | None
    motion_due: bool
    image: Image | None = None


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """Command that arrived from outside during a run; NaN where it commands nothing.

    Attributes:
        time: time of the control tick after which it is in force [s].
        velocity: velocity vx, vy, wz in R [m/s, m/s, rad/s].
        gaze: pan and tilt [rad].
    """

    time: float
    velocity: tuple[float, float, float] = (nan, nan, nan)
    gaze: tuple[float, float] = (nan, nan)


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
    """Gaze planner; its state between frames is a value that it takes and returns."""

    def begin(self) -> object:
        """Return the memory at the start, after a fall and after a relocalization."""

    def choose(
        self, memory: Any, scene: Scene, motion: MotionDecision | None
    ) -> tuple[GazeDecision, object]:
        """Return the gaze for this frame, and the memory."""


class MotionPlanner(Protocol):
    """Motion planner; its state between footsteps is a value that it takes and returns."""

    def begin(self) -> object:
        """Return the memory at the start, after a fall and after a relocalization."""

    def plan(self, memory: Any, scene: Scene) -> tuple[MotionDecision, object]:
        """Return the motion of the next footstep, and the memory."""


class Decisions:
    """Mission, motion planner and gaze planner, called in this order.

    Args:
        parameters: parameters of the decisions.
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
        parameters: NavigationParameters,
        mission: MissionPlanner,
        planner: MotionPlanner,
        gaze: GazeController,
        landmarks: LandmarkObstacles,
        footstep: float,
    ) -> None:
        self._parameters = parameters
        self._mission = mission
        self._planner = planner
        self._gaze = gaze
        self._landmarks = landmarks
        self._footstep = footstep
        self._motion: MotionDecision | None = None
        self._fresh = True
        self._look: float | None = None
        self._planned_at = -np.inf
        self._planned_step = -1
        self._memory = self._begin()

    def _begin(self) -> Memory:
        return Memory(self._planner.begin(), self._gaze.begin())

    def make(self, estimate: Belief, measured: Frame, context: DecisionContext) -> Decision:
        """Decide task, motion and gaze; arguments as of `assess`."""
        return self.decide(self.assess(estimate, measured, context))

    def assess(self, estimate: Belief, measured: Frame, context: DecisionContext) -> Situation:
        """Return the situation to decide in.

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
        elapsed = context.time - self._planned_at
        due = context.step_count != self._planned_step or elapsed >= self._footstep
        return Situation(belief, task, context, self._motion, motion_due=due or self._fresh)

    def decide(
        self,
        situation: Situation,
        motion: MotionDecision | None = None,
        gaze: GazeDecision | None = None,
    ) -> Decision:
        """Decide motion and gaze.

        Motion is decided once per footstep, or per footstep time when standing.

        Args:
            situation: situation to decide in.
            motion: replaces the decision of the motion planner, if one is due.
            gaze: replaces the decision of the gaze planner.
        """
        belief, task = situation.belief, situation.task
        fresh, self._fresh = self._fresh, False
        memory = self._memory
        if memory.lost and not belief.lost:
            memory, self._look = self._begin(), None
        scene = self._scene(belief, task)
        of_motion, of_gaze = memory.motion, memory.gaze
        if situation.motion_due or self._motion is None:
            if motion is None:
                motion, of_motion = self._planner.plan(of_motion, scene)
            self._motion = motion
            self._planned_at = situation.context.time
            self._planned_step = situation.context.step_count
        if gaze is None:
            gaze, of_gaze = self._gaze.choose(of_gaze, scene, self._motion)
        self._look = gaze.body_direction
        self._memory = Memory(of_motion, of_gaze, belief.lost)
        return Decision(belief, task, self._motion, gaze, fresh)

    def forget(self) -> None:
        """Decide motion again at the next frame, as at the start: the robot fell."""
        self._fresh, self._motion, self._look, self._memory = True, None, None, self._begin()

    def _scene(self, belief: Belief, task: Task) -> Scene:
        body = np.zeros(3) if self._motion is None else self._motion.velocity
        return Scene.of(
            belief,
            task,
            self._parameters,
            body=body,
            landmarks=self._landmarks.near(belief.pose[:2]),
            look=self._look,
        )


@value
class FrameRecord:
    """Detections, belief and decisions of one camera frame.

    Attributes:
        index: number of the frame.
        time: time at which the frame reached the robot [s].
        image: (height, width, 3) RGB, or None with the analytic camera.
        detections: detections of vision in the image.
        measured: input of the estimator at capture, which is earlier by the latency.
        estimate: belief at capture.
        context: input of the decisions.
        decision: belief at `time`, task, motion and gaze.
    """

    index: int
    time: float
    image: Image | None
    detections: tuple[Detection, ...]
    measured: Frame
    estimate: Belief
    context: DecisionContext
    decision: Decision

    @property
    def belief(self) -> Belief:
        """Belief at `time`."""
        return self.decision.belief

    @property
    def gaze(self) -> GazeDecision:
        """Gaze decision."""
        return self.decision.gaze

    @property
    def motion(self) -> MotionDecision:
        """Motion decision, new once per footstep."""
        return self.decision.motion

    @property
    def task(self) -> Task:
        """Current task of the mission."""
        return self.decision.task
