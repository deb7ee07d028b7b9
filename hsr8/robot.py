"""The robot side of the loop: sensors in, joint targets out. It never meets the truth."""

from collections import deque
from collections.abc import Callable
from time import perf_counter
from typing import Protocol

import numpy as np

from hsr8.decisions import Decisions, Now
from hsr8.recorder.frame_record import FrameRecord, Image
from hsr8.recorder.walk_counters import WalkCounters
from navigation.belief.belief import Belief
from navigation.observation import CameraView, Frame, Observation
from vision.camera import CameraPose
from vision.detection import Detection
from vision.parameters import PoseParameters
from walking.body.odometry import Odometry, increment
from walking.command import Command, HeadTarget, VelocityCommand
from walking.sensing import BodySensors
from walking.state import HeadCameraPose, WalkingState
from walking.targets import JointTargets
from walking.value import value
from walking.walker import Walker

UNDER_WAY = 128  # pictures that may be under way at a time


@value
class SensorFrame:
    """Everything the robot senses at the start of one control tick.

    Attributes:
        time: simulated time [s].
        body: encoders, IMU, foot pads.
        shutter: the camera takes a picture now, which may arrive later or never.
        captured: when the picture that arrives now was taken [s].
        image: reads the picture (height, width, 3) that arrives now, if any; it may still be
            drawn, so read it late.
        detections: what a camera without pixels reports instead.
    """

    time: float
    body: BodySensors
    shutter: bool = False
    captured: float = 0.0
    image: Callable[[], Image] | None = None
    detections: tuple[Detection, ...] | None = None


class Sees(Protocol):
    """Finds things in an image."""

    def detect(self, image: Image, pose: CameraPose) -> tuple[Detection, ...]:
        """Detections in `image` taken from `pose`."""


class Believes(Protocol):
    """Turns camera frames into a belief."""

    def update(self, frame: Frame) -> Belief:
        """Belief after `frame`."""


class Commands(Protocol):
    """Asks for motion by the clock alone."""

    def at(self, time: float) -> Command:
        """Command in force at `time` [s]."""


class Robot:
    """Perception, belief, gaze, planning and walking, one after the other.

    Args:
        walking: walks, and gets up after a fall.
        fov: horizontal and vertical field of view of the head camera [rad].
        vision: detector; unused when the frames carry detections.
        pose: how well the body knows the pose of the camera.
        shutter: time for which an image is exposed [s].
        belief: estimator.
        decisions: where to go, how to move, where to look.
        script: commands that walking obeys in place of the planner's, new in any tick.
    """

    def __init__(
        self,
        *,
        walking: Walker,
        fov: tuple[float, float],
        vision: Sees,
        pose: PoseParameters,
        shutter: float,
        belief: Believes,
        decisions: Decisions,
        script: Commands | None = None,
    ) -> None:
        self._walking = walking
        self._fov = fov
        self._vision = vision
        self._pose = pose
        self._shutter = shutter
        self._belief = belief
        self._decisions = decisions
        self._script = script
        self._frames = 0
        self._taken: deque[tuple[float, WalkingState]] = deque(maxlen=UNDER_WAY)
        self._state: WalkingState | None = None  # after this tick, once it was asked for
        self._odometry: Odometry | None = None
        self.command: Command = VelocityCommand()
        self.counters = WalkCounters()
        self.head = HeadTarget()
        self.frame: FrameRecord | None = None

    def step(self, sensed: SensorFrame) -> JointTargets:
        """One control tick: walk on, and look and decide when a camera frame came."""
        if self._script is not None:
            self.command = self._script.at(sensed.time)
        started = perf_counter()
        targets = self._walking.step(sensed.body, self.command, self.head)
        self._state = None
        if not self._walking.down:
            self.counters.add(self._walking, perf_counter() - started)
        if sensed.shutter:
            self._taken.append((sensed.time, self.walking_state()))
        if sensed.image is not None or sensed.detections is not None:
            self._perceive(sensed)
        return targets

    def walking_state(self) -> WalkingState:
        """What the walking engine knows of itself."""
        if self._state is None:
            self._state = self._walking.state()
        return self._state

    def _perceive(self, sensed: SensorFrame) -> None:
        then = self._state_at(sensed.captured)
        if then.phase.down or self._walking.down:
            self._wait()
            return
        image = None if sensed.image is None else sensed.image()
        if sensed.detections is not None:
            detections = sensed.detections
        else:
            assert image is not None
            pose = camera_pose(then.camera, self._pose, self._shutter)
            detections = self._vision.detect(image, pose)
        measured = self._frame(sensed.captured, then, detections)
        estimate = self._belief.update(measured)
        state = self.walking_state() if sensed.time > sensed.captured else then
        now = Now(sensed.time, _odometry(state), self._view(state), state.step_count)
        decided = self._decisions.make(estimate, measured, now)
        if self._script is None:
            vx, vy, wz = decided.motion.velocity.tolist()
            self.command = VelocityCommand(vx, vy, wz)
        self.head = HeadTarget(decided.gaze.pan, decided.gaze.tilt)
        self.frame = FrameRecord(
            index=self._frames,
            time=sensed.time,
            image=image,
            detections=detections,
            measured=measured,
            estimate=estimate,
            now=now,
            decided=decided,
        )
        self._frames += 1

    def _wait(self) -> None:
        """Off its feet the robot does not know where its camera is: neither see nor decide."""
        self._decisions.forget()
        self.head = HeadTarget()
        if self._script is None:
            self.command = VelocityCommand()

    def _state_at(self, captured: float) -> WalkingState:
        """The body when a picture was taken; what was taken earlier never arrives."""
        time, state = self._taken.popleft()
        while time < captured:
            time, state = self._taken.popleft()
        return state

    def _view(self, state: WalkingState) -> CameraView:
        head = state.camera
        return CameraView(
            rotation=head.rotation,
            position=head.position,
            pan=head.pan,
            tilt=head.tilt,
            horizontal_fov=self._fov[0],
            vertical_fov=self._fov[1],
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
                    by_radius=d.by_radius,
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


def camera_pose(head: HeadCameraPose, sigma: PoseParameters, shutter: float) -> CameraPose:
    """The head camera's pose with its uncertainty, as vision wants it; `shutter` in [s]."""
    return CameraPose(
        rotation=head.rotation,
        position=head.position,
        tilt_sigma=sigma.tilt_sigma,
        roll_sigma=sigma.roll_sigma,
        yaw_sigma=sigma.yaw_sigma,
        height_sigma=sigma.height_sigma,
        pan_smear=shutter * abs(head.pan_rate),
        tilt_smear=shutter * abs(head.tilt_rate),
    )
