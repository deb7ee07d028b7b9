"""Parameters of the walking engine.

The defaults were tuned for HSR-VIII in full physics with ``scripts/walk_study.py``. Each has a
dimension, by which `walking.constants.parameters_for` scales it to another robot. Fields with
bounds and a docstring are public keys of a scenario; the others are for studies.
"""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Interval, doc

from walking.dimension import (
    ACCELERATION,
    ANKLE_TIME,
    DECAY_PER_TICK,
    DIFFUSION,
    FORCE,
    GAIN_PER_TICK,
    HEIGHT,
    LENGTH,
    NUMBER,
    PER_LENGTH,
    RATE,
    RATE_CHANGE,
    SOLE,
    SPEED,
    STANCE,
    TIME,
)

CONTROL_PERIOD = 0.005  # Yoo & Kim: the walking pattern is recomputed every 5 ms [s]
GRAVITY = 9.81  # [m/s²]
LIGHT_LOAD = 0.074  # of the weight; the noise of unloaded foot pads stays below it [1]


@dataclass(frozen=True)
class GaitParameters:
    """Shape and timing of a footstep."""

    footstep_time: Annotated[
        float,
        Interval(ge=0.01, le=10.0),
        TIME,
        doc(
            "Duration of a footstep, double support included; shorter if the footsteps would "
            "exceed their limits [s]."
        ),
    ] = 0.34
    min_footstep_time: Annotated[
        float, Interval(ge=0.01, le=10.0), TIME, doc("Minimum duration of a footstep [s].")
    ] = 0.26
    double_support: Annotated[float, NUMBER] = 0.15  # fraction of the footstep [1]
    start_time: Annotated[float, TIME] = 0.3  # double support before the first footstep [s]
    stop_time: Annotated[float, TIME] = 0.3  # double support after the last footstep [s]
    settle_time: Annotated[float, TIME] = 0.5  # standing before the first command is followed [s]
    half_stance: Annotated[float, STANCE] = 0.042  # foot to the middle of the stance, lateral [m]
    swing_height: Annotated[
        float, Interval(ge=0.001, le=1.0), LENGTH, doc("Height of the swing foot at mid-swing [m].")
    ] = 0.025
    swing_height_rate: Annotated[float, SPEED] = 0.2  # maximum change of it in the air [m/s]
    swing_start: Annotated[float, NUMBER] = 0.05  # lift-off as a fraction of single support [1]
    swing_end: Annotated[float, NUMBER] = 0.97  # touchdown as a fraction of single support [1]
    landing_freeze: Annotated[float, NUMBER] = 0.8  # swing phase at which the landing is final [1]
    landing_speed: Annotated[float, SPEED] = 4.0  # maximum change of the landing in the air [m/s]
    landing_turn: Annotated[float, RATE] = 5.0  # maximum turn of the landing in the air [rad/s]
    min_swing_time: Annotated[float, TIME] = 0.05  # of a foot in the air until touchdown [s]
    swing_speed: Annotated[float, SPEED] = 3.0  # maximum speed of the foot in a capture step [m/s]
    capture_single: Annotated[float, TIME] = 0.12  # minimum single support of a capture step [s]
    capture_double: Annotated[float, TIME] = 0.015  # minimum double support of a capture step [s]
    # `foot_clearance` of a capture step, with margin for the body off its plan [m]
    capture_clearance: Annotated[float, LENGTH] = 0.020
    # distance of every corner of a landing sole from the strip of the support foot [m]
    foot_clearance: Annotated[float, LENGTH] = 0.012


@dataclass(frozen=True)
class PatternParameters:
    """Pattern generator: ZMP and pendulum."""

    generator: Annotated[
        Literal["preview", "mwpg"],
        doc(
            'Experimental. Pattern generator: "preview" is preview control of the ZMP within the '
            'support polygon, "mwpg" the modifiable walking pattern generator with two-level ZMP '
            "functions, which limits infeasible commands."
        ),
    ] = "preview"
    pelvis_height: Annotated[
        float, Interval(ge=0.02, le=5.0), LENGTH, doc("Height of the hips while walking [m].")
    ] = 0.204
    # height of the pendulum; below the centre of mass, since half of the mass is in the legs [m]
    lipm_height: Annotated[float, HEIGHT] = 0.19
    zmp_forward: Annotated[float, LENGTH] = 0.0  # ZMP ahead of the centre of the sole [m]
    zmp_inward: Annotated[float, STANCE] = 0.003  # ZMP inward of the ankle [m]
    sole_margin: Annotated[float, SOLE] = 0.005  # planned ZMP to the edge of the sole [m]
    dcm_gain: Annotated[float, NUMBER] = 3.0  # ZMP shift per error of the planned DCM [1]


@dataclass(frozen=True)
class EstimatorParameters:
    """State estimation and detection of contacts and falls."""

    tilt_gain: Annotated[float, GAIN_PER_TICK] = 0.03  # complementary filter, per tick [1]
    acceleration_noise: Annotated[float, ACCELERATION] = 4.0  # of the centre of mass [m/s²]
    position_noise: Annotated[float, LENGTH] = 0.0006  # of the measured centre of mass [m]
    contact_force: Annotated[float, FORCE] = 8.0  # load of a swing foot at touchdown [N]
    contact_ticks: int = 2  # duration of that load in control ticks [1]
    contact_phase: Annotated[float, NUMBER] = 0.55  # earliest swing phase of touchdown [1]
    fall_tilt: Annotated[float, NUMBER] = 0.8  # tilt of the trunk that counts as a fall [rad]


@dataclass(frozen=True)
class OdometryParameters:
    """Unmeasured motion in dead reckoning."""

    forward_noise: Annotated[
        float,
        Interval(ge=0.0, le=1.0),
        DIFFUSION,
        doc("Random walk along the heading while stepping [m/√s]."),
    ] = 0.0004
    lateral_noise: Annotated[
        float,
        Interval(ge=0.0, le=1.0),
        DIFFUSION,
        doc("Random walk across the heading while stepping [m/√s]."),
    ] = 0.0005
    slip_ratio: Annotated[
        float,
        Interval(ge=0.0, le=1.0),
        NUMBER,
        doc(
            "Slip of the stance foot per axis, per relative slip of the feet in double support [1]."
        ),
    ] = 0.5
    yaw_drift: Annotated[
        float, Interval(ge=0.0, le=1.0), NUMBER, doc("Random walk of the IMU's yaw [rad/√s].")
    ] = 0.00095


@dataclass(frozen=True)
class StabilizerParameters:
    """Balance feedback and servo feed-forward."""

    # decay rate of the DCM error by the ankles; sets the gain, see `ankle_gain` [1/s]
    dcm_rate: Annotated[float, RATE] = 4.24
    sole_margin: Annotated[float, SOLE] = 0.010  # ZMP shifted by the ankles to the sole's edge [m]
    gyro_gain: Annotated[float, ANKLE_TIME] = 0.02  # ankle setpoint per angular velocity [s]
    # hip setpoint per tilt of the trunk, of the legs that carry it [1]
    hip_gain: Annotated[float, NUMBER] = 0.5
    hip_damping: Annotated[float, TIME] = 0.04  # rate of the tilt in that setpoint, as a tilt [s]
    # part of the error of the body that the plan takes over, per tick and per excess of the DCM
    # error over the dead zone of the capture step, at most one [1]
    com_admittance: Annotated[float, GAIN_PER_TICK] = 0.022
    inertia_gain: Annotated[float, NUMBER] = 1.0  # accelerations in the feed-forward torques [1]
    max_inertia_acceleration: Annotated[float, RATE_CHANGE] = 300.0  # in these torques [rad/s²]
    velocity_gain: Annotated[float, NUMBER] = 0.6  # feed-forward of the servo lag, legs [1]
    velocity_ahead: Annotated[float, TIME] = 0.0  # time by which these rates are extrapolated [s]
    capture_dead_zone: Annotated[float, NUMBER] = 0.3  # DCM error per ZMP margin of the sole [1]
    capture_forward: Annotated[float, LENGTH] = 0.19  # maximum shift of a landing, forward [m]
    capture_side: Annotated[float, LENGTH] = 0.13  # maximum shift of a landing, lateral [m]
    tilt_gain: Annotated[float, NUMBER] = 0.7  # swing foot against the tilt of the trunk [1]
    tilt_dead_zone: Annotated[float, NUMBER] = 0.019  # of that tilt [rad]
    tilt_pull: Annotated[float, GAIN_PER_TICK] = 0.3  # filter gain of that correction [1]
    tilt_decay: Annotated[float, DECAY_PER_TICK] = 0.85  # of it after touchdown, per tick [1]
    contact_decay: Annotated[float, DECAY_PER_TICK] = 0.965  # height after early touchdown [1]
    max_slew_error: Annotated[float, LENGTH] = 0.03  # DCM error that freezes the velocity [m]
    slowdown_start_error: Annotated[float, LENGTH] = 0.015  # DCM error of full speed [m]
    slowdown_full_error: Annotated[float, LENGTH] = 0.04  # DCM error of the minimum speed [m]
    min_speed_ratio: Annotated[float, NUMBER] = 0.3  # of the commanded velocity [1]
    slowdown_time: Annotated[float, TIME] = 1.5  # decay of the maximum DCM error [s]
    step_error_ratio: Annotated[float, NUMBER] = 1.0  # DCM error per ZMP margin to step [1]
    heading_gain: Annotated[float, RATE] = 2.0  # yaw rate per heading error [1/s]
    max_heading_rate: Annotated[float, RATE] = 0.3  # of heading control [rad/s]
    speed_gain: Annotated[float, NUMBER] = 0.5  # filter gain of the mean slip, per gait cycle [1]
    max_speed_correction: Annotated[float, SPEED] = 0.06  # forward and lateral [m/s]
    max_speed_change: Annotated[float, SPEED] = 0.01  # of that correction per gait cycle [m/s]
    # shift of a landing by balance from which a cycle does not count for the CoM offset [m]
    max_steady_shift: Annotated[float, LENGTH] = 0.010
    com_offset_gain: Annotated[float, NUMBER] = 0.3  # per mean CoP error of a cycle [1]
    max_com_offset: Annotated[float, LENGTH] = 0.015  # forward and lateral [m]
    max_com_offset_rate: Annotated[float, SPEED] = 0.01  # [m/s]


@dataclass(frozen=True)
class LimitParameters:
    """Limits of commands and footsteps."""

    vx: Annotated[
        float, Interval(ge=0.001, le=50.0), SPEED, doc("Maximum speed forward [m/s].")
    ] = 0.55
    vx_backward: Annotated[
        float, Interval(ge=0.001, le=50.0), SPEED, doc("Maximum speed backward [m/s].")
    ] = 0.45
    vy: Annotated[
        float, Interval(ge=0.001, le=50.0), SPEED, doc("Maximum speed sideways [m/s].")
    ] = 0.20
    wz: Annotated[float, Interval(ge=0.001, le=50.0), RATE, doc("Maximum yaw rate [rad/s].")] = 2.0
    combined: Annotated[float, NUMBER] = 1.15  # norm of the velocity relative to these limits [1]
    forward_acceleration: Annotated[float, ACCELERATION] = 0.6  # [m/s²]
    lateral_acceleration: Annotated[float, ACCELERATION] = 0.5  # [m/s²]
    turn_acceleration: Annotated[float, RATE_CHANGE] = 3.3  # [rad/s²]
    braking_time: Annotated[float, TIME] = 0.3  # maximum time to rest [s]
    step_forward: Annotated[float, LENGTH] = 0.145  # footstep forward or backward [m]
    step_side: Annotated[float, LENGTH] = 0.12  # opening footstep beyond the stance [m]
    step_turn: Annotated[float, NUMBER] = 1.2  # turn of an opening footstep [rad]
    reach_forward: Annotated[float, LENGTH] = 0.20  # semi-axis of the ellipse of landings [m]
    reach_side: Annotated[float, LENGTH] = 0.12  # semi-axis of the ellipse of landings [m]
    min_single: Annotated[float, TIME] = 0.18  # single support of a command state [s]
    max_single: Annotated[float, TIME] = 0.6  # single support of a command state [s]
    max_double: Annotated[float, TIME] = 0.3  # double support of a command state [s]
    max_swing_height: Annotated[float, LENGTH] = 0.04  # of a command state [m]


@dataclass(frozen=True)
class HeadParameters:
    """Motion of pan and tilt."""

    max_rate: Annotated[
        float, Interval(ge=0.01, le=10_000.0), RATE, doc("Maximum rate of each axis [rad/s].")
    ] = 3.0
    max_acceleration: Annotated[
        float,
        Interval(ge=0.01, le=10_000.0),
        RATE_CHANGE,
        doc("Maximum angular acceleration of each axis [rad/s²]."),
    ] = 40.0


@dataclass(frozen=True)
class ArmParameters:
    """Counter-swing of the arms."""

    swing_gain: Annotated[float, PER_LENGTH] = 2.0  # pitch per distance of the feet [rad/m]
    max_swing: Annotated[float, NUMBER] = 0.35  # from the ready posture [rad]


@dataclass(frozen=True)
class GetUpParameters:
    """Getting up after a fall."""

    enabled: Annotated[
        bool,
        doc(
            "Whether a fallen robot gets up, which takes 10 to 25 s. Off by default: a fall ends "
            "a run, as in the paper's experiment. Falls count in both cases."
        ),
    ] = False
    max_attempts: int = 6  # motions, with turning over and rising one each [1]
    max_joint_speed: Annotated[float, RATE] = 12.0  # between postures [rad/s]
    time_scale: Annotated[float, TIME] = 1.0  # of the durations of the motions [1]
    rest_rate: Annotated[float, RATE] = 0.3  # maximum rate of a trunk at rest, each axis [rad/s]
    rest_time: Annotated[float, TIME] = 0.2  # at that rate [s]
    displacement_sigma: Annotated[float, LENGTH] = 0.2  # unmeasured motion of a fall per axis [m]
    yaw_sigma: Annotated[float, NUMBER] = 0.02  # error of the IMU's yaw over a fall [rad]


@dataclass(frozen=True)
class WalkingParameters:
    """All parameters of the walking engine."""

    gait: Annotated[GaitParameters, doc("Footsteps.")] = field(default_factory=GaitParameters)
    pattern: Annotated[PatternParameters, doc("Pattern generator.")] = field(
        default_factory=PatternParameters
    )
    estimator: EstimatorParameters = field(default_factory=EstimatorParameters)
    """State estimation."""
    odometry: Annotated[OdometryParameters, doc("Dead reckoning.")] = field(
        default_factory=OdometryParameters
    )
    stabilizer: StabilizerParameters = field(default_factory=StabilizerParameters)
    """Balance."""
    limits: Annotated[LimitParameters, doc("Limits of commands and footsteps.")] = field(
        default_factory=LimitParameters
    )
    head: Annotated[HeadParameters, doc("Head.")] = field(default_factory=HeadParameters)
    arms: ArmParameters = field(default_factory=ArmParameters)
    """Arms."""
    get_up: Annotated[GetUpParameters, doc("Getting up.")] = field(default_factory=GetUpParameters)
