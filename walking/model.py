"""Model of a robot and of its walk: constants of all compiled functions.

The sections of `WalkingParameters` are records under their names. Fields of variable length are
arrays next to the record, so the compiled code is the same for every robot.
"""

from dataclasses import dataclass
from typing import Annotated

from compilation.record import Records, record_class
from walking.parameters import (
    ArmParameters,
    EstimatorParameters,
    GaitParameters,
    HeadParameters,
    LimitParameters,
    PatternParameters,
    StabilizerParameters,
)
from walking.plane import Array, Indices

LEFT, RIGHT = 0, 1
"""Index of a foot."""
CAMERA = 2
"""Index of the camera in `Model.frames`, after the feet."""


@dataclass(frozen=True, slots=True)
class Sole:
    """Rectangle of a sole in the foot frame.

    Attributes:
        centre: middle of the sole ahead of the ankle [m].
        half_length: half of its length [m].
        half_width: half of its width [m].
    """

    centre: float
    half_length: float
    half_width: float

    def pressed(self, forward: float, side: float) -> "Sole":
        """Return the part of the sole that weak ankles can press on the floor.

        A ZMP at a distance from the ankle needs a torque of that distance times the weight.

        Args:
            forward: distance from the ankle that the pitch joint can hold [m].
            side: distance that the roll joint can hold [m].
        """
        front, back = self.centre + self.half_length, self.centre - self.half_length
        if front <= forward and -back <= forward and self.half_width <= side:
            return self
        front, back = min(front, forward), max(back, -forward)
        return Sole(0.5 * (front + back), 0.5 * (front - back), min(self.half_width, side))


@record_class
class FootholdRecord:
    """Pose of a foot on the floor, see `walking.plan.footsteps.Foothold`."""

    left: bool  # whether it is the left foot
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]


@record_class
class Strides:
    """Landing of either foot in the frame of the other."""

    right: FootholdRecord
    left: FootholdRecord


@record_class
class HeadAxis:
    """Pan or tilt of the head."""

    joint: int  # index of its joint, -1 for none
    sign: float  # of the joint [1]
    rest: float  # angle with the head joints at zero [rad]
    lower: float  # limit [rad]
    upper: float  # limit [rad]


@record_class
class NeckRecord:
    """Joints of the head."""

    movable: bool  # whether there are any
    tilt_first: bool  # whether the tilt joint carries the pan joint
    pan: HeadAxis
    tilt: HeadAxis


@record_class
class Shoulder:
    """Shoulder pitch joint."""

    joint: int  # index of the joint, -1 for none
    sign: float  # 1 where a positive angle swings backward [1]


@record_class
class LegReach:
    """Reach of a leg."""

    hip_x: float  # origin of the hip pitch joint in the base frame [m]
    hip_y: float  # [m]
    hip_z: float  # [m]
    ankle_x: float  # ankle in the foot frame [m]
    ankle_y: float  # [m]
    ankle_z: float  # [m]
    length: float  # maximum distance between both [m]


@record_class
class Link:
    """Link of the robot, see `walking.body.tree.RobotTree.links`; the last is the base."""

    x: float  # origin of its joint in the frame of its parent [m]
    y: float  # [m]
    z: float  # [m]
    axis_x: float  # axis of its joint
    axis_y: float
    axis_z: float
    mass: float  # [kg]
    moment_x: float  # first moment of its mass in its frame [kg m]
    moment_y: float  # [kg m]
    moment_z: float  # [kg m]


@record_class
class Joint:
    """Joint of the robot: constants, planned motion and feed-forward."""

    lower: float  # limit [rad]
    upper: float  # limit [rad]
    lag: float  # of the servo behind a velocity [s]
    compliance: float  # of the servo [rad/(N m)]
    ready: float  # angle of the ready posture [rad]
    in_q: int  # index in the position of the dynamic model
    in_v: int  # index in its velocity
    angle: float  # planned [rad]
    rate: float  # planned [rad/s]
    rate_ahead: float  # rate for the feed-forward [rad/s]
    offset: float  # feed-forward of the setpoint [rad]


@record_class
class Model:
    """Constants of the robot and of its walk."""

    gait: GaitParameters
    pattern: PatternParameters
    estimator: EstimatorParameters
    stabilizer: StabilizerParameters
    limits: LimitParameters
    head: HeadParameters
    arms: ArmParameters
    modifiable: bool  # whether the modifiable pattern generator walks
    omega: float  # ω of the pendulum [1/s]
    cosh: float  # of ω times the control period [1]
    sinh: float  # of ω times the control period [1]
    weight: float  # [N]
    light_load: float  # load of an unloaded foot [N]
    leg_length: float  # hip to sole along the straight leg [m]
    sole: Sole  # all of each sole
    support: Sole  # part of it that the ankles can press on the floor
    com_ahead: float  # nominal centre of mass ahead of the base [m]
    height: float  # of the base above the floor [m]
    chains: Annotated[Array, 2, 7, 15]  # of the legs, see `walking.body.kinematics`
    reach: Annotated[Records[LegReach], 2]
    carriers: Annotated[Indices, 3]  # joints that carry feet and camera, -1 for the base
    frames: Annotated[Array, 3, 12]  # poses of feet and camera on these links
    ankle: int  # first joint of the ankle in a leg
    stiffening: float  # factor on the stiffness of the legs [1]
    shoulders: Annotated[Records[Shoulder], 2]
    neck: NeckRecord
    still: Strides  # of stepping in place
    thrust: float  # B of `walking.body.swing_reaction` [s²]
    lifted_weight: float  # K [s²/m]
    knee: float  # N [s²]
    position_gain: float  # of the filter of the centre of mass [1]
    velocity_gain: float  # of this filter [1/s]
    ankle_gain: float  # shift of the ZMP per DCM error [1]
