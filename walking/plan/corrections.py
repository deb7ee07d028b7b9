"""Slow corrections of the walk, once per gait cycle, and detection of a touchdown.

A gait cycle is two footsteps, one with each foot. A sideways walk or a turn opens the stance with
one foot and closes it with the other one; only the mean over both is the commanded velocity.
"""

from math import exp

from compilation import compiled
from walking.data import Corrections, Planar, Pose
from walking.model import Model
from walking.parameters import CONTROL_PERIOD
from walking.plane import Point, Vector, clamp, rotate_back, within

NO_FOOT = -1
DISCARDED = -1  # number of errors or ticks of a discarded cycle


@compiled
def restart_cycle(corrections: Corrections) -> None:
    """Restart the gait cycle with the next support foot."""
    corrections.first = corrections.support = NO_FOOT


@compiled
def cycle_begins(corrections: Corrections, support: int) -> bool:
    """Whether a cycle begins in this tick with support foot `support`."""
    if corrections.first == NO_FOOT:
        corrections.first = support
    begins: bool = support == corrections.first and support != corrections.support
    corrections.support = support
    return begins


@compiled
def landed_shift(corrections: Corrections, shift: Planar, support: int) -> Point:
    """Return the shift of a foot that landed in this tick [m], zero in other ticks.

    Args:
        corrections: of the last tick.
        shift: shift of the last landing by balance [m].
        support: present support foot.
    """
    if corrections.support in (NO_FOOT, support):
        return 0.0, 0.0
    return shift.x, shift.y


@compiled
def speed_ratio(corrections: Corrections, error: float, robot: Model) -> float:
    """Return the speed ratio [1]: slowdown by the decaying maximum of the DCM error [m]."""
    p = robot.stabilizer
    decay = exp(-CONTROL_PERIOD / p.slowdown_time)
    corrections.max_error = max(error, decay * corrections.max_error)
    if corrections.max_error <= p.slowdown_start_error:
        return 1.0
    error_range = p.slowdown_full_error - p.slowdown_start_error
    excess = (corrections.max_error - p.slowdown_start_error) / error_range
    return 1.0 - (1.0 - p.min_speed_ratio) * within(excess, 0.0, 1.0)


@compiled
def heading_rate(corrections: Corrections, ahead: float, renew: bool, robot: Model) -> float:
    """Return the yaw rate against yaw slip of the feet [rad/s].

    Proportional feedback of the heading error, constant over a gait cycle: one footstep of a cycle
    makes the turn of both.

    Args:
        corrections: changed.
        ahead: planned minus measured heading [rad].
        renew: whether to update the rate: at the begin of a gait cycle, after a landing that
            balance shifted, and in every tick of a shortened footstep.
        robot: constants.
    """
    if renew:
        p = robot.stabilizer
        corrections.turn = clamp(p.heading_gain * (ahead - corrections.held), p.max_heading_rate)
    corrections.held += corrections.turn * CONTROL_PERIOD
    return corrections.turn


@compiled
def end_corrections(corrections: Corrections) -> None:
    """Discard the correction of the speed and the present cycle of the CoM offset."""
    corrections.errors = corrections.ticks = DISCARDED
    corrections.posed = False
    corrections.speed.x = corrections.speed.y = 0.0


@compiled
def speed_correction(
    corrections: Corrections,
    pose: Vector,
    planned: Vector,
    shift: Point,
    begins: bool,
    robot: Model,
) -> Point:
    """Return the correction of (vx, vy) [m/s, m/s] against slip and short landings of the feet.

    Mean of the planned minus the measured velocity, updated once per gait cycle. Planned footsteps
    follow any change of the command, so it does not show as slip. The plan follows the landings,
    too: their shifts by balance do not count as planned, so those of every cycle, of a robot with
    compliant joints, do not change the mean velocity. A push changes the correction little, since
    its change per cycle is limited. Displacements are summed in the
    present heading: a robot turns in one of two footsteps, so its heading at the begin of a cycle
    differs from the mean.

    Args:
        corrections: changed.
        pose: pose by odometry, heading unwrapped [m, m, rad].
        planned: centre of mass and heading in the plan frame [m, m, rad]; a robot that turns on the
            spot turns about it.
        shift: shift of a foot that landed in this tick by balance [m].
        begins: whether a gait cycle begins.
        robot: constants.
    """
    c = corrections
    if c.posed and c.ticks >= 0:
        planned_x, planned_y = _displacement(c.planned, planned)
        x, y = _displacement(c.pose, pose)
        shift_x, shift_y = rotate_back(planned[2], *shift)
        c.slip.x += planned_x - shift_x - x
        c.slip.y += planned_y - shift_y - y
        c.ticks += 1
    c.posed = True
    c.pose.x, c.pose.y, c.pose.yaw = pose
    c.planned.x, c.planned.y, c.planned.yaw = planned
    if begins:
        if c.ticks > 0:
            p, time = robot.stabilizer, c.ticks * CONTROL_PERIOD
            limit, change = p.max_speed_correction, p.max_speed_change
            x = c.speed.x + clamp(p.speed_gain * (c.slip.x / time - c.speed.x), change)
            y = c.speed.y + clamp(p.speed_gain * (c.slip.y / time - c.speed.y), change)
            c.speed.x, c.speed.y = clamp(x, limit), clamp(y, limit)
        c.ticks = 0
        c.slip.x = c.slip.y = 0.0
    return c.speed.x, c.speed.y


@compiled
def _displacement(before: Pose, pose: Vector) -> Point:
    """Return the displacement of a tick in the mean heading [m]."""
    x, y, yaw = pose
    return rotate_back(0.5 * (before.yaw + yaw), x - before.x, y - before.y)


@compiled
def correct_offset(
    corrections: Corrections,
    error: Point,
    pressed: bool,
    begins: bool,
    disturbed: bool,
    robot: Model,
) -> None:
    """Correct the CoM offset from the measured centre of pressure, once per gait cycle.

    Averaged over a gait cycle, the centre of pressure is below the true centre of mass. Within a
    cycle the ankles and the landing feet move it, hence one update per cycle.

    Args:
        corrections: changed.
        error: centre of pressure minus planned ZMP, forward and left [m].
        pressed: whether a foot carries load; ticks in the air do not count.
        begins: whether a gait cycle begins.
        disturbed: whether balance shifted the foot that landed, or shortens the footstep.
        robot: constants.
    """
    c, p = corrections, robot.stabilizer
    if disturbed:
        c.errors = DISCARDED
    if begins:
        if c.errors > 0:
            x = c.goal.x - p.com_offset_gain * c.error_sum.x / c.errors
            y = c.goal.y - p.com_offset_gain * c.error_sum.y / c.errors
            c.goal.x, c.goal.y = clamp(x, p.max_com_offset), clamp(y, p.max_com_offset)
        c.error_sum.x = c.error_sum.y = 0.0
        c.errors = 0
    if c.errors >= 0 and pressed:
        x, y = error
        c.error_sum.x, c.error_sum.y = c.error_sum.x + x, c.error_sum.y + y
        c.errors += 1
    step = p.max_com_offset_rate * CONTROL_PERIOD
    c.com_offset.x += clamp(c.goal.x - c.com_offset.x, step)
    c.com_offset.y += clamp(c.goal.y - c.com_offset.y, step)


@compiled
def detects_touchdown(corrections: Corrections, phase: float, force: float, robot: Model) -> bool:
    """Whether the swing foot is down, given the phase of its swing [1] and its load [N]."""
    p = robot.estimator
    contact = phase >= p.contact_phase and force > p.contact_force
    corrections.contact = corrections.contact + 1 if contact else 0
    return corrections.contact >= p.contact_ticks
