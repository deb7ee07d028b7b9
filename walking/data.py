"""State of a walk: records that the stages of a tick read and change.

`Data` is the whole state. The record of a subject is described here, its equations are in the file
of the subject. A plan is tried on a copy.
"""

from typing import Annotated

from compilation.record import Records, record_class
from walking.model import FootholdRecord, Strides
from walking.plane import Array

STEPS = 4  # planned footholds


@record_class
class Planar:
    """Vector in the plane."""

    x: float
    y: float


@record_class
class Pose:
    """Pose in the plane, or its rate."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]


@record_class
class Twist:
    """Velocity of the robot frame."""

    vx: float  # forward [m/s]
    vy: float  # to the left [m/s]
    wz: float  # yaw rate [rad/s]


# Command


@record_class
class StepCommand:
    """Explicit footstep, see `walking.command.CommandState`."""

    single_support: float  # [s]
    double_support: float  # [s]
    forward: float  # [m]
    side: float  # [m]
    direction: float  # [rad]
    swing_height: float  # [m]


@record_class
class CommandRecord:
    """Command: a velocity, or an explicit footstep."""

    explicit: bool  # whether it is a footstep
    velocity: Twist
    step: StepCommand


@record_class
class Timing:
    """Timing of a footstep."""

    double: int  # control ticks in double support [1]
    single: int  # control ticks in single support [1]
    swing_height: float  # height of the swing foot at mid-swing [m]


@record_class
class Steering:
    """Command as the walk follows it, see `walking.plan.steering`."""

    command: CommandRecord  # of this tick
    state: CommandRecord  # command state in force, if `explicit`
    velocity: Twist  # wanted
    peak: Twist  # last peak of its components, which braking refers to
    timing: Timing  # wanted
    wanted: Strides
    scratch: Strides  # intermediate result


# Gait


@record_class
class WeightShift:
    """Shift of ZMP and weight to the support foot."""

    begin: int  # ticks since the begin of the footstep [1]
    end: int  # ticks since the begin of the footstep [1]
    zmp_x: float  # ZMP at its begin [m]
    zmp_y: float  # [m]
    right_weight: float  # load fraction of the right foot at its begin [1]


@record_class
class SingleSupport:
    """Single support of a footstep."""

    ticks: int  # duration [1]
    first: int  # begin of the swing in ticks since the begin of single support [1]
    last: int  # end of the swing in these ticks [1]
    origin: float  # phase of the swing at `first`, which is the present if retimed in the air [1]


@record_class
class Clock:
    """Timing of the next footsteps, weight shift and single support of this one."""

    timing: Timing
    shift: WeightShift
    single: SingleSupport


@record_class
class Gait:
    """Gait, see `walking.plan.gait`."""

    stepping: bool  # whether a footstep is under way
    support: int  # index of the support foot
    completed: int  # completed footsteps
    landed_early: bool  # whether the swing foot touched down early
    shortened: bool  # whether this is a capture step shorter than its timing
    shift_fixed: bool  # whether the weight shift must keep its timing
    footholds: Annotated[Records[FootholdRecord], 2]  # present or last one of each foot
    landing: FootholdRecord  # of the swing foot
    clock: Clock
    tick: int  # ticks since the begin of the footstep [1]
    swing_height: float  # of this swing [m]


@record_class
class FootReference:
    """Reference of a foot in the plan frame."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]
    height: float  # above the floor [m]
    climb: float  # rate of the height in a swing [m/s]
    bend: float  # acceleration of the height in a swing [m/s²]
    rate: Pose  # of x, y and yaw
    acceleration: Pose  # of x, y and yaw


# Plan


@record_class
class Ramp:
    """Linear segment of the ZMP reference."""

    ticks: int  # duration [1]
    ax: float  # ZMP at its start [m]
    ay: float  # [m]
    bx: float  # ZMP at its end [m]
    by: float  # [m]
    unloading: FootholdRecord  # in single support the support foot
    loading: FootholdRecord


@record_class
class Plan:
    """Plan of the walk, see `walking.plan.reference`."""

    gait: Gait
    following: Strides  # after the next landing
    moving: bool  # whether the walk goes on
    ramps: Annotated[Records[Ramp], 2 * STEPS + 2]  # ZMP reference
    ramp_count: int
    steps: Annotated[Records[FootholdRecord], STEPS]  # footholds, the next landing first
    step_count: int


@record_class
class Pendulum:
    """Linear inverted pendulum in the plan frame."""

    x: float  # [m]
    y: float  # [m]
    vx: float  # [m/s]
    vy: float  # [m/s]
    zmp_x: float  # ZMP of the last tick [m]
    zmp_y: float  # [m]


@record_class
class ZmpFunctions:
    """ZMP functions along and across the support foot, see `walking.plan.mwpg`."""

    aimed: bool  # whether there is a target
    xi: Planar  # DCM at the end of single support [m]
    zeta: Planar  # convergent component then [m]
    free: bool  # whether the latter is free
    level: Planar  # of each function [m]
    switch: Planar  # time of its switch before the end of single support [s]
    missed_x: float  # part of the DCM that is out of reach [m]
    missed_y: float  # [m]


@record_class
class Admission:
    """Admission of a plan, see `walking.plan.admission`."""

    stepping: bool  # whether the gait was stepping in the last tick
    completed: int  # footsteps completed then
    clock: Clock  # of the last tick
    fraction: float  # admitted fraction of the wanted change [1]
    between: Timing  # of a plan that is tried
    functions: ZmpFunctions  # of a plan that is tried
    wanted: Plan
    trial: Plan  # a plan that is tried


@record_class
class Placing:
    """Foot placement, see `walking.plan.balance`."""

    applied: Twist  # velocity that the footsteps follow
    moved_x: float  # shift of the landing by a capture step [m]
    moved_y: float  # [m]
    shift: Planar  # of the present landing against the plan [m]


# Body


@record_class
class MeasuredFoot:
    """Measured foot in the level frame of the heading."""

    x: float  # [m]
    y: float  # [m]
    z: float  # [m]
    yaw: float  # [rad]
    load: float  # [N]
    pressure_x: float  # centre of pressure in the foot frame [m]
    pressure_y: float  # [m]


@record_class
class Body:
    """Measured body, see `walking.estimate.body`."""

    started: bool  # whether the tilt is known
    roll: float  # filtered [rad]
    pitch: float  # filtered [rad]
    heading: float  # of the IMU [rad]
    turn_rate: float  # [rad/s]
    frames: Annotated[Array, 3, 12]  # poses of feet and camera in the base frame, row by row [m]
    feet: Annotated[Records[MeasuredFoot], 2]
    com_x: float  # centre of mass in the level frame of the heading [m]
    com_y: float  # [m]
    com_z: float  # [m]
    right_load: float  # load fraction of the right foot, 0.5 in the air [1]


@record_class
class PlanError:
    """Error of the body against the plan, in the plan frame."""

    x: float  # of the centre of mass [m]
    y: float  # [m]
    vx: float  # [m/s]
    vy: float  # [m/s]
    weighted: bool  # whether the load fraction is known
    right_weight: float  # planned load fraction of the right foot [1]
    dcm_x: float  # [m]
    dcm_y: float  # [m]
    pressed: bool  # whether a foot carries load
    pressure_x: float  # of the centre of pressure, forward [m]
    pressure_y: float  # to the left [m]


@record_class
class Corrections:
    """Slow corrections, see `walking.plan.corrections`."""

    first: int  # first support foot of the gait cycle, -1 for none
    support: int  # last support foot, -1 for none
    max_error: float  # decaying maximum of the DCM error [m]
    held: float  # held offset of the heading [rad]
    turn: float  # yaw rate that corrects it [rad/s]
    speed: Planar  # correction of the velocity, forward and left [m/s]
    posed: bool  # whether the last poses are known
    pose: Pose  # last pose by odometry
    planned: Pose  # last planned centre of mass and heading
    slip: Planar  # planned minus measured displacement of the cycle, forward and left [m]
    ticks: int  # of the cycle, -1 for a discarded one [1]
    goal: Planar  # of the CoM offset [m]
    error_sum: Planar  # of the centre of pressure [m]
    errors: int  # their number, -1 for a discarded cycle [1]
    com_offset: Planar  # forward and left [m]
    contact: int  # ticks of contact of the swing foot [1]


@record_class
class Limbs:
    """Planned posture, see `walking.body.posture`."""

    moved: bool  # whether there is a posture before this tick
    feet: Annotated[Records[FootReference], 2]
    pelvis: Pose  # in the plan frame
    turn_rate: float  # yaw rate of the pelvis [rad/s]
    com_x: float  # centre of mass of the last posture in the base frame [m]
    com_y: float  # [m]
    offset: Planar  # of the pelvis for the reaction of the swing leg [m]
    ahead: Planar  # previewed shift of the ZMP by the swing leg [m]
    offset_acceleration: Planar  # [m/s²]
    foot_roll: Annotated[Array, 2]  # of each foot against the tilt of the trunk [rad]
    foot_pitch: Annotated[Array, 2]  # [rad]
    leg_angles: Annotated[Array, 12]  # also beyond their limits [rad]
    axes: Annotated[Array, 2, 6, 3]  # of the leg joints in the base frame
    origins: Annotated[Array, 2, 6, 3]  # of the leg joints in the base frame [m]
    leg_error: float  # remaining error of the inverse kinematics [rad]
    pan: float  # [rad]
    tilt: float  # [rad]
    pan_rate: float  # [rad/s]
    tilt_rate: float  # [rad/s]
    load: float  # planned load fraction of the right foot in this tick [1]


@record_class
class DeadReckoning:
    """Dead reckoning, see `walking.estimate.odometry`."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # heading, unwrapped [rad]
    yaw_known: bool  # whether the yaw of the IMU is known
    imu_yaw: float  # [rad]
    placed: bool  # whether the vectors from foot to body are known
    left_x: float  # vector from the left foot, in the odometry frame [m]
    left_y: float  # [m]
    right_x: float  # vector from the right foot [m]
    right_y: float  # [m]
    right_stance: bool  # whether the right foot is the stance foot
    sliding: bool  # whether both feet are loaded
    apart_x: float  # distance of the feet at the begin of that [m]
    apart_y: float  # [m]
    xx: float  # covariance of the error [m²]
    xy: float  # [m²]
    xw: float  # [m rad]
    yy: float  # [m²]
    yw: float  # [m rad]
    ww: float  # [rad²]
    forward_variance: float  # unmeasured, per tick [m²]
    lateral_variance: float  # [m²]
    yaw_variance: float  # [rad²]
    slip_ratio: float  # slip of the stance foot per relative slip of the feet [1]


@record_class
class Data:
    """State of the walk."""

    ticks: int  # since the start [1]
    body: Body
    error: PlanError
    steering: Steering
    plan: Plan  # in force
    corrections: Corrections
    admission: Admission
    placing: Placing
    pendulum: Pendulum  # of the body
    planned: Pendulum  # of the plan if `off_plan`
    off_plan: bool  # whether a capture step departs from the plan
    functions: ZmpFunctions  # in force
    zmp_shift: Planar  # by the ankles [m]
    zmp_depth: float  # of the planned ZMP in the support polygon [m]
    single: bool  # whether one foot supports
    unloading: FootholdRecord  # feet in contact
    loading: FootholdRecord
    last_opening_left: bool  # foot of the last opening step
    limits: int  # that bind in this tick, as bits
    limbs: Limbs
