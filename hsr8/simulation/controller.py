"""Robot side of the loop: from sensors to joint targets, without ground truth."""

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Protocol

import numpy as np

from compilation.value import value
from hsr8.simulation.command_schedule import CommandSource
from hsr8.simulation.decisions import (
    Decision,
    DecisionContext,
    Decisions,
    FrameRecord,
    Image,
    Situation,
)
from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision
from navigation.observation import CameraModel, CameraView, Frame
from vision.camera import CameraPose
from vision.detection import Detection
from walking.command import Command, HeadTarget, VelocityCommand
from walking.estimate.odometry import Odometry, increment
from walking.state import BodySensors, JointTargets, WalkingState
from walking.walker import Walker

MAX_PENDING = 128  # images captured but not yet delivered


@value
class SensorFrame:
    """Sensor readings at the start of one control tick.

    Attributes:
        time: simulated time [s].
        body: encoders, IMU, foot pads.
        shutter: the camera captures an image now; it arrives later or never.
        captured: capture time of the image that arrives now [s].
        image: reads the image (height, width, 3) that arrives now, if any. Rendering may still
            be in progress: read it as late as possible.
        detections: detections of a camera without pixels.
    """

    time: float
    body: BodySensors
    shutter: bool = False
    captured: float = 0.0
    image: Callable[[], Image] | None = None
    detections: tuple[Detection, ...] | None = None


class Detector(Protocol):
    """Object detector."""

    def detect(self, image: Image, pose: CameraPose) -> tuple[Detection, ...]:
        """Return the detections in `image`, captured from `pose`."""


class Estimator(Protocol):
    """State estimator: belief from camera frames."""

    def update(self, frame: Frame) -> Belief:
        """Return the belief after `frame`."""


class Robot:
    """Perception, estimation, planning and walking of the robot.

    Args:
        walking: walking engine.
        camera: constants of the head camera.
        vision: detector; unused when the frames carry detections.
        belief: estimator.
        decisions: mission, motion planner and gaze planner.
        schedule: commands that replace those of the motion planner, read every tick.
    """

    def __init__(
        self,
        *,
        walking: Walker,
        camera: CameraModel,
        vision: Detector,
        belief: Estimator,
        decisions: Decisions,
        schedule: CommandSource | None = None,
    ) -> None:
        self.walking = walking
        self._camera = camera
        self._vision = vision
        self._belief = belief
        self._decisions = decisions
        self._schedule = schedule
        self._frames = 0
        self._pending: deque[tuple[float, WalkingState]] = deque(maxlen=MAX_PENDING)
        self._state: WalkingState | None = None  # after this tick, cached
        self._odometry: Odometry | None = None
        self.command: Command = VelocityCommand()
        self.head = HeadTarget()
        self._direction: float | None = None  # of a stabilized gaze in the odometry frame [rad]
        self.frame: FrameRecord | None = None
        self._undecided: Callable[[Decision], FrameRecord] | None = None

    def walk(self, sensed: SensorFrame) -> JointTargets:
        """Run the walking engine for one control tick."""
        if self._schedule is not None:
            self.command = self._schedule.at(sensed.time)
        if self._direction is not None:
            self.head = HeadTarget(wrap(self._direction - self.walking.yaw), self.head.tilt)
        targets = self.walking.step(sensed.body, self.command, self.head)
        self._state = None
        if sensed.shutter:
            self._pending.append((sensed.time, self.walking_state()))
        return targets

    def perceive(self, sensed: SensorFrame) -> Situation | None:
        """Return the situation to `decide` in if a camera frame arrived; `walk` precedes."""
        if sensed.image is None and sensed.detections is None:
            return None
        captured_state = self._state_at(sensed.captured)
        if captured_state.phase.down or self.walking.down:
            self._wait()
            return None
        return self._perceive(sensed, captured_state)

    def decide(
        self,
        situation: Situation,
        motion: MotionDecision | None = None,
        gaze: GazeDecision | None = None,
    ) -> None:
        """Decide once after each `perceive` that returned a situation.

        Args:
            situation: situation to decide in.
            motion: replaces the decision of the motion planner, if one is due.
            gaze: replaces the decision of the gaze planner.
        """
        assert self._undecided is not None
        decision = self._decisions.decide(situation, motion, gaze)
        if self._schedule is None:
            self.command = VelocityCommand(*decision.motion.velocity.tolist())
        chosen = decision.gaze
        self.head = HeadTarget(chosen.pan, chosen.tilt)
        self._direction = self.walking.yaw + chosen.pan if chosen.stabilized else None
        self.frame, self._undecided = self._undecided(decision), None
        self._frames += 1

    def walking_state(self) -> WalkingState:
        """Return the state of the walking engine."""
        if self._state is None:
            self._state = self.walking.state()
        return self._state

    def belief_bytes(self) -> bytes:
        """Return pose and tracks of the latest belief as bytes; none before the first frame."""
        if self.frame is None:
            return b""
        belief = self.frame.belief
        parts = [belief.pose, belief.pose_covariance]
        for track in belief.tracks:
            parts += (track.position, track.covariance)
        return b"".join(part.tobytes() for part in parts)

    def _perceive(self, sensed: SensorFrame, captured_state: WalkingState) -> Situation:
        image = None if sensed.image is None else sensed.image()
        if captured_state.camera.turn_rate > self._camera.blind_above:
            detections: tuple[Detection, ...] = ()
        elif sensed.detections is not None:
            detections = sensed.detections
        else:
            assert image is not None
            detections = self._vision.detect(image, captured_state.camera)
        measured = self._frame(sensed.captured, captured_state, detections)
        estimate = self._belief.update(measured)
        state = self.walking_state() if sensed.time > sensed.captured else captured_state
        context = DecisionContext(
            sensed.time, _odometry(state), self._view(state), state.step_count
        )
        self._undecided = partial(
            FrameRecord, self._frames, sensed.time, image, detections, measured, estimate, context
        )
        return replace(self._decisions.assess(estimate, measured, context), image=image)

    def _wait(self) -> None:
        """Pause perception and decisions: off its feet the robot does not know its camera pose."""
        self._decisions.forget()
        self.head, self._direction = HeadTarget(), None
        if self._schedule is None:
            self.command = VelocityCommand()

    def _state_at(self, captured: float) -> WalkingState:
        """Return the state at a capture, dropping those of older images, which never arrive."""
        while True:
            time, state = self._pending.popleft()
            if time >= captured:
                return state

    def _view(self, state: WalkingState) -> CameraView:
        head = state.camera
        return CameraView(
            rotation=head.rotation,
            position=head.position,
            pan=head.pan,
            tilt=head.tilt,
            model=self._camera,
            pan_rate=head.pan_rate,
            tilt_rate=head.tilt_rate,
            blind=head.turn_rate > self._camera.blind_above,
        )

    def _frame(self, time: float, state: WalkingState, detections: tuple[Detection, ...]) -> Frame:
        motion = increment(self._odometry or state.odometry, state.odometry)
        self._odometry = state.odometry
        return Frame(
            time=time,
            odometry=_odometry(state),
            motion_covariance=motion.covariance,
            view=self._view(state),
            observations=detections,
        )


def _odometry(state: WalkingState) -> np.ndarray:
    """Pose of R in the odometry frame (3,) [m, m, rad]."""
    odometry = state.odometry
    return np.array([odometry.x, odometry.y, odometry.yaw])
