"""Every number of the walking engine that is a choice, not a property of the robot.

The defaults were chosen for HSR-VIII in full physics with ``scripts/walk_study.py``. Every
number carries what it goes with from robot to robot; `walking.scaling.parameters_for`
makes of the defaults those of another robot.
"""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Interval

from walking.dimension import (
    ACCELERATION,
    ANKLE_TIME,
    CHANGE_WEIGHT,
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
    SOLE_SPEED,
    SPEED,
    STANCE,
    TIME,
)

CONTROL_PERIOD = 0.005  # Yoo & Kim: the walking pattern is recomputed every 5 ms [s]
GRAVITY = 9.81  # [m/s²]


@dataclass(frozen=True)
class GaitParameters:
    """Shape and timing of a footstep."""

    footstep_time: Annotated[float, Interval(ge=0.01, le=10.0), TIME] = 0.34
    """Duration of a footstep, double support included, while that keeps it short enough [s]."""
    min_footstep_time: Annotated[float, Interval(ge=0.01, le=10.0), TIME] = 0.26
    """Duration of a footstep at the quickest [s]."""
    double_support: Annotated[float, Interval(gt=0.0, lt=1.0), NUMBER] = 0.15
    """Fraction of the footstep in double support [1]."""
    start_time: Annotated[float, Gt(0.0), TIME] = 0.3
    """Double support before the first footstep [s]."""
    stop_time: Annotated[float, Gt(0.0), TIME] = 0.3
    """Time to bring the ZMP back between the feet after the last footstep [s]."""
    settle_time: Annotated[float, Ge(0.0), TIME] = 0.5
    """Standing before the first command is obeyed [s]."""
    half_stance: Annotated[float, Gt(0.0), STANCE] = 0.042
    """Lateral distance of a foot from the middle of the stance [m]."""
    swing_height: Annotated[float, Interval(ge=0.001, le=1.0), LENGTH] = 0.025
    """Height of the swing foot at mid-swing [m]."""
    swing_height_rate: Annotated[float, Gt(0.0), SPEED] = 0.2
    """Fastest change of that height while the foot is in the air [m/s]."""
    swing_start: Annotated[float, Interval(ge=0.0, lt=1.0), NUMBER] = 0.05
    """Fraction of single support after which the foot lifts [1]."""
    swing_end: Annotated[float, Interval(gt=0.0, le=1.0), NUMBER] = 0.97
    """Fraction of single support after which the foot is down [1]."""
    landing_freeze: Annotated[float, Interval(ge=0.0, le=1.0), NUMBER] = 0.8
    """Fraction of the swing after which the landing no longer moves [1]."""
    landing_speed: Annotated[float, Gt(0.0), SPEED] = 4.0
    """Fastest move of the landing while the foot is in the air [m/s]."""
    landing_turn: Annotated[float, Gt(0.0), RATE] = 5.0
    """Fastest turn of the landing while the foot is in the air [rad/s]."""
    min_swing_time: Annotated[float, Gt(0.0), TIME] = 0.05
    """Time that a foot in the air keeps to come down when a footstep is cut short [s]."""
    swing_speed: Annotated[float, Gt(0.0), SPEED] = 3.0
    """Fastest swing of a foot that hurries to catch a fall [m/s]."""
    capture_single: Annotated[float, Gt(0.0), TIME] = 0.12
    """Shortest single support to catch a fall [s]."""
    capture_double: Annotated[float, Gt(0.0), TIME] = 0.015
    """Shortest double support to catch a fall [s]."""
    capture_clearance: Annotated[float, Ge(0.0), LENGTH] = 0.020
    """What a footstep that catches a fall keeps for `foot_clearance`: the body is off its plan,
    and a swing foot that meets the other one cannot catch it [m]."""
    foot_clearance: Annotated[float, Ge(0.0), LENGTH] = 0.012
    """Distance of every corner of a landing sole from the strip of the support foot [m]."""
    preview_steps: Annotated[int, Gt(0)] = 4
    """Footholds planned ahead [1]."""


@dataclass(frozen=True)
class PatternParameters:
    """The ZMP pattern and the point that follows it."""

    generator: Literal["dcm", "preview", "paper", "robust"] = "robust"
    """Preview of the footholds by the DCM recursion or by Kajita's regulator; the modifiable
    walking pattern of the paper, two-level ZMP functions in single support; or a plan whose ZMP
    is inside the soles at all times, a command that does not allow one being altered."""
    pelvis_height: Annotated[float, Interval(ge=0.02, le=5.0), LENGTH] = 0.204
    """Height of the hips while walking [m]."""
    lipm_height: Annotated[float, Gt(0.0), HEIGHT] = 0.19
    """Height of the pendulum that the pelvis follows; less than the height of the centre
    of mass because half of the mass is in the legs [m]."""
    zmp_forward: Annotated[float, LENGTH] = 0.0
    """Where the ZMP is meant to be ahead of the middle of the sole [m]."""
    zmp_inward: Annotated[float, STANCE] = 0.003
    """Where the ZMP is meant to be inward of the ankle [m]."""
    sole_margin: Annotated[float, Ge(0.0), SOLE] = 0.005
    """Distance that the planned ZMP keeps from the edge of the sole [m]."""
    plan_margin: Annotated[float, Ge(0.0), LENGTH] = 0.018
    """Distance that the robust plan's ZMP keeps from the edge of the sole, so that the ankles
    have room beside it; undisturbed it is never less, else the sole's margin counts [m]."""
    zmp_rate: Annotated[float, Gt(0.0), SOLE_SPEED] = 4.0
    """Fastest move of the robust plan's ZMP in single support [m/s]."""
    dcm_gain: Annotated[float, Gt(1.0), NUMBER] = 3.0
    """ZMP moved per error of the planned DCM [1]."""
    preview_time: Annotated[float, Gt(0.0), TIME] = 1.2
    """Horizon of Kajita's regulator [s]."""
    preview_weight: Annotated[float, Gt(0.0), CHANGE_WEIGHT] = 100.0
    """Weight of the ZMP's change per tick in Kajita's regulator, that of its error one [1]."""


@dataclass(frozen=True)
class EstimatorParameters:
    """How far each sensor is trusted."""

    tilt_gain: Annotated[float, Interval(gt=0.0, le=1.0), GAIN_PER_TICK] = 0.03
    """Pull of the IMU's attitude on the integrated gyro, per tick [1]."""
    acceleration_noise: Annotated[float, Gt(0.0), ACCELERATION] = 4.0
    """Unknown acceleration of the centre of mass [m/s²]."""
    position_noise: Annotated[float, Gt(0.0), LENGTH] = 0.0006
    """Noise of the measured centre of mass [m]."""
    contact_force: Annotated[float, Gt(0.0), FORCE] = 8.0
    """Load from which a swinging foot has touched the floor [N]."""
    contact_ticks: Annotated[int, Gt(0)] = 2
    """Control ticks that the load must last [1]."""
    contact_phase: Annotated[float, Interval(ge=0.0, le=1.0), NUMBER] = 0.55
    """Fraction of the swing before which no touchdown is believed [1]."""
    fall_tilt: Annotated[float, Gt(0.0), NUMBER] = 0.8
    """Tilt of the trunk at which the robot believes that it has fallen [rad]."""


@dataclass(frozen=True)
class OdometryParameters:
    """How much of the robot's motion its dead reckoning does not see."""

    forward_noise: Annotated[float, Interval(ge=0.0, le=1.0), DIFFUSION] = 0.0004
    """Random walk along the heading while stepping [m/√s]."""
    lateral_noise: Annotated[float, Interval(ge=0.0, le=1.0), DIFFUSION] = 0.0005
    """Random walk across the heading while stepping [m/√s]."""
    slip_ratio: Annotated[float, Interval(ge=0.0, le=1.0), NUMBER] = 0.5
    """Unseen displacement per axis, by how far the feet slid against each other [1]."""
    yaw_drift: Annotated[float, Interval(ge=0.0, le=1.0), NUMBER] = 0.00095
    """Random walk of the IMU's yaw [rad/√s]."""


@dataclass(frozen=True)
class StabilizerParameters:
    """Feedback and feed-forward on the servos' setpoints."""

    dcm_rate: Annotated[float, Ge(0.0), RATE] = 4.24
    """Pole at which the ankles make an error of the measured DCM fade; the gain follows from it,
    the pendulum and the servos, see `pole_placement.dcm_gain` [1/s]."""
    sole_margin: Annotated[float, Ge(0.0), SOLE] = 0.010
    """Distance that the ZMP moved by the ankles keeps from the edge of the sole [m]."""
    gyro_gain: Annotated[float, Ge(0.0), ANKLE_TIME] = 0.02
    """Ankle setpoint per angular velocity of the trunk [s]."""
    load_gain: Annotated[float, Ge(0.0), NUMBER] = 1.0
    """Fraction of the planned joint torques fed forward [1]."""
    inertia_gain: Annotated[float, Ge(0.0), NUMBER] = 1.0
    """Fraction of the joints' planned acceleration in those torques [1]."""
    max_inertia_acceleration: Annotated[float, Ge(0.0), RATE_CHANGE] = 300.0
    """Largest acceleration of a joint in those torques [rad/s²]."""
    velocity_gain: Annotated[float, Ge(0.0), NUMBER] = 0.6
    """Fraction of the servos' velocity lag fed forward, legs [1]."""
    upper_velocity_gain: Annotated[float, Ge(0.0), NUMBER] = 1.0
    """Fraction of the servos' velocity lag fed forward, head and arms [1]."""
    capture_dead_zone: Annotated[float, Ge(0.0), NUMBER] = 0.3
    """DCM error left to the ankles, as a fraction of the ZMP room they have [1]."""
    capture_forward: Annotated[float, Ge(0.0), LENGTH] = 0.19
    """Largest move of a landing forward or backward to catch a fall [m]."""
    capture_side: Annotated[float, Ge(0.0), LENGTH] = 0.13
    """Largest move of a landing sideways to catch a fall [m]."""
    tilt_gain: Annotated[float, Ge(0.0), NUMBER] = 0.7
    """Fraction of the trunk's tilt taken out of the swing foot [1]."""
    tilt_dead_zone: Annotated[float, Ge(0.0), NUMBER] = 0.019
    """Tilt below which the swing foot ignores it [rad]."""
    tilt_pull: Annotated[float, Interval(gt=0.0, le=1.0), GAIN_PER_TICK] = 0.3
    """Fraction of the way per tick on which the swing foot's compensation follows [1]."""
    tilt_decay: Annotated[float, Interval(ge=0.0, lt=1.0), DECAY_PER_TICK] = 0.85
    """What is left per tick of the foot's compensation after touchdown [1]."""
    contact_decay: Annotated[float, Interval(ge=0.0, lt=1.0), DECAY_PER_TICK] = 0.965
    """What is left per tick of the height at which a foot touched down early [1]."""
    max_slew_error: Annotated[float, Gt(0.0), LENGTH] = 0.03
    """DCM error beyond which the velocity no longer changes [m]."""
    slowdown_start_error: Annotated[float, Gt(0.0), LENGTH] = 0.015
    """DCM error up to which the robot walks as fast as it is told [m]."""
    slowdown_full_error: Annotated[float, Gt(0.0), LENGTH] = 0.04
    """DCM error at which it walks slowest [m]."""
    min_speed_ratio: Annotated[float, Interval(ge=0.0, le=1.0), NUMBER] = 0.3
    """Fraction of the commanded velocity that is left then [1]."""
    slowdown_time: Annotated[float, Gt(0.0), TIME] = 1.5
    """Time constant with which a DCM error is forgotten [s]."""
    step_error_ratio: Annotated[float, Gt(0.0), NUMBER] = 1.0
    """DCM error, as a fraction of the ZMP room, at which a standing robot steps [1]."""
    heading_gain: Annotated[float, Ge(0.0), RATE] = 2.0
    """Turn rate per error of the heading [1/s]."""
    max_heading_rate: Annotated[float, Ge(0.0), RATE] = 0.3
    """Largest turn rate of the heading hold [rad/s]."""
    speed_gain: Annotated[float, Interval(ge=0.0, lt=1.0), NUMBER] = 0.5
    """Fraction of what two footsteps of a steady walk miss of its velocity that is made up for [1]."""
    max_speed_correction: Annotated[float, Ge(0.0), SPEED] = 0.06
    """Most that is made up for, forward and sideways [m/s]."""
    max_steady_shift: Annotated[float, Ge(0.0), LENGTH] = 0.010
    """Move of a landing for balance up to which a walk is steady: speed, heading and centre of
    pressure are held over two of its footsteps [m]."""
    com_offset_gain: Annotated[float, Interval(ge=0.0, lt=1.0), NUMBER] = 0.3
    """Fraction of the centre of pressure's mean error over two footsteps by which the body moves
    against it [1]."""
    max_com_offset: Annotated[float, Ge(0.0), LENGTH] = 0.015
    """Farthest that the body moves for it, forward and sideways [m]."""
    max_com_offset_rate: Annotated[float, Ge(0.0), SPEED] = 0.01
    """Fastest that it does [m/s]."""


@dataclass(frozen=True)
class LimitParameters:
    """What may be asked of the legs."""

    vx: Annotated[float, Interval(ge=0.001, le=50.0), SPEED] = 0.55
    """Fastest walk forward [m/s]."""
    vx_backward: Annotated[float, Interval(ge=0.001, le=50.0), SPEED] = 0.45
    """Fastest walk backward [m/s]."""
    vy: Annotated[float, Interval(ge=0.001, le=50.0), SPEED] = 0.20
    """Fastest walk sideways [m/s]."""
    wz: Annotated[float, Interval(ge=0.001, le=50.0), RATE] = 2.0
    """Fastest turn [rad/s]."""
    combined: Annotated[float, Gt(0.0), NUMBER] = 1.15
    """Largest norm of the velocity with every component in units of its limit [1]."""
    forward_acceleration: Annotated[float, Gt(0.0), ACCELERATION] = 0.6
    """Change of the forward velocity [m/s²]."""
    lateral_acceleration: Annotated[float, Gt(0.0), ACCELERATION] = 0.5
    """Change of the lateral velocity [m/s²]."""
    turn_acceleration: Annotated[float, Gt(0.0), RATE_CHANGE] = 3.3
    """Change of the turn rate [rad/s²]."""
    braking_time: Annotated[float, Gt(0.0), TIME] = 0.3
    """Longest time to come to rest [s]."""
    step_forward: Annotated[float, Gt(0.0), LENGTH] = 0.145
    """Longest footstep forward or backward [m]."""
    step_side: Annotated[float, Gt(0.0), LENGTH] = 0.12
    """Widest opening footstep beyond the stance [m]."""
    step_turn: Annotated[float, Gt(0.0), NUMBER] = 1.2
    """Largest turn of an opening footstep [rad]."""
    reach_forward: Annotated[float, Gt(0.0), LENGTH] = 0.20
    """Semi-axis of the ellipse of reachable landings, forward [m]."""
    reach_side: Annotated[float, Gt(0.0), LENGTH] = 0.12
    """Semi-axis of the ellipse of reachable landings, sideways [m]."""
    min_single: Annotated[float, Gt(0.0), TIME] = 0.18
    """Shortest single support of a command state [s]."""
    max_single: Annotated[float, Gt(0.0), TIME] = 0.6
    """Longest single support of a command state [s]."""
    max_double: Annotated[float, Gt(0.0), TIME] = 0.3
    """Longest double support of a command state [s]."""
    max_swing_height: Annotated[float, Gt(0.0), LENGTH] = 0.04
    """Highest swing of a command state [m]."""


@dataclass(frozen=True)
class HeadParameters:
    """Pan and tilt."""

    max_rate: Annotated[float, Interval(ge=0.01, le=10_000.0), RATE] = 6.0
    """Fastest turn of the head, each axis [rad/s]."""
    max_acceleration: Annotated[float, Interval(ge=0.01, le=10_000.0), RATE_CHANGE] = 60.0
    """Largest angular acceleration of the head, each axis [rad/s²]."""


@dataclass(frozen=True)
class ArmParameters:
    """The counter-swing of the arms."""

    swing_gain: Annotated[float, PER_LENGTH] = 2.0
    """Shoulder pitch per distance between the feet along the heading [rad/m]."""
    max_swing: Annotated[float, Ge(0.0), NUMBER] = 0.35
    """Largest swing from the ready posture [rad]."""


@dataclass(frozen=True)
class GetUpParameters:
    """Getting up after a fall."""

    enabled: bool = False
    """Whether a fallen robot gets up, so that the run goes on. Off, because a fall is to end a run
    of the paper's experiment, not to cost it 10 to 25 s; falls count either way."""
    max_attempts: Annotated[int, Ge(1)] = 6
    """Motions that are tried, turning over and rising each for one, before it gives up [1]."""
    max_joint_speed: Annotated[float, Gt(0.0), RATE] = 12.0
    """Fastest turn of a joint on the way from posture to posture [rad/s]."""
    time_scale: Annotated[float, Gt(0.0), TIME] = 1.0
    """Factor on the durations of the motions [1]."""
    rest_rate: Annotated[float, Gt(0.0), RATE] = 0.3
    """Angular velocity of the trunk below which it is at rest, each axis [rad/s]."""
    rest_time: Annotated[float, Gt(0.0), TIME] = 0.2
    """Time for which it must be [s]."""
    displacement_sigma: Annotated[float, Ge(0.0), LENGTH] = 0.2
    """How far a fall and getting up move the robot unseen, standard deviation per axis [m]."""
    yaw_sigma: Annotated[float, Ge(0.0), NUMBER] = 0.02
    """How much of the turn meanwhile the IMU misses, standard deviation [rad]."""


@dataclass(frozen=True)
class WalkingParameters:
    """All parameters of the walking engine."""

    gait: GaitParameters = field(default_factory=GaitParameters)
    """Footsteps."""
    pattern: PatternParameters = field(default_factory=PatternParameters)
    """ZMP pattern."""
    estimator: EstimatorParameters = field(default_factory=EstimatorParameters)
    """State estimation."""
    odometry: OdometryParameters = field(default_factory=OdometryParameters)
    """Dead reckoning."""
    stabilizer: StabilizerParameters = field(default_factory=StabilizerParameters)
    """Balance."""
    limits: LimitParameters = field(default_factory=LimitParameters)
    """Speed, step and reach limits."""
    head: HeadParameters = field(default_factory=HeadParameters)
    """Head."""
    arms: ArmParameters = field(default_factory=ArmParameters)
    """Arms."""
    get_up: GetUpParameters = field(default_factory=GetUpParameters)
    """Getting up."""
