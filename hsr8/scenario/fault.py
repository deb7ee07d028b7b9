"""Faults of sensors, servos and the environment, and random pushes: kind, time and magnitude."""

from collections.abc import Sequence
from typing import Annotated, Literal

from annotated_types import Interval, Len, doc
from pydantic import AfterValidator, Field, model_validator

from hsr8.robots.file.description import TRUNK
from hsr8.scenario.mission import SecondsRange
from hsr8.scenario.section import CONTROL_PERIOD_MS, Degrees, Point, Section, ordered

PushedBody = Annotated[str, Len(1, 1000)]
PushDuration = Annotated[float, Interval(ge=0.005, le=60.0)]
Impulse = Annotated[float, Interval(gt=0.0, le=1000.0), "N s"]
ImpulseRange = Annotated[tuple[Impulse, Impulse], AfterValidator(ordered)]
DegreesRange = Annotated[tuple[Degrees, Degrees], AfterValidator(ordered)]


class RandomPushes(Section):
    """Consecutive pushes drawn from the seed."""

    start: Annotated[
        float, Interval(ge=0.0, le=7200.0), "s", doc("Earliest time of the first push [s].")
    ] = 3.0
    interval: Annotated[SecondsRange, doc("Minimum and maximum time between pushes [s].")] = (
        2.0,
        4.0,
    )
    impulse: Annotated[
        ImpulseRange, doc("Minimum and maximum impulse: force times duration [N s].")
    ] = (0.2, 0.8)
    duration: Annotated[
        PushDuration, doc("Duration of a push, rounded to control ticks of 5 ms [s].")
    ] = 0.05
    direction_deg: Annotated[
        DegreesRange,
        doc("Range of directions of the force from the robot's heading, counter-clockwise [deg]."),
    ] = (-180.0, 180.0)
    body: Annotated[
        PushedBody,
        doc('Body that the force acts on; "trunk" is that which carries the arms or the head.'),
    ] = TRUNK


class Disturbance(Section):
    """Random disturbances; require the full body."""

    random: Annotated[RandomPushes | None, doc("Pushes drawn from the seed.")] = None

    @property
    def empty(self) -> bool:
        """Whether no disturbance is given."""
        return self.random is None


StartTime = Annotated[float, Interval(ge=0.0, le=7200.0), "s"]
FaultDuration = Annotated[float, Interval(ge=0.001 * CONTROL_PERIOD_MS, le=7200.0), "s"]
Offset = Annotated[float, Interval(ge=-2.0, le=2.0), "m"]
Fraction = Annotated[float, Interval(ge=0.0, le=1.0)]
Angle = Annotated[float, Interval(ge=-0.5, le=0.5)]
Foot = Literal["left", "right", "both"]
JOINT_GROUPS = {
    "all": slice(None),
    "legs": slice(0, 12),
    "left_leg": slice(0, 6),
    "right_leg": slice(6, 12),
}
"""Groups of joints in the order of every robot, legs first."""
_FEET = {"left": [0], "right": [1], "both": [0, 1]}


Joint = Annotated[str, Len(1, 1000)]


def ticks(seconds: float) -> int:
    """Number of control ticks nearest to a time."""
    return round(1000.0 * seconds / CONTROL_PERIOD_MS)


class _Fault(Section):
    kind: str
    """Kind of fault."""
    start: Annotated[StartTime, doc("Start, rounded to control ticks of 5 ms [s].")] = 0.0
    duration: Annotated[
        FaultDuration | None,
        doc("Duration, rounded to control ticks of 5 ms; default: until the end of the run [s]."),
    ] = None

    def acts(self, tick: int) -> bool:
        """Whether the fault is active in control tick `tick`."""
        first = ticks(self.start)
        return first <= tick and (self.duration is None or tick < first + ticks(self.duration))

    @property
    def begin(self) -> float:
        """Time of the first tick [s]."""
        return ticks(self.start) * CONTROL_PERIOD_MS / 1000.0

    @property
    def end(self) -> float | None:
        """Time of the first tick after the fault; None if it lasts until the end of the run [s]."""
        if self.duration is None:
            return None
        return (ticks(self.start) + ticks(self.duration)) * CONTROL_PERIOD_MS / 1000.0

    def text(self) -> str:
        """Kind and parameters in one line."""
        given = self.model_dump(exclude={"kind", "start", "duration"}, exclude_none=True)
        words = [f"{k} {f'{v:g}' if isinstance(v, float) else v}" for k, v in given.items()]
        return ", ".join((self.kind, *words))


class JointFault(_Fault):
    """Fault of some joints."""

    joint: Annotated[Joint, doc("A joint of the robot, or left_leg, right_leg, legs or all.")] = (
        "legs"
    )

    def joints(self, names: Sequence[str]) -> list[int]:
        """Return the indices of the joints in the `names` of all joints of the robot.

        Raises:
            ValueError: the robot has no such joint.
        """
        if self.joint in JOINT_GROUPS and self.joint not in names:
            return list(range(len(names)))[JOINT_GROUPS[self.joint]]
        return [names.index(self.joint)]


class _FootFault(_Fault):
    foot: Annotated[Foot, doc("Foot with the fault.")] = "both"

    @property
    def feet(self) -> list[int]:
        """0 for the left and 1 for the right foot."""
        return _FEET[self.foot]


class CameraBlack(_Fault):
    """Images are black."""

    kind: Literal["camera-black"]


class Lighting(_Fault):
    """The light intensity changes; requires rendered images."""

    kind: Literal["lighting"]
    magnitude: Annotated[
        float, Interval(ge=0.05, le=4.0), doc("Light intensity relative to `world.brightness` [1].")
    ]


class CameraDrops(_Fault):
    """Images are lost at random."""

    kind: Literal["camera-drops"]
    magnitude: Annotated[Fraction, doc("Fraction of lost images [1].")]


class MissedDetections(_Fault):
    """Obstacles and beacons in view are not detected, at random."""

    kind: Literal["missed-detections"]
    magnitude: Annotated[Fraction, doc("Probability of a miss per object and image [1].")]


class FalseDetections(_Fault):
    """Images show objects that do not exist."""

    kind: Literal["false-detections"]
    magnitude: Annotated[
        float, Interval(ge=0.0, le=20.0), doc("Mean number of false objects per image [1].")
    ]


class CameraLatency(_Fault):
    """Images arrive later; an image overtaken by a newer one is lost."""

    kind: Literal["camera-latency"]
    magnitude: Annotated[
        float,
        Interval(ge=0.0, le=0.5),
        doc("Delay added to `camera.latency_ms`, rounded up to camera periods [s]."),
    ]


class AttitudeBias(_Fault):
    """The attitude estimate of the IMU has a constant error."""

    kind: Literal["attitude-bias"]
    magnitude: Annotated[Angle, doc("Error of the angle [rad].")]
    axis: Annotated[Literal["roll", "pitch"], doc("Axis of the error.")] = "pitch"


class GyroBias(_Fault):
    """The gyroscope has a constant error; a yaw error accumulates in the heading of the IMU."""

    kind: Literal["gyro-bias"]
    magnitude: Annotated[float, Interval(ge=-1.0, le=1.0), doc("Error of the turn rate [rad/s].")]
    axis: Annotated[Literal["roll", "pitch", "yaw"], doc("Axis of the error.")] = "yaw"


class ImuFrozen(_Fault):
    """The IMU repeats its last reading."""

    kind: Literal["imu-frozen"]


class EncoderOffset(JointFault):
    """Joint encoders have a constant error."""

    kind: Literal["encoder-offset"]
    magnitude: Annotated[Angle, doc("Error of the joint angle [rad].")]


class EncoderFrozen(JointFault):
    """Joint encoders repeat their last angle and report zero velocity."""

    kind: Literal["encoder-frozen"]


class FootSensorDropout(_FootFault):
    """The force sensors of a foot read zero."""

    kind: Literal["foot-sensor-dropout"]


class FootGain(_FootFault):
    """The force sensors of a foot have a wrong gain."""

    kind: Literal["foot-gain"]
    magnitude: Annotated[
        float, Interval(ge=0.0, le=10.0), doc("Measured force divided by true force [1].")
    ]


class ServoWeak(JointFault):
    """Servos lose torque; requires the full body."""

    kind: Literal["servo-weak"]
    magnitude: Annotated[Fraction, doc("Remaining fraction of the maximum torque [1].")]


class ServoStuck(JointFault):
    """Servos hold their last setpoint."""

    kind: Literal["servo-stuck"]
    joint: Annotated[Joint, doc("A joint of the robot, or left_leg, right_leg, legs or all.")]


class ServoDelay(JointFault):
    """Servos receive their setpoints late."""

    kind: Literal["servo-delay"]
    magnitude: Annotated[
        float, Interval(ge=0.0, le=0.1), doc("Delay, rounded to control ticks of 5 ms [s].")
    ]


class Push(_Fault):
    """A constant horizontal force acts on one body; requires the full body."""

    kind: Literal["push"]
    duration: Annotated[PushDuration, doc("Duration, rounded to control ticks of 5 ms [s].")] = 0.05
    magnitude: Annotated[Impulse, doc("Impulse: force times duration [N s].")]
    direction_deg: Annotated[
        Degrees,
        doc(
            "Direction of the force from the robot's heading at the start; 90 is to the left [deg]."
        ),
    ] = 90.0
    body: Annotated[
        PushedBody,
        doc('Body that the force acts on; "trunk" is that which carries the arms or the head.'),
    ] = TRUNK
    point: Annotated[
        tuple[Offset, Offset, Offset],
        doc("Point of application relative to the body's centre of mass, in body axes [m]."),
    ] = (0.0, 0.0, 0.0)


class LowFriction(_Fault):
    """The friction of the soles is reduced; requires the full body."""

    kind: Literal["low-friction"]
    magnitude: Annotated[
        float,
        Interval(ge=0.01, le=2.0),
        doc("Friction coefficient of the soles; normally 0.8 [1]."),
    ]
    position: Annotated[
        Point | None, doc("Centre of the slippery patch in W; default: everywhere [m].")
    ] = None
    radius: Annotated[
        Annotated[float, Interval(gt=0.0, le=100.0), "m"] | None,
        doc("Radius of the patch; default: 0.3 world.scale [m]."),
    ] = None

    @model_validator(mode="after")
    def _placed(self) -> "LowFriction":
        if self.position is None and self.radius is not None:
            raise ValueError("radius requires position; without both the whole floor is slippery")
        return self

    def reach(self, scale: float) -> float:
        """Radius of the patch in a world of some scale [m]."""
        return 0.3 * scale if self.radius is None else self.radius


class Bump(_Fault):
    """A low disc lies on the floor, invisible to the camera; requires the full body."""

    kind: Literal["bump"]
    magnitude: Annotated[float, Interval(ge=0.001, le=0.5), "m", doc("Height [m].")]
    position: Annotated[Point, doc("Centre in W [m].")]
    radius: Annotated[float, Interval(ge=0.01, le=2.0), "m", doc("Radius [m].")] = 0.1


class MoverAppears(_Fault):
    """A moving obstacle exists only while the fault is active."""

    kind: Literal["mover-appears"]
    mover: Annotated[
        int,
        Interval(ge=0, le=255),
        doc("Index of the moving obstacle, from 0; obstacles placed by hand come first [1]."),
    ] = 0


CameraFault = (
    CameraBlack | Lighting | CameraDrops | MissedDetections | FalseDetections | CameraLatency
)
SensorFault = (
    AttitudeBias
    | GyroBias
    | ImuFrozen
    | EncoderOffset
    | EncoderFrozen
    | FootSensorDropout
    | FootGain
)
ServoFault = ServoStuck | ServoDelay
WorldFault = ServoWeak | LowFriction | Bump | Push
"""Faults that require a body with dynamics."""
Fault = Annotated[
    CameraFault | SensorFault | ServoFault | WorldFault | MoverAppears,
    Field(discriminator="kind"),
]
