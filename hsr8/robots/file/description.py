"""Robot description: the file ``robot.toml`` next to a model, its keys and their meaning."""

import json
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Interval, Len, doc
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from hsr8.errors import ModelError
from hsr8.files.text import TomlError, parse_toml, read_text
from hsr8.mistakes import NAME, NAMES, TABLE, form, mistake_lines
from walking.parameters import LimitParameters

MODEL_SUFFIXES = (".xml", ".mjcf", ".urdf")
MIN_SPEED = 0.012
"""Minimum speed of a robot along every axis, for navigation [m/s or rad/s]."""
MIN_FOV, MAX_FOV = 10.0, 120.0  # vertical field of view of a camera [deg]


def _different(names: tuple[str, str]) -> tuple[str, str]:
    if names[0] == names[1]:
        raise ValueError(f"equal names, got {list(names)}; expected two parts")
    return names


def _rising(limits: tuple[float, float]) -> tuple[float, float]:
    if not limits[0] < limits[1]:
        raise ValueError(f"empty range, got {list(limits)}; expected lower < upper [rad]")
    return limits


Name = Annotated[str, Len(1, 200)]
Names = tuple[Name, Name]
Pair = Annotated[Names, AfterValidator(_different)]
Angle = Annotated[float, Interval(ge=-7.0, le=7.0)]
Positive = Annotated[float, Interval(gt=0.0, le=1e6)]
Length = Annotated[float, Interval(ge=-5.0, le=5.0)]
Size = Annotated[float, Interval(gt=0.0, le=5.0)]
Limits = Annotated[tuple[Angle, Angle], AfterValidator(_rising)]
Rate = Annotated[float, Interval(ge=0.01, le=1e4)]
Speed = Annotated[float, Interval(ge=MIN_SPEED, le=50.0)]
Sigma = Annotated[float, Interval(ge=0.0, le=1.0)]

COMBINED = LimitParameters().combined

TRUNK = "trunk"
"""Name, for any robot, of the body that carries its arms or head, else of its base."""


class Table(BaseModel):
    """Table of a description: strict types, no unknown keys, immutable."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class SoleRectangle(Table):
    """Rectangle of the left sole in the foot's body or link; the right one is its mirror image."""

    front: Annotated[Length, doc("Front edge, forward of the origin [m].")]
    back: Annotated[Length, doc("Back edge, forward of the origin; usually negative [m].")]
    left: Annotated[Length, doc("Left edge, to the left of the origin [m].")]
    right: Annotated[Length, doc("Right edge, to the left of the origin; usually negative [m].")]
    height: Annotated[Length, doc("Height of the sole above the origin; usually negative [m].")]

    @model_validator(mode="after")
    def _ordered(self) -> "SoleRectangle":
        for upper, lower in (("front", "back"), ("left", "right")):
            limit, value = getattr(self, lower), getattr(self, upper)
            if not value > limit:
                raise ValueError(
                    f"{upper} edge not beyond the {lower} edge, got {upper} = {value:g}, {lower} = "
                    f"{limit:g}; expected {upper} > {lower}"
                )
        return self


class CameraMount(Table):
    """Camera fixed to a body or link."""

    body: Annotated[Name, doc("Body or link that carries the camera.")]
    position: Annotated[
        tuple[Length, Length, Length],
        doc("Position in the base's directions from the origin of the body, at zero angles [m]."),
    ]
    tilt_deg: Annotated[
        Annotated[float, Interval(ge=-90.0, le=90.0)] | None,
        doc(
            "Elevation of the optical axis, upward positive; default: 0 on a head, else that with "
            "the upper border of the image 8 deg above the horizon [deg]."
        ),
    ] = None


class ServoRule(Table):
    """Position servos by rule, for models without usable servos."""

    compliance: Annotated[
        float,
        Interval(ge=0.005, le=10.0),
        doc("Relative compliance of a leg servo: weight times height over stiffness [rad/rad]."),
    ] = 0.1
    lag: Annotated[
        float,
        Interval(ge=0.001, le=1.0),
        doc("Maximum ratio of damping to stiffness of a leg servo [s]."),
    ] = 0.05
    upper_hz: Annotated[
        float, Interval(ge=0.5, le=200.0), doc("Natural frequency of the other servos [Hz].")
    ] = 6.0


Sole = Annotated[
    Annotated[Names, Tag(NAMES)] | Annotated[SoleRectangle, Tag(TABLE)], Discriminator(form)
]
Camera = Annotated[
    Annotated[Name, Tag(NAME)] | Annotated[CameraMount, Tag(TABLE)], Discriminator(form)
]
Servo = Annotated[
    Annotated[Literal["own", "rule"], Tag(NAME)] | Annotated[ServoRule, Tag(TABLE)],
    Discriminator(form),
]


class SpeedEnvelope(Table):
    """Speeds and reach with which the robot does not fall, by ``hsr8 robot calibrate``."""

    vx: Annotated[Speed, doc("Forward [m/s].")]
    vx_backward: Annotated[Speed, doc("Backward [m/s].")]
    vy: Annotated[Speed, doc("Sideways [m/s].")]
    wz: Annotated[Speed, doc("Turn rate [rad/s].")]
    combined: Annotated[
        float,
        Interval(ge=1.0, le=2.0),
        doc("Norm of the velocity relative to the other limits [1]."),
    ] = COMBINED
    reach: Annotated[
        float,
        Interval(ge=0.1, le=1.0),
        doc("Lateral reach of the landings, relative to that by rule [1]."),
    ] = 1.0


class Calibration(Table):
    """Properties measured in simulation by ``hsr8 robot calibrate``."""

    date: Annotated[Name, doc("Day of the measurement.")]
    version: Annotated[Name, doc("Version of hsr8.")]
    command: Annotated[Name, doc("Command that measured.")]
    speed: Annotated[SpeedEnvelope, doc("Speed envelope.")]
    turn_delay: Annotated[Sigma, doc("Delay from a commanded turn rate to half of it [s].")]
    lag: Annotated[Sigma, doc("Delay of the joints behind their targets [s].")]
    forward_noise: Annotated[Sigma, doc("Random walk of the odometry along the heading [m/√s].")]
    lateral_noise: Annotated[Sigma, doc("Random walk of the odometry across the heading [m/√s].")]
    tilt_sigma: Annotated[Sigma, doc("Standard deviation of the tilt of the camera pose [rad].")]
    roll_sigma: Annotated[Sigma, doc("Standard deviation of its roll [rad].")]
    yaw_sigma: Annotated[
        Sigma, doc("Standard deviation of its yaw against the heading by odometry [rad].")
    ]
    height_sigma: Annotated[Sigma, doc("Standard deviation of its height [m].")]


class About(Table):
    """Facts of a shipped robot, for a list that needs no models."""

    title: Annotated[Name, doc("Name for people.")]
    source: Annotated[Name, doc("Origin of the model.")]
    mass: Annotated[Positive, doc("Mass [kg].")]
    leg: Annotated[Size, doc("Hip to sole along the straight leg [m].")]
    joints: Annotated[int, Interval(ge=12, le=1000), doc("Number of joints.")]


class RobotDescription(Table):
    """Robot: its model file, the roles of its parts, and what the model does not say."""

    model: Annotated[
        Name, doc("MJCF or URDF file; a relative path is searched as `docs/robots.md` lists.")
    ]
    feet: Annotated[Pair, doc("Bodies or links of the left and the right foot.")]
    robot_descriptions: Annotated[
        Annotated[str, Field(pattern=r"^[a-z0-9_]+$")] | None,
        doc(
            "lower-case letters, digits and underscores: module of the package "
            "`robot_descriptions` that fetches the model where it is missing."
        ),
    ] = None
    base: Annotated[
        Name | None,
        doc(
            "Body of the pelvis; default: the last body that both legs share, fixed to the one "
            "with the free joint."
        ),
    ] = None
    sole: Annotated[
        Sole | None,
        doc(
            "Rectangle of the left sole, or the names of the left and the right geom; default: "
            "the lowest 4 mm of the foot's collision shapes, else of its visual ones."
        ),
    ] = None
    zero: Annotated[
        dict[Name, Angle],
        doc(
            "Joint angles at which the legs are straight and the soles flat, where not zero [rad]."
        ),
    ] = {}
    head: Annotated[Pair | None, doc("Pan and tilt joint of the head.")] = None
    shoulders: Annotated[
        Pair | None, doc("Left and right shoulder pitch joint, which swing while walking.")
    ] = None
    posture: Annotated[
        dict[Name, Angle], doc("Angles of the joints other than legs and head while walking [rad].")
    ] = {}
    srdf: Annotated[
        Name | None,
        doc("SRDF file with a group state that completes `posture`; relative to the description."),
    ] = None
    state: Annotated[
        Name | None,
        doc("Name of that group state; without `srdf`, of a keyframe of an MJCF file."),
    ] = None
    camera: Annotated[
        Camera | None,
        doc(
            "Camera of the model, or where to mount one; default: in front of the head or of the "
            "upper trunk."
        ),
    ] = None
    vertical_fov_deg: Annotated[
        Annotated[float, Interval(ge=MIN_FOV, le=MAX_FOV)] | None,
        doc(
            "Vertical field of view of the camera; default: that of the model's camera, else of "
            "the scenario [deg]."
        ),
    ] = None
    radius: Annotated[
        Annotated[float, Interval(ge=0.01, le=2.0)] | None,
        doc(
            "Radius of the walking robot for navigation; default: from its shapes in the ready "
            "posture [m]."
        ),
    ] = None
    servo: Annotated[
        Servo | None,
        doc("Position servos of the model, or by rule; default: own if the model has them."),
    ] = None
    linkage: Annotated[
        Literal["serial"] | None,
        doc("Drive the joints of legs with rods, couplings, gears or several motors directly."),
    ] = None
    tuned: Annotated[
        bool,
        doc("Whether the default parameters of walking are those of the robot; else scaled ones."),
    ] = False
    effort: Annotated[
        dict[Name, Positive],
        doc("Maximum torque by joint, where the model is silent or wrong [N m]."),
    ] = {}
    range: Annotated[
        dict[Name, Limits],
        doc("Lower and upper limit by joint, where the model is silent or wrong [rad]."),
    ] = {}
    speed: Annotated[
        dict[Name, Positive],
        doc("Maximum speed by joint, where the model is silent or wrong [rad/s]."),
    ] = {}
    rigid: Annotated[
        tuple[Name, ...], doc("Joints to fix at their angle in the ready posture.")
    ] = ()
    repair_inertia: Annotated[
        bool, doc("Whether an impossible inertia is replaced by that of a ball of equal mass.")
    ] = False
    packages: Annotated[
        dict[Name, Name],
        doc("Folder of each package named in a ``package://`` path of a URDF file."),
    ] = {}
    head_rate: Annotated[
        Rate | None,
        doc("Maximum rate of the head joints; default: from their speed limits [rad/s]."),
    ] = None
    head_acceleration: Annotated[
        Rate | None,
        doc(
            "Maximum angular acceleration of the head joints; default: from torque and inertia, "
            "at most that of HSR-VIII [rad/s²]."
        ),
    ] = None
    about: Annotated[About | None, doc("Facts of a shipped robot.")] = None
    calibration: Annotated[
        Calibration | None, doc("Properties measured by ``hsr8 robot calibrate``.")
    ] = None

    @model_validator(mode="after")
    def _consistent(self) -> "RobotDescription":
        if self.srdf is not None and self.state is None:
            raise ValueError("state: missing, got srdf alone; expected both")
        for key in ("head_rate", "head_acceleration"):
            if getattr(self, key) is not None and self.head is None:
                raise ValueError(f"{key}: the description has no head; expected the key head")
        for key, other in (("shoulders", "head"), ("rigid", "head"), ("rigid", "shoulders")):
            if both := sorted({*(getattr(self, key) or ())} & {*(getattr(self, other) or ())}):
                raise ValueError(f"{key}: joint {both[0]!r} is also in {other}; expected one key")
        if both := sorted(self.zero.keys() & self.posture.keys()):
            raise ValueError(f"posture.{both[0]}: also in zero; expected one key")
        return self


def read_description(file: Path) -> RobotDescription:
    """Read a description file.

    Raises:
        ModelError: the file is a model or cannot be read, or a key is wrong; the message lists
            every mistake.
    """
    if file.suffix.lower() in MODEL_SUFFIXES:
        raise ModelError(
            f"{file}: got a model; expected a description, which `hsr8 robot inspect {file} "
            "--write FILE` makes"
        )
    try:
        text = read_text(file)
        data = parse_toml(text)
    except (OSError, TomlError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ModelError(f"{file}: cannot be read: {reason}") from error
    return checked(data, str(file), text)


def checked(data: dict[str, Any], source: str, text: str = "") -> RobotDescription:
    """Return the description with these keys.

    Args:
        data: keys and values.
        source: file, for messages.
        text: text of the file, for the lines of the keys.

    Raises:
        ModelError: a key is wrong; the message begins with `source` and lists every mistake.
    """
    try:
        return RobotDescription.model_validate_json(json.dumps(data, default=str))
    except ValidationError as error:
        lines = mistake_lines(error, RobotDescription, data, source, text)
        if len(lines) > 1:
            lines.insert(0, f"{source}: {error.error_count()} mistakes")
        raise ModelError("\n  ".join(lines)) from error
