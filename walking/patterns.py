"""Pattern generators: motion of the pendulum along a piecewise-linear ZMP reference.

All receive the reference in every control tick, so footholds may change at any time. "dcm" and
"preview" track any reference, with delay if necessary. "paper" and "robust" reject infeasible
references: they admit only those that keep the ZMP inside the soles, and plan the ZMP, see
`walking.paper_pattern` and `walking.zmp_plan`.

Preview control (Kajita et al., ICRA 2003) has the change of the ZMP per tick as input. With the
state z = (x, x', p) the cart-table is z⁺ = A z + B u, p⁺ = p + u, discretized exactly; the cost is
Σ (p - p_ref)² + R u². The preview sum over a piecewise-linear reference is closed form in running
sums of the gains: the reference is not sampled.
"""

from math import cosh, sinh
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are

from compilation import compiled
from compilation.record import record_type
from walking.footsteps import FOOTHOLD, STRIDES
from walking.gait import GAIT
from walking.paper_pattern import (
    ZMP_FUNCTIONS,
    admits_target,
    advance_functions,
    forget_target,
    reachable_dcm,
)
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pendulum import dcm_of, dcm_reference, step_pendulum, track_reference
from walking.plane import Point
from walking.records import DCM, PAPER, PREVIEW, ROBUST, Record
from walking.reference import BEST, LIVE, RAMP, STEPS, reference_of
from walking.support import Region
from walking.zmp_plan import ZMP_PLAN, admits_knots, advance_knots
from walking.zmp_plan import remains_feasible as knots_remain_feasible

PREVIEW_SUM = record_type(gain=float, moment=float)
"""Running sums Σ f_j and Σ j f_j of the gains of preview control [1]."""

PLAN = record_type(
    gait=GAIT,
    landing=FOOTHOLD,
    following=STRIDES,
    moving=bool,
    ramps=(RAMP, 2 * STEPS + 2),
    ramp_count=int,
    steps=(FOOTHOLD, STEPS),
    step_count=int,
    zmp=ZMP_PLAN,
    functions=ZMP_FUNCTIONS,
)
"""Plan of the walk: gait with its timing; landing of the swing foot, strides after it, and whether
the walk goes on; ZMP reference and its number of ramps; footholds and their number; plan of the ZMP
of the generators that have one."""


class PreviewGains(NamedTuple):
    """Gains of u = -K z + Σ_j f_j p_ref(j ticks ahead), u the change of the ZMP [m].

    Attributes:
        position, velocity, zmp: the row K.
        total: Σ of all f_j to infinity: gain of a constant reference.
        sums: running sums to n = 0 … N, see `PREVIEW_SUM` (N + 1,).
    """

    position: float
    velocity: float
    zmp: float
    total: float
    sums: Record


def preview_gains(omega: float, parameters: PatternParameters) -> PreviewGains:
    """Solve the linear-quadratic regulator for a pendulum with ω [1/s]."""
    wh = omega * CONTROL_PERIOD
    c, s = cosh(wh), sinh(wh)
    A = np.array([[c, 1.0 / omega * s, 1.0 - c], [omega * s, c, -omega * s], [0.0, 0.0, 1.0]])
    B = np.array([[A[0, 2]], [A[1, 2]], [1.0]])
    C = np.array([[0.0, 0.0, 1.0]])
    R = np.array([[parameters.preview_weight]])
    P = solve_discrete_are(A, B, C.T @ C, R)
    scale = R + B.T @ P @ B
    K = np.linalg.solve(scale, B.T @ P @ A)
    closed = (A - B @ K).T
    horizon = round(parameters.preview_time / CONTROL_PERIOD)
    f = np.empty(horizon)
    costate = C.T
    for j in range(horizon):
        f[j] = np.linalg.solve(scale, B.T @ costate).item()
        costate = closed @ costate
    position, velocity, zmp = K[0].tolist()
    sums = np.zeros(horizon + 1, PREVIEW_SUM)
    sums["gain"][1:] = np.cumsum(f)
    sums["moment"][1:] = np.cumsum(f * np.arange(1, horizon + 1))
    return PreviewGains(position, velocity, zmp, position + zmp, sums)


@compiled
def advance_preview(
    pendulum: Record, ramps: Record, region: Region, robot: Record, sums: Record
) -> None:
    """Advance the pendulum by a tick along a reference.

    Args:
        pendulum: changed.
        ramps: reference.
        region: admissible ZMP.
        robot: constants.
        sums: see `PreviewGains`.
    """
    p = pendulum
    ahead_x, ahead_y = preview_sum(ramps, robot, sums)
    px = p.zmp_x * (1.0 - robot.preview_zmp) + ahead_x
    py = p.zmp_y * (1.0 - robot.preview_zmp) + ahead_y
    px -= robot.preview_position * p.x + robot.preview_velocity * p.vx
    py -= robot.preview_position * p.y + robot.preview_velocity * p.vy
    step_pendulum(pendulum, robot, (px, py), region)


@compiled
def preview_sum(ramps: Record, robot: Record, sums: Record) -> Point:
    """Return Σ_j f_j p_ref(j) over the horizon, and with its last point beyond."""
    horizon = sums.shape[0] - 1
    x = y = 0.0
    begin, end_x, end_y = 0, ramps[len(ramps) - 1].bx, ramps[len(ramps) - 1].by
    for k in range(len(ramps)):
        ramp = ramps[k]
        stop = min(begin + ramp.ticks, horizon)
        weight = sums[stop].gain - sums[begin].gain
        slope = (sums[stop].moment - sums[begin].moment - begin * weight) / ramp.ticks
        x += weight * ramp.ax + slope * (ramp.bx - ramp.ax)
        y += weight * ramp.ay + slope * (ramp.by - ramp.ay)
        begin = stop
        if stop == horizon:
            end_x, end_y = ramp.bx, ramp.by
            break
    rest = robot.preview_total - sums[begin].gain
    return x + rest * end_x, y + rest * end_y


@compiled
def rejects_infeasible(robot: Record) -> bool:
    """Whether the generator rejects some references."""
    selective: bool = robot.pattern.generator >= PAPER
    return selective


@compiled
def is_feasible(
    plans: Record, knots: Record, which: int, pendulum: Record, region: Region, robot: Record
) -> bool:
    """Whether the pendulum can follow a plan with the ZMP inside the soles.

    Args:
        plans: plans, see `walking.reference.LIVE` (4,); the ZMP plan of `BEST` is set if feasible.
        knots: knots of the plans (4, k); those of `BEST` are set if feasible.
        which: index of the plan.
        pendulum: present pendulum.
        region: admissible ZMP in this tick.
        robot: constants.
    """
    pattern, ramps = robot.pattern, reference_of(plans[which])
    if pattern.generator == ROBUST:
        return admits_knots(plans, knots, pendulum, ramps, pattern.plan_margin, robot)
    if pattern.generator == PAPER:
        return admits_target(plans[BEST].functions, pendulum, ramps, region, robot)
    return True


@compiled
def remains_feasible(plan: Record, robot: Record) -> bool:
    """Whether the ZMP plan of a plan stays feasible under its reference."""
    if robot.pattern.generator == ROBUST:
        return knots_remain_feasible(plan.zmp, reference_of(plan))
    if robot.pattern.generator == PAPER:
        reached: bool = plan.functions.missed_x == 0.0 and plan.functions.missed_y == 0.0
        return reached
    return True


@compiled
def reset_plan(plan: Record) -> None:
    """Drop the present ZMP plan after a jump of the pendulum."""
    plan.zmp.exists, plan.zmp.age = False, 0
    forget_target(plan.functions)


@compiled
def advance_pattern(
    plans: Record,
    knots: Record,
    accepted: bool,
    pendulum: Record,
    region: Region,
    robot: Record,
    sums: Record,
) -> None:
    """Advance the pendulum by a tick; its ZMP stays in the region.

    Args:
        plans: plans, see `walking.reference.LIVE` (4,); the ZMP plan in force is changed.
        knots: knots of the plans (4, k); those of the plan in force are changed.
        accepted: whether the ZMP plan of `BEST` belongs to the reference.
        pendulum: changed.
        region: admissible ZMP.
        robot: constants.
        sums: sums of the gains of preview control.
    """
    generator, ramps = robot.pattern.generator, reference_of(plans[LIVE])
    if generator == ROBUST:
        advance_knots(plans, knots, accepted, pendulum, ramps, region, robot)
    elif generator == PAPER:
        advance_functions(plans[LIVE].functions, pendulum, ramps, region, robot)
    elif generator == PREVIEW:
        advance_preview(pendulum, ramps, region, robot, sums)
    else:
        track_reference(pendulum, robot, robot.pattern.dcm_gain, ramps, region)


@compiled
def planned_dcm(plan: Record, pendulum: Record, robot: Record) -> Point:
    """Return the reference of the DCM for balance feedback [m].

    With a weight on the ZMP rate, preview control deviates from the DCM of the footholds.
    """
    generator = robot.pattern.generator
    if generator == PAPER:
        return reachable_dcm(plan.functions, pendulum, robot)
    if generator == DCM or (generator == ROBUST and not plan.zmp.exists):
        return dcm_reference(reference_of(plan), robot)
    return dcm_of(pendulum, robot)
