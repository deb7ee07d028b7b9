"""The robot side of the loop: sensors in, joint targets out. It never meets the truth."""

from collections import deque
from dataclasses import dataclass
from time import perf_counter
from typing import Protocol

import numpy as np

from hsr8.recorder.record import FrameRecord, Image
from hsr8.recorder.walk_tally import WalkTally
from navigation.belief import Belief
from navigation.decision import GazeDecision, MotionDecision, Task
from navigation.observation import CameraView, Frame, Observation
from navigation.prediction import predict
from vision.camera import CameraPose, PinholeCamera
from vision.detection import Detection
from vision.parameters import PoseParameters
from walking.command import Command, HeadTarget, VelocityCommand
from walking.odometry import increment
from walking.sensing import BodySensors
from walking.state import HeadCameraPose, Odometry, WalkingState
from walking.targets import JointTargets
from walking.walker import Walker

UNDER_WAY = 128  # pictures that may be under way at a time


@dataclass(frozen=True, slots=True)
class SensorFrame:
    """Everything the robot senses at the start of one control tick.

    Attributes:
        time: simulated time [s].
        body: encoders, IMU, foot pads.
        shutter: the camera takes a picture now, which may arrive later or never.
        captured: when the picture that arrives now was taken [s].
        image: (height, width, 3) picture that arrives now, if any.
        detections: what a camera without pixels reports instead.
    """

    time: float
    body: BodySensors
    shutter: bool = False
    captured: float = 0.0
    image: Image | None = None
    detections: tuple[Detection, ...] | None = None


class Sees(Protocol):
    """Finds things in an image."""

    def detect(self, image: Image, pose: CameraPose) -> tuple[Detection, ...]:
        """Detections in `image` taken from `pose`."""


class Believes(Protocol):
    """Turns camera frames into a belief."""

    def update(self, frame: Frame) -> Belief:
        """Belief after `frame`."""


class Goes(Protocol):
    """Knows where to go next."""

    def update(self, pose: np.ndarray) -> Task:
        """Task at the believed pose (3,)."""


class Looks(Protocol):
    """Chooses where to look."""

    def choose(self, belief: Belief, task: Task, motion: MotionDecision | None) -> GazeDecision:
        """Gaze for this frame."""


class Moves(Protocol):
    """Chooses how to move."""

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """Motion for the next footstep."""


class Commands(Protocol):
    """Asks for motion by the clock alone."""

    def at(self, time: float) -> Command:
        """Command in force at `time` [s]."""


class Robot:
    """Perception, belief, gaze, planning and walking, one after the other.

    Args:
        walking: walks, and gets up after a fall.
        camera: intrinsics of the head camera.
        vision: detector; unused when the frames carry detections.
        pose: how well the body knows the pose of the camera.
        belief: estimator.
        mission: sequence of destinations.
        gaze: gaze planner.
        planner: motion planner.
        footstep: time between two motion decisions [s].
        script: commands that walking obeys in place of the planner's, new in any tick.
    """

    def __init__(
        self,
        *,
        walking: Walker,
        camera: PinholeCamera,
        vision: Sees,
        pose: PoseParameters,
        belief: Believes,
        mission: Goes,
        gaze: Looks,
        planner: Moves,
        footstep: float,
        script: Commands | None = None,
    ) -> None:
        self._walking = walking
        self._camera = camera
        self._vision = vision
        self._pose = pose
        self._belief = belief
        self._mission = mission
        self._gaze = gaze
        self._planner = planner
        self._footstep = footstep
        self._script = script
        self._motion: MotionDecision | None = None
        self._planned_at = -np.inf
        self._planned_step = -1
        self._frames = 0
        self._taken: deque[tuple[float, WalkingState]] = deque(maxlen=UNDER_WAY)
        self._odometry: Odometry | None = None
        self.command: Command = VelocityCommand()
        self.tally = WalkTally()
        self.head = HeadTarget()
        self.frame: FrameRecord | None = None

    def step(self, sensed: SensorFrame) -> JointTargets:
        """One control tick: walk on, and look and decide when a camera frame came."""
        if self._script is not None:
            self.command = self._script.at(sensed.time)
        started = perf_counter()
        targets = self._walking.step(sensed.body, self.command, self.head)
        if not self._walking.down:
            self.tally.add(self._walking, perf_counter() - started)
        if sensed.shutter:
            self._taken.append((sensed.time, self._walking.state()))
        if sensed.image is not None or sensed.detections is not None:
            self._perceive(sensed)
        return targets

    def walking_state(self) -> WalkingState:
        """What the walking engine knows of itself."""
        return self._walking.state()

    def _perceive(self, sensed: SensorFrame) -> None:
        then = self._state_at(sensed.captured)
        if then.phase.down or self._walking.down:
            self._wait()
            return
        if sensed.detections is not None:
            detections = sensed.detections
        else:
            assert sensed.image is not None
            detections = self._vision.detect(sensed.image, camera_pose(then.camera, self._pose))
        measured = self._frame(sensed.captured, then, detections)
        belief = estimate = self._belief.update(measured)
        state = then
        if sensed.time > sensed.captured:
            state = self._walking.state()
            belief = predict(
                belief, _odometry(then), _odometry(state), sensed.time, self._view(state)
            )
        task = self._mission.update(belief.pose)
        motion = self._decide_motion(sensed.time, state, belief, task)
        gaze = self._gaze.choose(belief, task, motion)
        if self._script is None:
            forward, left, turn = motion.velocity.tolist()
            self.command = VelocityCommand(forward, left, turn)
        self.head = HeadTarget(gaze.pan, gaze.tilt)
        self.frame = FrameRecord(
            index=self._frames,
            time=sensed.time,
            image=sensed.image,
            detections=detections,
            measured=measured,
            estimate=estimate,
            belief=belief,
            gaze=gaze,
            motion=motion,
            task=task,
        )
        self._frames += 1

    def _wait(self) -> None:
        """Off its feet the robot does not know where its camera is: neither see nor decide."""
        self._motion = None
        self.head = HeadTarget()
        if self._script is None:
            self.command = VelocityCommand()

    def _state_at(self, captured: float) -> WalkingState:
        """The body when a picture was taken; what was taken earlier never arrives."""
        time, state = self._taken.popleft()
        while time < captured:
            time, state = self._taken.popleft()
        return state

    def _decide_motion(
        self, time: float, state: WalkingState, belief: Belief, task: Task
    ) -> MotionDecision:
        """A new decision once per footstep, or after a footstep's time when standing."""
        due = state.step_count != self._planned_step or time - self._planned_at >= self._footstep
        if self._motion is None or due:
            self._motion = self._planner.plan(belief, task)
            self._planned_at = time
            self._planned_step = state.step_count
        return self._motion

    def _view(self, state: WalkingState) -> CameraView:
        head = state.camera
        return CameraView(
            rotation=head.rotation,
            position=head.position,
            pan=head.pan,
            tilt=head.tilt,
            horizontal_fov=self._camera.horizontal_fov,
            vertical_fov=self._camera.vertical_fov,
            yaw_sigma=self._pose.yaw_sigma,
        )

    def _frame(self, time: float, state: WalkingState, detections: tuple[Detection, ...]) -> Frame:
        motion = increment(self._odometry or state.odometry, state.odometry)
        self._odometry = state.odometry
        return Frame(
            time=time,
            odometry=_odometry(state),
            motion_covariance=motion.covariance,
            view=self._view(state),
            observations=tuple(
                Observation(
                    kind=d.kind,
                    label=d.label,
                    distance=d.distance,
                    bearing=d.bearing,
                    covariance=d.covariance,
                    radius=d.radius,
                    radius_sigma=d.radius_sigma,
                    cut=d.cut,
                    occluded=d.occluded,
                )
                for d in detections
            ),
        )


def _odometry(state: WalkingState) -> np.ndarray:
    """Pose of R in the odometry frame (3,) [m, m, rad]."""
    odometry = state.odometry
    return np.array([odometry.x, odometry.y, odometry.yaw])


def camera_pose(head: HeadCameraPose, sigma: PoseParameters) -> CameraPose:
    """The head camera's pose with its uncertainty, as vision wants it."""
    return CameraPose(
        rotation=head.rotation,
        position=head.position,
        tilt_sigma=sigma.tilt_sigma,
        roll_sigma=sigma.roll_sigma,
        yaw_sigma=sigma.yaw_sigma,
        height_sigma=sigma.height_sigma,
    )
