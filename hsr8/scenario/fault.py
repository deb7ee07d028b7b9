"""What fails, when, for how long and how badly: one vocabulary for all parts of robot and world."""

from typing import Annotated, Literal

from annotated_types import Interval
from pydantic import Field, model_validator

from hsr8.scenario.disturbance import Impulse, PushDuration, PushedBody
from hsr8.scenario.section import CONTROL_PERIOD_MS, Degrees, Point, Section
from walking.body.joints import JOINT_NAMES, LEFT_LEG, RIGHT_LEG

Instant = Annotated[float, Interval(ge=0.0, le=7200.0)]
Lasting = Annotated[float, Interval(ge=0.001 * CONTROL_PERIOD_MS, le=7200.0)]
Offset = Annotated[float, Interval(ge=-0.5, le=0.5)]
Share = Annotated[float, Interval(ge=0.0, le=1.0)]
Foot = Literal["left", "right", "both"]
Joint = Literal[
    "all",
    "legs",
    "left_leg",
    "right_leg",
    "l_hip_yaw",
    "l_hip_roll",
    "l_hip_pitch",
    "l_knee",
    "l_ankle_pitch",
    "l_ankle_roll",
    "r_hip_yaw",
    "r_hip_roll",
    "r_hip_pitch",
    "r_knee",
    "r_ankle_pitch",
    "r_ankle_roll",
    "head_pan",
    "head_tilt",
    "l_shoulder_pitch",
    "l_shoulder_roll",
    "l_elbow_yaw",
    "l_elbow_pitch",
    "l_wrist_yaw",
    "l_gripper",
    "r_shoulder_pitch",
    "r_shoulder_roll",
    "r_elbow_yaw",
    "r_elbow_pitch",
    "r_wrist_yaw",
    "r_gripper",
]
_GROUPS = {
    "all": JOINT_NAMES,
    "legs": (*JOINT_NAMES[LEFT_LEG], *JOINT_NAMES[RIGHT_LEG]),
    "left_leg": JOINT_NAMES[LEFT_LEG],
    "right_leg": JOINT_NAMES[RIGHT_LEG],
}
_SIDES = {"left": (0,), "right": (1,), "both": (0, 1)}


def ticks(seconds: float) -> int:
    """Whole control ticks in so many seconds, to the nearest."""
    return round(1000.0 * seconds / CONTROL_PERIOD_MS)


class _Fault(Section):
    kind: str
    """What fails."""
    start: Instant = 0.0
    """When it begins, in whole control ticks of 5 ms [s]."""
    duration: Lasting | None = None
    """How long it lasts, in whole control ticks; to the end of the run if left out [s]."""

    def acts(self, tick: int) -> bool:
        """Whether it acts in control tick `tick`."""
        first = ticks(self.start)
        return first <= tick and (self.duration is None or tick < first + ticks(self.duration))

    @property
    def begin(self) -> float:
        """When its first tick is [s]."""
        return ticks(self.start) * CONTROL_PERIOD_MS / 1000.0

    @property
    def end(self) -> float | None:
        """When it is over; None if it lasts to the end of the run [s]."""
        if self.duration is None:
            return None
        return (ticks(self.start) + ticks(self.duration)) * CONTROL_PERIOD_MS / 1000.0

    def text(self) -> str:
        """The fault in words: its kind and what is not left at its default."""
        given = self.model_dump(exclude={"kind", "start", "duration"}, exclude_none=True)
        said = [f"{k} {f'{v:g}' if isinstance(v, float) else v}" for k, v in given.items()]
        return ", ".join((self.kind, *said))


class _JointFault(_Fault):
    joint: Joint = "legs"
    """One joint, a leg, both legs, or all."""

    @property
    def joints(self) -> list[int]:
        """Indices in ``JOINT_NAMES``."""
        return [JOINT_NAMES.index(name) for name in _GROUPS.get(self.joint, (self.joint,))]


class _FootFault(_Fault):
    foot: Foot = "both"
    """Left, right, or both."""

    @property
    def feet(self) -> list[int]:
        """0 for the left and 1 for the right foot."""
        return list(_SIDES[self.foot])


class CameraBlack(_Fault):
    """Images are black."""

    kind: Literal["camera-black"]
    """Images are black."""


class CameraLight(_Fault):
    """All lights change; of rendered images."""

    kind: Literal["camera-light"]
    """The lights are weaker or stronger."""
    size: Annotated[float, Interval(ge=0.05, le=4.0)]
    """Strength of all lights, relative to world.brightness [1]."""


class CameraDrops(_Fault):
    """Some images never arrive."""

    kind: Literal["camera-drops"]
    """Images are lost."""
    size: Share
    """Share of the images that never arrive [1]."""


class CameraMisses(_Fault):
    """Some things that are there are not shown."""

    kind: Literal["camera-misses"]
    """Things are not shown."""
    size: Share
    """Share of obstacles and beacons that an image does not show though they are there [1]."""


class CameraGhosts(_Fault):
    """Things are shown that are not there."""

    kind: Literal["camera-ghosts"]
    """Things are shown that are not there."""
    size: Annotated[float, Interval(ge=0.0, le=20.0)]
    """Mean number of them in an image [1]."""


class CameraLate(_Fault):
    """Images arrive late; one that a newer one overtakes never arrives."""

    kind: Literal["camera-late"]
    """Images arrive late."""
    size: Annotated[float, Interval(ge=0.0, le=0.5)]
    """Delay on top of camera.latency_ms, rounded up to whole camera periods [s]."""


class ImuTilt(_Fault):
    """The attitude that the IMU reports is tilted."""

    kind: Literal["imu-tilt"]
    """A wrong attitude."""
    size: Annotated[float, Interval(ge=-0.5, le=0.5)]
    """Error of the tilt [rad]."""
    axis: Literal["roll", "pitch"] = "pitch"
    """About the robot's forward, or about its left."""


class ImuTurn(_Fault):
    """The gyroscope is biased; about the vertical, the IMU's yaw turns away with it."""

    kind: Literal["imu-turn"]
    """A biased gyroscope."""
    size: Annotated[float, Interval(ge=-1.0, le=1.0)]
    """Error of the turn rate; the yaw that it has turned meanwhile stays [rad/s]."""
    axis: Literal["roll", "pitch", "yaw"] = "yaw"
    """Axis of the IMU."""


class ImuFrozen(_Fault):
    """The IMU goes on reporting its last reading."""

    kind: Literal["imu-frozen"]
    """A frozen IMU."""


class EncoderOffset(_JointFault):
    """Encoders are off by an angle."""

    kind: Literal["encoder-offset"]
    """A wrong angle."""
    size: Annotated[float, Interval(ge=-0.5, le=0.5)]
    """Error of the angle [rad]."""


class EncoderFrozen(_JointFault):
    """Encoders go on reporting their last angle, and no motion."""

    kind: Literal["encoder-frozen"]
    """Frozen encoders."""


class FootDead(_FootFault):
    """The pads of a foot report no force."""

    kind: Literal["foot-dead"]
    """Dead pads."""


class FootGain(_FootFault):
    """The pads of a foot report a multiple of the force."""

    kind: Literal["foot-gain"]
    """A wrong gain."""
    size: Annotated[float, Interval(ge=0.0, le=10.0)]
    """Reported over true force [1]."""


class ServoWeak(_JointFault):
    """Servos lose torque; needs the full body."""

    kind: Literal["servo-weak"]
    """Less torque."""
    size: Share
    """Share of the largest torque that is left [1]."""


class ServoStuck(_JointFault):
    """Servos keep the last set-point."""

    kind: Literal["servo-stuck"]
    """Set-points no longer arrive."""
    joint: Joint
    """One joint, a leg, both legs, or all."""


class ServoLate(_JointFault):
    """Set-points arrive late."""

    kind: Literal["servo-late"]
    """Set-points arrive late."""
    size: Annotated[float, Interval(ge=0.0, le=0.1)]
    """How late, in whole control ticks of 5 ms [s]."""


class Push(_Fault):
    """A constant horizontal force on one body; needs the full body."""

    kind: Literal["push"]
    """A push."""
    duration: PushDuration = 0.05
    """How long it lasts, in whole control ticks [s]."""
    size: Impulse
    """Impulse, force times duration [N s]."""
    direction_deg: Degrees = 90.0
    """Where it pushes to: 0 is the robot's forward when it begins, 90 its left [deg]."""
    body: PushedBody = "torso_link"
    """What is pushed."""
    point: tuple[Offset, Offset, Offset] = (0.0, 0.0, 0.0)
    """Where, from the body's centre of mass, along the body's axes [m]."""


class Slippery(_Fault):
    """The soles slip on the floor; needs the full body."""

    kind: Literal["slippery"]
    """Less friction."""
    size: Annotated[float, Interval(ge=0.01, le=2.0)]
    """Friction coefficient of the soles on whatever they stand on; 0.8 is usual [1]."""
    place: Point | None = None
    """Middle of the slippery patch in W; everywhere if left out [m]."""
    radius: Annotated[float, Interval(gt=0.0, le=20.0)] | None = None
    """Of the patch, within which the middle of a sole slips; 0.3 if left out [m]."""

    @model_validator(mode="after")
    def _placed(self) -> "Slippery":
        if self.place is None and self.radius is not None:
            raise ValueError("a radius needs a place; without one it is slippery everywhere")
        return self

    @property
    def reach(self) -> float:
        """Radius of the patch [m]."""
        return 0.3 if self.radius is None else self.radius


class Bump(_Fault):
    """A low disc on the floor that vision does not know; needs the full body."""

    kind: Literal["bump"]
    """Something low on the floor."""
    size: Annotated[float, Interval(ge=0.001, le=0.05)]
    """Height [m]."""
    place: Point
    """Middle in W [m]."""
    radius: Annotated[float, Interval(ge=0.01, le=0.5)] = 0.1
    """Radius [m]."""


class MoverAppears(_Fault):
    """A mover that is not there before and not afterwards; where it moves is its own law."""

    kind: Literal["mover-appears"]
    """A mover that appears."""
    mover: Annotated[int, Interval(ge=0, le=255)] = 0
    """Which of the movers, counted from 0; those placed by hand come first [1]."""


CameraFault = CameraBlack | CameraLight | CameraDrops | CameraMisses | CameraGhosts | CameraLate
SensorFault = ImuTilt | ImuTurn | ImuFrozen | EncoderOffset | EncoderFrozen | FootDead | FootGain
ServoFault = ServoStuck | ServoLate
WorldFault = ServoWeak | Slippery | Bump | Push
"""Faults that only a body with dynamics has."""
Fault = Annotated[
    CameraFault | SensorFault | ServoFault | WorldFault | MoverAppears,
    Field(discriminator="kind"),
]
