"""Balance: ankle strategy, and foot placement by plan or by capture step.

The DCM error grows by e^{ωt} until touchdown; a landing shifted by as much is at the capture point
(Pratt et al., Humanoids 2006). The ankles shift the ZMP within the sole; a capture step is made for
the error beyond their dead zone.
"""

from math import exp, log
from typing import NamedTuple

from compilation import compiled
from walking.command import BALANCE, LANDING_FROZEN, LANDING_SPEED, ZMP_REGION
from walking.data import Body, Data
from walking.model import LEFT, RIGHT, Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.departure import return_to_plan
from walking.plan.footsteps import (
    Foothold,
    equal,
    equal_strides,
    foothold,
    is_close,
    landing_of,
    put,
    reachable,
)
from walking.plan.gait import aimed, is_adjustable, is_double, phase_of, shorten, support_foot
from walking.plan.generator import admit, keeps_plan, planned_dcm, planned_zmp
from walking.plan.pendulum import dcm_of
from walking.plan.reference import plan_walk
from walking.plan.steering import moves
from walking.plan.support import Region, clip, support_region
from walking.plan.timing import equal_clocks
from walking.plane import Point, clamp, dead_zone, norm, rotate, rotate_back, within

ROUNDING = 1e-6  # rounding error of a time in control ticks [1]


def ankle_gain(omega: float, lag: float, rate: float) -> float:
    """Return the gain from DCM error to ZMP for an error that decays with e^{-rate t} [1].

    The error follows ξ' = ω (ξ - p), the ZMP follows the ankle setpoints u with the servo lag,
    p' = (u - p) / T (Morisawa et al., Humanoids 2014). The poles of u = k ξ sum to ω - 1/T for any
    gain; one is placed at `-rate`. Without lag the gain is the usual 1 + rate / ω.

    Args:
        omega: ω of the pendulum [1/s].
        lag: T of the servos [s].
        rate: wanted rate [1/s]; with a servo too slow for it, both poles are placed at their mean.
    """
    if lag > 0.0:
        rate = min(rate, max(0.0, 0.5 * (1.0 / lag - omega)))
    return (1.0 + rate / omega) * (1.0 - lag * rate)


@compiled
def is_fallen(body: Body, robot: Model) -> bool:
    """Whether the tilt of the trunk is that of a fallen robot."""
    return norm(body.roll, body.pitch) > robot.estimator.fall_tilt


# Ankles


@compiled
def zmp_shift(zmp: Point, error: Point, region: Region, robot: Model) -> Point:
    """Return the shift of the ZMP by the ankles against a DCM error [m]."""
    gain = robot.ankle_gain
    (zmp_x, zmp_y), (off_x, off_y) = zmp, error
    x, y = clip(region, zmp_x + gain * off_x, zmp_y + gain * off_y)
    return x - zmp_x, y - zmp_y


@compiled
def sole_margins(robot: Model) -> Point:
    """Return the distances from the middle of a sole to its edges, less the margin [m]."""
    support, margin = robot.support, robot.stabilizer.sole_margin
    return support.half_length - margin, support.half_width - margin


@compiled
def excess_error(walk: Data, robot: Model) -> float:
    """Return the DCM error beyond the dead zone of the capture step, negative within [1].

    The unit is the range of the ankles on the support foot.
    """
    p, error = robot.stabilizer, walk.error
    length, width = sole_margins(robot)
    x, y = rotate_back(support_foot(walk.plan.gait).yaw, error.dcm_x, error.dcm_y)
    return max(abs(x) / length, abs(y) / width) - p.capture_dead_zone


@compiled
def follow_body(walk: Data, robot: Model) -> None:
    """Move the plan towards the body: admittance of the centre of mass.

    A push that the ankles cannot hold turns body and stance leg about the edge of the sole. Servos
    that keep the planned posture tilt the trunk by the same angle, and the next foot lands tilted.
    The plan that takes over the error inclines the leg instead, under an upright trunk. The DCM,
    planned plus error, does not change, nor does a capture step. The modifiable generator does not
    follow: its plan begins at the pendulum, so it would move with the body and forget the push.

    Args:
        walk: state; pendulum and error are changed.
        robot: constants.
    """
    pendulum, error = walk.pendulum, walk.error
    part = robot.stabilizer.com_admittance * within(excess_error(walk, robot), 0.0, 1.0)
    pendulum.x += part * error.x
    pendulum.y += part * error.y
    pendulum.vx += part * error.vx
    pendulum.vy += part * error.vy
    rest = 1.0 - part
    error.x, error.y = rest * error.x, rest * error.y
    error.vx, error.vy = rest * error.vx, rest * error.vy
    error.dcm_x, error.dcm_y = rest * error.dcm_x, rest * error.dcm_y


@compiled
def exceeds_support(walk: Data, ratio: float, robot: Model) -> bool:
    """Whether the ZMP that answers the DCM error of a standing robot is outside the support.

    Args:
        walk: state.
        ratio: DCM error per shift of the ZMP [1].
        robot: constants.
    """
    gait, pendulum, error = walk.plan.gait, walk.pendulum, walk.error
    left, right = foothold(gait.footholds[LEFT]), foothold(gait.footholds[RIGHT])
    region = support_region(robot.support, left, right, robot.stabilizer.sole_margin)
    x, y = pendulum.zmp_x + error.dcm_x / ratio, pendulum.zmp_y + error.dcm_y / ratio
    return clip(region, x, y) != (x, y)


@compiled
def ankle_room(foot: Foothold, zmp: Point, error: Point, robot: Model) -> Point:
    """Return the range of the ankles to shift the ZMP of a foot against an error [m].

    Args:
        foot: support foot.
        zmp: planned ZMP [m].
        error: DCM error, along and across the foot [m].
        robot: constants.

    Returns:
        range from the planned ZMP to the edge of the sole, less its margin, along and across.
    """
    support, margin, (zmp_x, zmp_y), (x, y) = (
        robot.support,
        robot.stabilizer.sole_margin,
        zmp,
        error,
    )
    u, v = rotate_back(foot.yaw, zmp_x - foot.x, zmp_y - foot.y)
    u -= support.centre
    return (
        max(0.0, support.half_length - margin - (u if x > 0.0 else -u)),
        max(0.0, support.half_width - margin - (v if y > 0.0 else -v)),
    )


# Capture step


class Capture(NamedTuple):
    """Capture step.

    Attributes:
        needed: whether the ankles do not suffice.
        landing: foothold of the swing foot.
        ticks: control ticks until touchdown [1].
    """

    needed: bool
    landing: Foothold
    ticks: int


@compiled
def capture_time(omega: float, time: float, off: float, ahead: float, reach: float) -> float:
    """Return the latest touchdown at which a landing within reach captures the body.

    A DCM `ahead` of the ZMP by plan, with error `off`, is `(ahead + off) e^{ωt}` from the ZMP
    after a time t, and planned at `ahead e^{ω time}`: linear in e^{ωt}, so the time at which the
    difference is `reach` has a closed form (Khadiv et al., IEEE Trans. Robot. 36(6), 2020).

    Args:
        omega: ω of the pendulum [1/s].
        time: planned touchdown, from now [s].
        off: DCM error [m].
        ahead: planned DCM minus ZMP [m].
        reach: shift of the landing, of the sign of `off` if it helps [m].

    Returns:
        the time, at most `time`; zero if no touchdown is early enough [s].
    """
    growth = exp(omega * time)
    if growth * abs(off) <= (reach if off > 0.0 else -reach) or off == 0.0:
        return time
    due, distance = reach + growth * ahead, off + ahead
    if due * distance <= 0.0:
        return 0.0
    return min(time, max(0.0, log(due / distance) / omega))


@compiled
def capture_step(
    support: Foothold,
    landing: Foothold,
    error: Point,
    zmp: Point,
    dcm: Point,
    ticks_left: int,
    robot: Model,
) -> Capture:
    """Return the capture step for the DCM error beyond the dead zone of the ankles.

    If the capture point is out of reach, touchdown must be earlier, see `capture_time`.

    Args:
        support: support foot.
        landing: nominal landing.
        error: error of the measured DCM [m].
        zmp: planned ZMP [m].
        dcm: planned DCM [m].
        ticks_left: control ticks until the end of single support [1].
        robot: constants.
    """
    p, omega, yaw, (error_x, error_y) = robot.stabilizer, robot.omega, support.yaw, error
    off_x, off_y = rotate_back(yaw, error_x, error_y)
    length, width = ankle_room(support, zmp, (off_x, off_y), robot)
    forward, lateral = sole_margins(robot)
    zone_x, zone_y = p.capture_dead_zone * forward, p.capture_dead_zone * lateral
    x, y = dead_zone(off_x, zone_x), dead_zone(off_y, zone_y)
    if x == 0.0 and y == 0.0:
        return Capture(False, landing, ticks_left)
    planned = ticks_left * CONTROL_PERIOD
    growth = exp(omega * planned)
    dx, dy = rotate(yaw, clamp(growth * x, p.capture_forward), clamp(growth * y, p.capture_side))
    reached = reachable(support, landing, dx, dy, robot)
    (zmp_x, zmp_y), (dcm_x, dcm_y) = zmp, dcm
    ahead_x, ahead_y = rotate_back(yaw, dcm_x - zmp_x, dcm_y - zmp_y)
    reach_x, reach_y = rotate_back(yaw, reached.x - landing.x, reached.y - landing.y)
    missing_x = dead_zone(off_x, max(length, zone_x))
    missing_y = dead_zone(off_y, max(width, zone_y))
    time = min(planned, capture_time(omega, planned, missing_x, ahead_x, reach_x))
    time = min(time, capture_time(omega, planned, missing_y, ahead_y, reach_y))
    return Capture(True, reached, int(time / CONTROL_PERIOD + ROUNDING))


@compiled
def _needed_capture(walk: Data, landing: Foothold, robot: Model) -> Capture:
    """Return the capture step for the measured DCM."""
    gait, error, dcm = walk.plan.gait, walk.error, planned_dcm(walk, robot)
    (x, y), (body_x, body_y) = dcm, dcm_of(walk.pendulum, robot)
    off = (body_x + error.dcm_x - x, body_y + error.dcm_y - y)
    support, ticks_left = support_foot(gait), phase_of(gait).ticks_left
    return capture_step(support, landing, off, planned_zmp(walk, robot), dcm, ticks_left, robot)


# Foot placement


@compiled
def place_foot(walk: Data, region: Region, robot: Model) -> int:
    """Choose landing and timing of the swing foot in this tick: the plan in force.

    Args:
        walk: state, changed.
        region: admissible ZMP in this tick.
        robot: constants.

    Returns:
        limits that bind.
    """
    placing, gait, wanted = walk.placing, walk.plan.gait, walk.steering.wanted
    adjustable = is_adjustable(gait, robot)
    placing.moved_x = placing.moved_y = 0.0
    landing = admit(walk, region, robot)
    bound = _apply_velocity(walk, robot)
    if adjustable:
        return bound | _capture(walk, landing, bound != 0, robot)
    if gait.stepping:
        nominal = landing_of(support_foot(gait), wanted)
        if not is_close(nominal, foothold(gait.landing), robot):
            bound |= LANDING_FROZEN
    return bound


@compiled
def _apply_velocity(walk: Data, robot: Model) -> int:
    """Set the velocity that the footsteps follow: as far as the wanted plan is admitted."""
    applied, wanted, fraction = (
        walk.placing.applied,
        walk.steering.velocity,
        walk.admission.fraction,
    )
    if fraction == 1.0:
        walk.placing.applied = wanted
        return 0
    applied.vx += fraction * (wanted.vx - applied.vx)
    applied.vy += fraction * (wanted.vy - applied.vy)
    applied.wz += fraction * (wanted.wz - applied.wz)
    return ZMP_REGION if _differs(walk, robot) else 0


@compiled
def _differs(walk: Data, robot: Model) -> bool:
    """Whether the admitted plan differs from the wanted one."""
    live, wanted = walk.plan, walk.admission.wanted
    retimed = not equal_clocks(live.gait.clock, wanted.gait.clock)
    if retimed or live.moving != wanted.moving:
        return True
    if not equal_strides(live.following, wanted.following):
        return True
    nominal = landing_of(support_foot(live.gait), walk.steering.wanted)
    adjustable = is_adjustable(live.gait, robot)
    return adjustable and not is_close(nominal, foothold(live.steps[0]), robot)


@compiled
def _capture(walk: Data, landing: Foothold, limited: bool, robot: Model) -> int:
    """Aim at the landing of a capture step if one is needed; return the limits that bind.

    Args:
        walk: state, changed.
        landing: landing of the plan.
        limited: whether the generator limits this plan.
        robot: constants.
    """
    placing, plan, steering, goal = walk.placing, walk.plan, walk.steering, landing
    gait = plan.gait
    capture = _needed_capture(walk, landing, robot)
    if capture.needed and shorten(gait, walk.limbs.feet, capture.ticks, capture.landing, robot):
        # The timing has changed: plan again.
        return_to_plan(walk)
        plan_walk(plan, landing, steering.wanted, moves(steering), robot)
        capture = _needed_capture(walk, landing, robot)
    if capture.needed and not is_double(gait):
        goal = capture.landing
        placing.moved_x, placing.moved_y = goal.x - landing.x, goal.y - landing.y
    put(gait.landing, aimed(gait, foothold(gait.landing), goal, robot))
    now, nominal = foothold(gait.landing), landing_of(support_foot(gait), steering.wanted)
    placing.shift.x, placing.shift.y = now.x - landing.x, now.y - landing.y
    if not keeps_plan(gait, robot) and not equal(now, landing):
        plan_walk(plan, now, steering.wanted, moves(steering), robot)
    if gait.shortened or not is_close(goal, landing, robot):
        return BALANCE
    if not limited and not is_close(nominal, now, robot):
        return LANDING_SPEED
    return 0
