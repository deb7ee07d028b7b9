"""Balance: ankle strategy, and foot placement by plan or by capture step.

The DCM error grows by e^{ωt} until touchdown; a landing shifted by as much is at the capture point
(Pratt et al., Humanoids 2006). The ankles shift the ZMP within the sole; a capture step is made for
the error beyond their dead zone.

A generator that plans its ZMP cannot plan for footholds that a push dictates. During a capture step
its plan continues as the reference of the DCM error, and the pendulum of the body tracks the DCM
that leads to the actual landing. At touchdown the two become one.
"""

from math import exp, log
from typing import NamedTuple

from compilation import compiled
from compilation.record import record_type
from walking.admission import admit
from walking.command import BALANCE, LANDING_FROZEN, LANDING_SPEED, ZMP_REGION
from walking.footsteps import (
    Foothold,
    equal,
    equal_strides,
    foothold,
    is_same,
    landing_of,
    put,
    reachable,
)
from walking.gait import aimed, shorten, support_foot
from walking.parameters import CONTROL_PERIOD
from walking.patterns import advance_pattern, planned_dcm, rejects_infeasible, reset_plan
from walking.pendulum import (
    dcm_of,
    dcm_reference,
    plan_pendulum,
    ramp_weights,
    track_dcm,
    track_reference,
)
from walking.plane import Point, clamp, dead_zone, rotate, rotate_back
from walking.records import Record
from walking.reference import LIVE, WANTED, plan_walk, reference_of
from walking.steering import moves
from walking.support import Region, clip
from walking.timing import equal_clocks

PLACING = record_type(applied=(float, 3), bound=int, moved_x=float, moved_y=float, accepted=bool)
"""Foot placement: velocity that the footsteps follow; limits that bind, as bits; shift of the
landing by a capture step [m]; whether the ZMP plan of this tick was admitted."""

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


# Ankles


@compiled
def zmp_shift(zmp: Point, error: Point, region: Region, robot: Record) -> Point:
    """Return the shift of the ZMP by the ankles against a DCM error [m]."""
    gain = robot.ankle_gain
    x, y = clip(region, zmp[0] + gain * error[0], zmp[1] + gain * error[1])
    return x - zmp[0], y - zmp[1]


@compiled
def follow_body(walk: Record, foot: Foothold, robot: Record) -> None:
    """Move the plan towards the body: admittance of the centre of mass.

    A push that the ankles cannot hold turns body and stance leg about the edge of the sole. Servos
    that keep the planned posture tilt the trunk by as much, and the next foot lands tilted. The
    plan that takes over the error inclines the leg instead, under an upright trunk. The DCM, planned
    plus error, does not change, nor does a capture step.

    Args:
        walk: state; the pendulum and the error of the body are changed.
        foot: support foot.
        robot: constants.
    """
    sensing, pendulum, p = walk.sensing, walk.pendulum, robot.stabilizer
    length, width = sole_margins(robot)
    x, y = rotate_back(foot.yaw, sensing.dcm_x, sensing.dcm_y)
    excess = max(abs(x) / length, abs(y) / width) - p.capture_dead_zone
    part = p.com_admittance * min(1.0, max(0.0, excess))
    pendulum.x += part * sensing.x
    pendulum.y += part * sensing.y
    pendulum.vx += part * sensing.vx
    pendulum.vy += part * sensing.vy
    rest = 1.0 - part
    sensing.x, sensing.y = rest * sensing.x, rest * sensing.y
    sensing.vx, sensing.vy = rest * sensing.vx, rest * sensing.vy
    sensing.dcm_x, sensing.dcm_y = rest * sensing.dcm_x, rest * sensing.dcm_y


@compiled
def sole_margins(robot: Record) -> Point:
    """Return the ZMP margins of a sole, forward and lateral [m]."""
    support, margin = robot.support, robot.stabilizer.sole_margin
    return support.half_length - margin, support.half_width - margin


@compiled
def exceeds(foot: Foothold, error: Point, ratio: float, robot: Record) -> bool:
    """Whether a DCM error [m] exceeds a ratio [1] of the ZMP margins of the sole."""
    length, width = sole_margins(robot)
    x, y = rotate_back(foot.yaw, error[0], error[1])
    return abs(x) > ratio * length or abs(y) > ratio * width


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
    support: Foothold, landing: Foothold, error: Point, ahead: Point, ticks_left: int, robot: Record
) -> Capture:
    """Return the capture step for the DCM error beyond the dead zone of the ankles.

    If the capture point is out of reach, touchdown must be earlier, see `capture_time`.

    Args:
        support: support foot.
        landing: nominal landing.
        error: error of the measured DCM [m].
        ahead: planned DCM minus ZMP of the support foot [m].
        ticks_left: control ticks until the end of single support [1].
        robot: constants.
    """
    p, omega, yaw = robot.stabilizer, robot.omega, support.yaw
    length, width = sole_margins(robot)
    off_x, off_y = rotate_back(yaw, error[0], error[1])
    x = dead_zone(off_x, p.capture_dead_zone * length)
    y = dead_zone(off_y, p.capture_dead_zone * width)
    planned = ticks_left * CONTROL_PERIOD
    growth = exp(omega * ticks_left * CONTROL_PERIOD)
    dx, dy = rotate(yaw, clamp(growth * x, p.capture_forward), clamp(growth * y, p.capture_side))
    reached = reachable(support, landing, dx, dy, robot)
    ahead_x, ahead_y = rotate_back(yaw, ahead[0], ahead[1])
    reach_x, reach_y = rotate_back(yaw, reached.x - landing.x, reached.y - landing.y)
    missing_x, missing_y = dead_zone(off_x, length), dead_zone(off_y, width)
    time = min(planned, capture_time(omega, planned, missing_x, ahead_x, reach_x))
    time = min(time, capture_time(omega, planned, missing_y, ahead_y, reach_y))
    return Capture(True, reached, int(time / CONTROL_PERIOD + ROUNDING))


@compiled
def _needed_capture(walk: Record, plan: Record, landing: Foothold, robot: Record) -> Capture:
    """Return the capture step for the measured DCM."""
    gait, ramps, sensing = plan.gait, reference_of(plan), walk.sensing
    support = support_foot(gait)
    if gait.shortened:
        x, y = dcm_reference(ramps, robot)
    else:
        x, y = planned_dcm(plan, plan_pendulum(walk), robot)
    body_x, body_y = dcm_of(walk.pendulum, robot)
    off = (body_x + sensing.dcm_x - x, body_y + sensing.dcm_y - y)
    if not exceeds(support, off, robot.stabilizer.capture_dead_zone, robot):
        return Capture(False, landing, 0)
    ahead = (x - ramps[0].bx, y - ramps[0].by)
    return capture_step(support, landing, off, ahead, gait.ticks_left, robot)


# Foot placement


@compiled
def place_foot(walk: Record, plans: Record, knots: Record, region: Region, robot: Record) -> None:
    """Choose landing and timing of the swing foot in this tick: the plan in force.

    Args:
        walk: state, changed.
        plans: plans (4,), see `LIVE`; changed.
        knots: knots of the plans (4, k), changed.
        region: admissible ZMP in this tick.
        robot: constants.
    """
    placing, gait, wanted = walk.placing, plans[LIVE].gait, walk.steering.wanted
    adjustable = gait.adjustable
    placing.bound, placing.accepted = 0, False
    placing.moved_x = placing.moved_y = 0.0
    landing = _reference(walk, plans, knots, region, robot)
    if adjustable:
        _capture(walk, plans[LIVE], landing, robot)
    elif gait.stepping:
        nominal = landing_of(support_foot(gait), wanted)
        if not is_same(nominal, foothold(gait.landing), robot):
            placing.bound |= LANDING_FROZEN


@compiled
def _selects(gait: Record, robot: Record) -> bool:
    """Whether the generator may limit the footsteps; not in a shortened footstep."""
    return rejects_infeasible(robot) and not gait.shortened


@compiled
def _reference(
    walk: Record, plans: Record, knots: Record, region: Region, robot: Record
) -> Foothold:
    """Put the reference that the generator admits in force; return the landing of the plan."""
    placing, admission, live, steering = walk.placing, walk.admission, plans[LIVE], walk.steering
    gait = live.gait
    if _selects(gait, robot):
        placing.accepted = admit(walk, plans, knots, region, robot)
    else:
        admission.fraction = 1.0
        landing = foothold(gait.landing)
        if gait.adjustable:
            landing = landing_of(support_foot(gait), steering.wanted)
        plan_walk(live, landing, steering.wanted, moves(steering), robot)
    if admission.fraction < 1.0:
        if _differs(plans, walk, robot):
            placing.bound |= ZMP_REGION
        for k in range(3):
            change = steering.velocity[k] - placing.applied[k]
            placing.applied[k] += admission.fraction * change
    else:
        for k in range(3):
            placing.applied[k] = steering.velocity[k]
    return foothold(live.landing)


@compiled
def _differs(plans: Record, walk: Record, robot: Record) -> bool:
    """Whether the admitted plan differs from the wanted one."""
    live, wanted = plans[LIVE], plans[WANTED]
    retimed = not equal_clocks(live.gait.clock, wanted.gait.clock)
    if retimed or live.moving != wanted.moving:
        return True
    if not equal_strides(live.following, wanted.following):
        return True
    nominal = landing_of(support_foot(live.gait), walk.steering.wanted)
    differs: bool = live.gait.adjustable and not is_same(nominal, foothold(live.landing), robot)
    return differs


@compiled
def _capture(walk: Record, plan: Record, landing: Foothold, robot: Record) -> None:
    """Aim at the landing of a capture step if one is needed."""
    placing, gait, steering, goal = walk.placing, plan.gait, walk.steering, landing
    capture = _needed_capture(walk, plan, landing, robot)
    if capture.needed and shorten(gait, walk.limbs.feet, capture.ticks, capture.landing, robot):
        # The timing has changed: plan again.
        merge_pendulums(walk, plan)
        placing.accepted = False
        plan_walk(plan, landing, steering.wanted, moves(steering), robot)
        capture = _needed_capture(walk, plan, landing, robot)
    if capture.needed and not gait.double:
        goal = capture.landing
        placing.moved_x, placing.moved_y = goal.x - landing.x, goal.y - landing.y
    put(gait.landing, aimed(gait, foothold(gait.landing), goal, robot))
    now, nominal = foothold(gait.landing), landing_of(support_foot(gait), steering.wanted)
    if gait.shortened or not is_same(goal, landing, robot):
        placing.bound |= BALANCE
    elif not placing.bound & ZMP_REGION and not is_same(nominal, now, robot):
        placing.bound |= LANDING_SPEED
    if not _selects(gait, robot) and not equal(now, landing):
        plan_walk(plan, now, steering.wanted, moves(steering), robot)


# Pendulum


@compiled
def advance_pendulum(
    walk: Record, plans: Record, knots: Record, region: Region, robot: Record, sums: Record
) -> None:
    """Advance the pendulums of plan and body by one tick.

    Args:
        walk: state, changed.
        plans: plans (4,), see `LIVE`; the ZMP plan in force is changed.
        knots: knots of the plans (4, k); those of the plan in force are changed.
        region: admissible ZMP.
        robot: constants.
        sums: sums of the gains of preview control.
    """
    live, body, gain = plans[LIVE], walk.pendulum, robot.pattern.dcm_gain
    gait = live.gait
    selective = rejects_infeasible(robot)
    if selective and gait.shortened:
        track_reference(body, robot, gain, reference_of(live), region)
        return
    landing, planned = foothold(gait.landing), foothold(live.landing)
    if selective and not (gait.double or walk.off_plan or equal(landing, planned)):
        walk.planned, walk.off_plan = body, True
    pendulum = plan_pendulum(walk)
    x, y = dcm_of(pendulum, robot)
    accepted: bool = walk.placing.accepted
    advance_pattern(plans, knots, accepted, pendulum, region, robot, sums)
    if walk.off_plan:
        # Shift of the DCM by a ramp of the ZMP from the fixed support foot to the new landing.
        wh = robot.omega * CONTROL_PERIOD
        growth, _, last = ramp_weights(wh, gait.clock.timing.double)
        weight = (1.0 + last) / growth / ramp_weights(wh, gait.ticks_left)[0]
        x += weight * (landing.x - planned.x)
        y += weight * (landing.y - planned.y)
        track_dcm(body, robot, gain, (x, y), (pendulum.zmp_x, pendulum.zmp_y), region)


@compiled
def end_capture(walk: Record, plan: Record) -> None:
    """At touchdown, restart the plan from the pendulum of the body."""
    if walk.off_plan and (plan.gait.double or not plan.gait.stepping):
        merge_pendulums(walk, plan)


@compiled
def merge_pendulums(walk: Record, plan: Record) -> None:
    """Drop the plan of the generator."""
    walk.off_plan = False
    reset_plan(plan)
