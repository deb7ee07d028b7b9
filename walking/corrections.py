"""Slow corrections of the walk, once per gait cycle, and detection of a touchdown.

A gait cycle is two footsteps, one with each foot. A sideways walk or a turn opens the stance with
one foot and closes it with the other one; only the mean over both is the commanded velocity.
"""

from math import cos, exp, sin

from compilation import compiled
from compilation.record import record_type
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, Vector, clamp
from walking.records import Record

CORRECTIONS = record_type(
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

NO_FOOT = -1


@compiled
def restart_cycle(corrections: Record) -> None:
    """Restart the gait cycle with the next support foot."""
    corrections.first = corrections.support = NO_FOOT


@compiled
def cycle_begins(corrections: Record, support: int) -> bool:
    """Whether a cycle begins in this tick with support foot `support`."""
    if corrections.first == NO_FOOT:
        corrections.first = support
    begins: bool = support == corrections.first and support != corrections.support
    corrections.support = support
    return begins


@compiled
def speed_ratio(corrections: Record, error: float, robot: Record) -> float:
    """Return the speed ratio [1]: slowdown by the decaying maximum of the DCM error [m]."""
    p = robot.stabilizer
    decay = exp(-CONTROL_PERIOD / p.slowdown_time)
    corrections.max_error = max(error, decay * corrections.max_error)
    if corrections.max_error <= p.slowdown_start_error:
        return 1.0
    error_range = p.slowdown_full_error - p.slowdown_start_error
    excess = (corrections.max_error - p.slowdown_start_error) / error_range
    ratio: float = 1.0 - (1.0 - p.min_speed_ratio) * min(1.0, max(0.0, excess))
    return ratio


@compiled
def heading_rate(corrections: Record, ahead: float, renew: bool, robot: Record) -> float:
    """Return the yaw rate against yaw slip of the feet [rad/s].

    Proportional feedback of the heading error, constant over a gait cycle: one footstep of a cycle
    makes the turn of both.

    Args:
        corrections: changed.
        ahead: planned minus measured heading [rad].
        renew: whether to update the rate: at the begin of a gait cycle, and in every tick while
            balance changes the footsteps.
        robot: constants.
    """
    if renew:
        p = robot.stabilizer
        corrections.turn = clamp(p.heading_gain * (ahead - corrections.held), p.max_heading_rate)
    corrections.held += corrections.turn * CONTROL_PERIOD
    rate: float = corrections.turn
    return rate


@compiled
def reset_speed(corrections: Record) -> None:
    """Discard the correction of the speed."""
    corrections.steady = corrections.posed = corrections.whole = False
    corrections.speed[0] = corrections.speed[1] = 0.0


@compiled
def speed_correction(
    corrections: Record,
    pose: Vector,
    velocity: Vector,
    begins: bool,
    disturbed: bool,
    robot: Record,
) -> Point:
    """Return the correction of (vx, vy) [m/s, m/s] against slip and short landings of the feet.

    Integral correction under a steady command, once per gait cycle; zero until the command is
    steady. Displacements are summed in the present heading: a robot turns in one of two footsteps,
    so its heading at the begin of a cycle differs from the mean.

    Args:
        corrections: changed.
        pose: pose by odometry, heading unwrapped [m, m, rad].
        velocity: wanted (vx, vy, wz) [m/s, m/s, rad/s].
        begins: whether a gait cycle begins.
        disturbed: whether balance changes the footsteps.
        robot: constants.
    """
    c = corrections
    if not c.steady or velocity != (c.command[0], c.command[1], c.command[2]):
        reset_speed(c)
        c.steady = True
        for k in range(3):
            c.command[k] = velocity[k]
    if c.posed:
        _add_displacement(c, pose)
    c.posed = True
    for k in range(3):
        c.pose[k] = pose[k]
    c.whole = c.whole and not disturbed
    if begins:
        if c.whole:
            p, time = robot.stabilizer, c.ticks * CONTROL_PERIOD
            for k in range(2):
                missing = c.displacement[k] / time - velocity[k]
                c.speed[k] = clamp(c.speed[k] - p.speed_gain * missing, p.max_speed_correction)
        c.whole, c.ticks = True, 0
        c.displacement[0] = c.displacement[1] = 0.0
    return c.speed[0], c.speed[1]


@compiled
def _add_displacement(corrections: Record, pose: Vector) -> None:
    """Add the displacement of a tick in the mean heading."""
    before, displacement = corrections.pose, corrections.displacement
    dx, dy = pose[0] - before[0], pose[1] - before[1]
    middle = 0.5 * (before[2] + pose[2])
    c, s = cos(middle), sin(middle)
    displacement[0] = displacement[0] + c * dx + s * dy
    displacement[1] = displacement[1] + c * dy - s * dx
    corrections.ticks += 1


@compiled
def discard_offset_cycle(corrections: Record) -> None:
    """Discard the present cycle of the CoM offset; keep the offset."""
    corrections.errors = -1


@compiled
def correct_offset(
    corrections: Record, error: Point, begins: bool, disturbed: bool, robot: Record
) -> None:
    """Correct the CoM offset from the measured centre of pressure, once per gait cycle.

    Averaged over a gait cycle, the centre of pressure is below the true centre of mass. Within a
    cycle the ankles and the landing feet move it, hence one update per cycle.

    Args:
        corrections: changed.
        error: centre of pressure minus planned ZMP, forward and left [m].
        begins: whether a gait cycle begins.
        disturbed: whether balance changes the footsteps.
        robot: constants.
    """
    c, p = corrections, robot.stabilizer
    if begins:
        if c.errors > 0:
            for k in range(2):
                change = p.com_offset_gain * c.error_sum[k] / c.errors
                c.goal[k] = clamp(c.goal[k] - change, p.max_com_offset)
        c.error_sum[0] = c.error_sum[1] = 0.0
        c.errors = 0
    if disturbed:
        discard_offset_cycle(c)
    elif c.errors >= 0:
        c.error_sum[0] += error[0]
        c.error_sum[1] += error[1]
        c.errors += 1
    step = p.max_com_offset_rate * CONTROL_PERIOD
    for k in range(2):
        c.com_offset[k] += clamp(c.goal[k] - c.com_offset[k], step)


@compiled
def detects_touchdown(corrections: Record, phase: float, force: float, robot: Record) -> bool:
    """Whether the swing foot is down, given the phase of its swing [1] and its load [N]."""
    p = robot.estimator
    contact = phase >= p.contact_phase and force > p.contact_force
    corrections.contact = corrections.contact + 1 if contact else 0
    down: bool = corrections.contact >= p.contact_ticks
    return down
