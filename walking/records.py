"""Records: the state of the walk, its plan, and the constants of robot and walk.

A record is a structure of numbers of fixed size, as in a header of C. Compiled functions read and
change records in place; an assignment of a record copies it. A function that gets a record from
another one shares it.

    walk   state of the walk, see `WALK`.
    robot  constants of the robot and of its walk, see `ROBOT`; among them all parameters of
           `walking.parameters.WalkingParameters`, section by section under the same names.

Fields of variable length are arrays next to the record, so the compiled code is the same for every
robot. A field must not have the name of an attribute of arrays (``base``, ``size``, ``data`` ...),
which would hide it.
"""

from dataclasses import fields
from math import prod
from typing import Any

import numpy as np

from walking.parameters import WalkingParameters

Record = Any
"""Record, or array of records; type checkers do not know the fields."""

FieldType = type | np.dtype[Any] | tuple[Any, ...]

_NUMBERS: dict[type, str] = {float: "f8", int: "i8", bool: "?"}
WORD = 8  # bytes; every field begins at a multiple, which compiled code requires
GENERATORS = ("dcm", "preview", "paper", "robust")
"""Pattern generators; a record holds the index."""
DCM, PREVIEW, PAPER, ROBUST = range(len(GENERATORS))


def record(**types: FieldType) -> np.dtype[Any]:
    """Return the type of a record.

    Args:
        types: type of each field: a number, another record, or (one of these, *shape).
    """
    formats: list[Any] = []
    offsets, offset = [], 0
    for name, kind in types.items():
        if hasattr(np.recarray, name):
            raise TypeError(f"{name}: name of a field; expected no attribute of arrays")
        one, *shape = kind if isinstance(kind, tuple) else (kind,)
        number = np.dtype(_NUMBERS[one] if isinstance(one, type) else one)
        formats.append((number, tuple(shape)) if shape else number)
        offsets.append(offset)
        words = -(-number.itemsize * prod(shape) // WORD)
        offset += WORD * words
    layout: Any = {
        "names": list(types),
        "formats": formats,
        "offsets": offsets,
        "itemsize": offset,
    }
    return np.dtype((np.record, np.dtype(layout, align=True)))


def _section(cls: type) -> np.dtype[Any]:
    """Return the record of a section of the parameters; a choice is an index."""
    kinds = {field.name: field.default for field in fields(cls)}
    return record(
        **{
            name: int if isinstance(value, int | str) else float
            for name, value in kinds.items()
            if not isinstance(value, bool)
        }
    )


def _sections() -> dict[str, np.dtype[Any]]:
    parameters = WalkingParameters()
    names = [field.name for field in fields(parameters)]
    return {name: _section(type(getattr(parameters, name))) for name in names}


# Robot

SOLE = record(centre=float, half_length=float, half_width=float)
"""Rectangle of a sole in the foot frame [m]."""

NECK = record(
    movable=bool,
    tilt_first=bool,
    pan_joint=int,
    tilt_joint=int,
    pan_sign=float,
    tilt_sign=float,
    rest_pan=float,
    rest_tilt=float,
    lower=(float, 2),
    upper=(float, 2),
)
"""Joints of the head (-1 for none), their signs [1], pan and tilt with these joints at zero, and
limits of pan and tilt [rad]."""

JOINT = record(
    lower=float,
    upper=float,
    load_gain=float,
    lag=float,
    compliance=float,
    ready=float,
    in_q=int,
    in_v=int,
    angle=float,
    rate=float,
    rate_ahead=float,
    offset=float,
)
"""Joint: limits [rad], feed-forward per load [rad/(N m)], velocity lag [s], compliance [rad/(N m)],
angle of the ready posture [rad], indices in position and velocity of the dynamic model; planned
angle [rad] and rate [rad/s], rate for the feed-forward [rad/s], feed-forward offset [rad]."""

PREVIEW_SUM = record(gain=float, moment=float)
"""Running sums Σ f_j and Σ j f_j of the gains of preview control [1]."""

# Footsteps

FOOTHOLD = record(left=bool, x=float, y=float, yaw=float)
"""`walking.foothold.Foothold`."""

PLACEMENT = record(x=float, y=float, yaw=float)
"""Landing in the frame of the support foot, x, y [m], yaw [rad]."""

STRIDES = record(right=PLACEMENT, left=PLACEMENT)
"""Landing of either foot in the frame of the other."""

SECTIONS = _sections()

ROBOT = record(
    # Parameters: gait, pattern, estimator, ...
    **SECTIONS,
    # Pendulum: ω [1/s], cosh and sinh of ω times the control period [1].
    omega=float,
    cosh=float,
    sinh=float,
    # Weight [N], load of an unloaded foot [N], length of a leg [m].
    weight=float,
    light_load=float,
    leg_length=float,
    # Soles: all of it, and the part that the ankles can press on the floor.
    sole=SOLE,
    support=SOLE,
    # Nominal centre of mass ahead of the base, and height of the base above the floor [m].
    com_ahead=float,
    height=float,
    # Chains of the legs, see `walking.body.kinematics`; hip in the base frame (3) [m], ankle in the
    # foot frame (3) [m] and maximum distance of both [m].
    chains=(float, 2, 7, 15),
    reach=(float, 2, 7),
    # First joint of the ankle in a leg; factor on the stiffness of the legs [1].
    ankle=int,
    stiffening=float,
    # Index and sign of the shoulder joints, -1 and 0 for none.
    shoulders=(int, 2),
    shoulder_signs=(float, 2),
    neck=NECK,
    # Strides of stepping in place.
    still=STRIDES,
    # Reaction of a swing leg, see `walking.swing_reaction`.
    thrust=float,
    knee=float,
    lifted_weight=float,
    # Gains: of the CoM filter (position [1], velocity [1/s]), of the ankles per DCM error [1].
    position_gain=float,
    velocity_gain=float,
    ankle_gain=float,
    # Gains of preview control, see `walking.patterns`.
    preview_position=float,
    preview_velocity=float,
    preview_zmp=float,
    preview_total=float,
)
"""Constants of the robot and of its walk."""


def parameters_record(parameters: WalkingParameters) -> Record:
    """Return constants of which only the parameters are set (1,)."""
    robots = np.zeros(1, ROBOT)
    for name, section in SECTIONS.items():
        for key in section.names or ():
            value = getattr(getattr(parameters, name), key)
            robots[name][key] = GENERATORS.index(value) if isinstance(value, str) else value
    return robots


TIMING = record(double=int, single=int, swing_height=float)
"""Control ticks in double and single support [1], height of the swing foot at mid-swing [m]."""

SHIFT = record(begin=int, end=int, zmp_x=float, zmp_y=float, right_weight=float)
"""Shift of ZMP and weight to the support foot: begin and end in ticks since the begin of the
footstep; ZMP [m] and load fraction of the right foot [1] at its begin."""

SINGLE = record(ticks=int, first=int, last=int, origin=float)
"""Single support: duration, begin and end of the swing in ticks since its begin, and phase of the
swing at `first`, which is the present if retimed in the air [1]."""

CLOCK = record(timing=TIMING, shift=SHIFT, single=SINGLE)
"""Timing of the next footsteps, weight shift and single support of this one."""

GAIT = record(
    stepping=bool,
    support=int,
    completed=int,
    landed_early=bool,
    shortened=bool,
    shift_fixed=bool,
    footholds=(FOOTHOLD, 2),
    landing=FOOTHOLD,
    clock=CLOCK,
    tick=int,
    swing_height=float,
    # Of clock and tick, see `walking.gait.update_phase`.
    elapsed=int,
    double=bool,
    right_weight=float,
    ticks_left=int,
    swing_phase=float,
    adjustable=bool,
)
"""Gait, see `walking.gait`: whether a footstep is under way; index of the support foot; completed
footsteps; whether the swing foot touched down early, this is a capture step shorter than its
timing, and the weight shift must keep its timing; present or last foothold of each foot; landing of
the swing foot; clock, and ticks since the begin of the footstep; height of this swing [m]; then
ticks since the begin of single support, whether double support is planned, planned load fraction of
the right foot [1], ticks until the end of single support, phase of the swing [1], whether the
landing may change."""

RAMP = record(
    ticks=int,
    ax=float,
    ay=float,
    bx=float,
    by=float,
    unloading=FOOTHOLD,
    loading=FOOTHOLD,
)
"""Linear segment of the ZMP reference: control ticks; ZMP at its start and its end [m]; unloading
and loading foot, in single support twice the support foot."""

KNOT = record(ticks=float, x=float, y=float)
"""Knot of the planned ZMP: ticks since the previous knot, position [m]."""

CELL = record(
    x=float,
    y=float,
    ax=float,
    ay=float,
    bx=float,
    by=float,
    nominal_u=float,
    nominal_v=float,
    low_u=float,
    high_u=float,
    low_v=float,
    high_v=float,
    weight=float,
    square=float,
    max_weight=float,
    begin=int,
    end=int,
)
"""Parallelogram of knots, see `walking.zmp_plan`: centre [m]; sides, columns of M [1]; nominal u
and v, and their bounds [m]; Σ w, Σ w² and max w of its knots [1]; first knot, and the one after the
last."""

SUPPORT = record(end=int, unloading=FOOTHOLD, loading=FOOTHOLD)
"""Support phase of a plan: its end in ticks from the begin of the plan, and its feet."""

COMPARED = 5
"""Supports of a plan that are compared with a later reference."""

ZMP_PLAN = record(
    # Knots in the soles: whether there is a plan, its age in ticks, λ of the program [1/m], number
    # of knots and index of the next one, first support phases.
    exists=bool,
    age=int,
    dual_x=float,
    dual_y=float,
    count=int,
    next=int,
    supports=(SUPPORT, COMPARED),
    phases=int,
    # ZMP functions: whether there is a target, DCM and convergent component at the end of single
    # support along and across the foot [m] (whether the latter is free); level [m] and time of the
    # switch before the end [s] of each function; part of the DCM that is out of reach [m].
    aimed=bool,
    xi=(float, 2),
    zeta=(float, 2),
    free=bool,
    level=(float, 2),
    switch=(float, 2),
    missed_x=float,
    missed_y=float,
)
"""Plan of a pattern generator that plans its ZMP, see `walking.zmp_plan` and
`walking.paper_pattern`."""

STEPS = 4  # planned footholds

PLAN = record(
    gait=GAIT,
    landing=FOOTHOLD,
    following=STRIDES,
    moving=bool,
    ramps=(RAMP, 2 * STEPS + 2),
    ramp_count=int,
    steps=(FOOTHOLD, STEPS),
    step_count=int,
    zmp=ZMP_PLAN,
)
"""Plan of the walk: gait with its timing; landing of the swing foot, strides after it, and whether
the walk goes on; ZMP reference and its number of ramps; footholds and their number; plan of the
ZMP."""

LIVE, WANTED, TRIAL, BEST = range(4)
"""Plans: the one in force, the wanted one, one that is tried, and the best that was admitted."""

# State of the walk

PENDULUM = record(x=float, y=float, vx=float, vy=float, zmp_x=float, zmp_y=float)
"""Pendulum in the plan frame: position [m], velocity [m/s], ZMP of the last tick [m]."""

REFERENCE = record(
    x=float, y=float, yaw=float, height=float, rate=(float, 3), acceleration=(float, 3)
)
"""Reference of a foot in the plan frame: position [m], yaw [rad], height above the floor [m]; rates
and accelerations of x, y and yaw."""

COMMAND = record(explicit=bool, values=(float, 6))
"""Velocity (vx, vy, wz), or the fields of a command state in order, see `walking.command`."""

STEERING = record(
    command=COMMAND,
    state=COMMAND,
    velocity=(float, 3),
    peak=(float, 3),
    timing=TIMING,
    wanted=STRIDES,
    scratch=STRIDES,
    applied=COMMAND,
    bound=int,
)
"""Steering: present command; command state in force, if `explicit`; wanted velocity (vx, vy, wz)
[m/s, m/s, rad/s], and its last peak per axis; wanted timing and strides; strides for intermediate
results; applied command; limits that bind, as bits."""

CORRECTIONS = record(
    # Gait cycle: first support foot and the last one, -1 for none.
    first=int,
    support=int,
    # Decaying maximum of the DCM error [m].
    max_error=float,
    # Heading: held offset [rad], yaw rate [rad/s].
    held=float,
    turn=float,
    # Speed: command, correction [m/s], last odometry pose, displacement [m] and ticks of the cycle.
    steady=bool,
    command=(float, 3),
    speed=(float, 2),
    posed=bool,
    pose=(float, 3),
    displacement=(float, 2),
    ticks=int,
    whole=bool,
    # CoM offset: goal, sum of the errors and their number (-1: cycle discarded), offset [m].
    goal=(float, 2),
    error_sum=(float, 2),
    errors=int,
    com_offset=(float, 2),
    # Ticks of contact of the swing foot.
    contact=int,
)
"""Slow corrections, see `walking.corrections`."""

ADMISSION = record(stepping=bool, completed=int, clock=CLOCK, fraction=float, between=TIMING)
"""Admission, see `walking.admission`: whether the gait was stepping, completed footsteps and clock
in the last tick; admitted fraction of the wanted change [1]; timing of a plan that is tried."""

PLACING = record(applied=(float, 3), bound=int, moved_x=float, moved_y=float, accepted=bool)
"""Foot placement: velocity that the footsteps follow; limits that bind, as bits; shift of the
landing by a capture step [m]; whether the ZMP plan of this tick was admitted."""

FOOT = record(x=float, y=float, z=float, yaw=float, load=float, pressure_x=float, pressure_y=float)
"""Measured foot: position [m] and yaw [rad] in the level frame of the heading, load [N], centre of
pressure in the foot frame [m]."""

SENSING = record(
    started=bool,
    roll=float,
    pitch=float,
    heading=float,
    turn_rate=float,
    feet=(FOOT, 2),
    com=(float, 3),
    right_load=float,
    # Error of the body against the plan.
    x=float,
    y=float,
    vx=float,
    vy=float,
    weighted=bool,
    right_weight=float,
    dcm_x=float,
    dcm_y=float,
    pressure_x=float,
    pressure_y=float,
)
"""Measured body: filtered roll and pitch, heading of the IMU [rad]; yaw rate [rad/s]; feet; centre
of mass [m]; load fraction of the right foot, 0.5 in the air [1]. Error of the CoM, x, y [m], vx, vy
[m/s]; planned load fraction of the right foot, once known; error of the DCM in the plan frame [m],
of the centre of pressure forward and left [m]."""

ODOMETRY = record(
    x=float,
    y=float,
    yaw=float,
    turned=bool,
    imu_yaw=float,
    placed=bool,
    left_x=float,
    left_y=float,
    right_x=float,
    right_y=float,
    right_stance=bool,
    sliding=bool,
    apart_x=float,
    apart_y=float,
    xx=float,
    xy=float,
    xw=float,
    yy=float,
    yw=float,
    ww=float,
    # Unmeasured variance per tick forward, lateral [m²] and of the yaw [rad²]; slip of the stance
    # foot per relative slip of the feet [1].
    forward_variance=float,
    lateral_variance=float,
    yaw_variance=float,
    slip_ratio=float,
)
"""Dead reckoning: pose, heading unwrapped; whether the yaw of the IMU is known, and its value;
whether the vectors from foot to body are known, and their values in the odometry frame; whether the
right foot is the stance foot; distance of the feet at the begin of a double support; covariance of
the error; constants."""

LIMBS = record(
    moved=bool,
    feet=(REFERENCE, 2),
    pelvis=(float, 3),
    turn_rate=float,
    com=(float, 2),
    # Compensation of the swing leg, see `walking.swing_reaction`.
    offset=(float, 2),
    ahead=(float, 2),
    offset_acceleration=(float, 2),
    # Tilt of the feet against that of the trunk, roll and pitch of each [rad].
    foot_roll=(float, 2),
    foot_pitch=(float, 2),
    leg_angles=(float, 12),
    axes=(float, 2, 6, 3),
    origins=(float, 2, 6, 3),
    leg_error=float,
    head=(float, 2),
    head_rate=(float, 2),
    load=float,
)
"""Whether there is a posture before this tick; references of the feet; pelvis x, y [m], heading
[rad] in the plan frame, and its yaw rate [rad/s]; centre of mass of the last posture in the base
frame [m]; angles of the legs, also beyond their limits [rad], axes and origins of their joints in
the base frame [m], and remaining error of the inverse kinematics [rad]; pan and tilt [rad] and
their rates [rad/s]; load fraction of the right foot in this tick [1]."""

WALK = record(
    ticks=int,
    sensing=SENSING,
    steering=STEERING,
    corrections=CORRECTIONS,
    admission=ADMISSION,
    placing=PLACING,
    pendulum=PENDULUM,
    planned=PENDULUM,
    off_plan=bool,
    zmp_shift_x=float,
    zmp_shift_y=float,
    zmp_depth=float,
    single=bool,
    unloading=FOOTHOLD,
    loading=FOOTHOLD,
    last_opening_left=bool,
    bound=int,
    limbs=LIMBS,
)
"""State of the walk: ticks; the parts above; pendulum of the body, and that of the plan if it
differs; shift of the ZMP by the ankles [m]; depth of the planned ZMP in the support polygon [m],
whether one foot supports, and the feet in contact; foot of the last opening step; limits that bind,
as bits."""
