"""Modifiable walking pattern generator (MWPG): ZMP functions that lead to a walking state.

Lee et al., "Modifiable Walking Pattern of a Humanoid Robot by Using Allowable ZMP Variation",
IEEE T-RO 2008; the formulas are derived here from the pendulum. In the frame of the support
foot, with remaining single support τ, the divergent component ξ = x + x'/ω and the convergent one
ζ = x - x'/ω obey

    ξ(τ) = e^{ωτ} ξ(0) - A,    A = ∫ ω e^{ω(τ-s)} p(s) ds
    ζ(τ) = e^{-ωτ} ζ(0) + B,   B = ∫ ω e^{-ω(τ-s)} p(s) ds

so a walking state at touchdown is two linear equations in the ZMP function p. For |p| ≤ P the set
of reachable (A, B) is convex and its boundary is reached by one switch from +P to -P or back; the
function of minimum peak for (A, B) is therefore that boundary function scaled down, and the command
is feasible exactly if the scale is at most one. In double support the DCM is tracked.
"""

from math import exp, inf, log, sqrt
from typing import NamedTuple

from compilation import compiled
from compilation.record import Records
from walking.data import Pendulum, Ramp, ZmpFunctions
from walking.model import Model
from walking.parameters import CONTROL_PERIOD
from walking.plan.pendulum import dcm_of, dcm_reference, hold, ramp_weights, track_reference
from walking.plan.reference import is_single
from walking.plan.support import Region
from walking.plane import Point, clamp, rotate, within

SAME_TARGET = 1e-7  # rounding error of a walking state [m]


class WalkingTarget(NamedTuple):
    """Walking state at the end of single support, in the frame of the support foot.

    Attributes:
        xi: divergent component relative to the nominal ZMP, along and across the foot [m].
        zeta: convergent component relative to the nominal ZMP [m].
        free: whether the convergent component is free.
    """

    xi: Point
    zeta: Point
    free: bool


class TwoLevel(NamedTuple):
    """Two-level ZMP functions: `level` until the switch, then -`level`.

    Attributes:
        level: ZMP relative to its nominal point, along and across the support foot [m].
        switch: time of the switch before the end of single support, of each [s].
    """

    level: Point
    switch: Point


@compiled
def zmp_function(omega: float, time: float, a: float, b: float) -> Point:
    """Return level [m] and switch [s] of the two-level function of minimum peak for A and B [m].

    With z = e^{ω · switch} and E = e^{ωτ} the boundary function of peak one has A = 1 + E - 2z and
    B = 2/z - 1/E - 1; (A, B) on its ray is a quadratic in z with one root in [1, E].

    Args:
        omega: ω of the pendulum [1/s].
        time: τ > 0 [s].
        a: A of the function [m].
        b: B of the function [m].
    """
    growth = exp(omega * time)
    if a == 0.0 and b == 0.0:
        return 0.0, 0.0
    middle = b * (1.0 + growth) + a * (1.0 + 1.0 / growth)
    # Both roots without cancellation: q / (2b) and 2a / q.
    sign = 1.0 if middle >= 0.0 else -1.0
    q = 0.5 * (middle + sign * sqrt(max(0.0, middle * middle - 16.0 * a * b)))
    one = 2.0 * a / q if q != 0.0 else inf
    other = q / (2.0 * b) if b != 0.0 else inf
    z = one if max(1.0 - one, one - growth) <= max(1.0 - other, other - growth) else other
    z = within(z, 1.0, growth)
    unit_a, unit_b = 1.0 + growth - 2.0 * z, 2.0 / z - 1.0 / growth - 1.0
    # Least squares of the two ratios, which differ by rounding only.
    level = (a * unit_a + b * unit_b) / (unit_a * unit_a + unit_b * unit_b)
    return level, log(z) / omega


@compiled
def walking_target(ramps: Records[Ramp], robot: Model) -> WalkingTarget:
    """Return the DCM of the planned footholds, and ζ of the periodic walk they lead to."""
    if len(ramps) == 1:
        return WalkingTarget((0.0, 0.0), (0.0, 0.0), True)
    first = ramps[0]
    x, y = dcm_reference(ramps[1:], robot)
    xi = rotate(-first.unloading.yaw, x - first.bx, y - first.by)
    zeta, free = _periodic(ramps, robot)
    return WalkingTarget(xi, zeta, free)


@compiled
def _periodic(ramps: Records[Ramp], robot: Model) -> tuple[Point, bool]:
    """Return ζ at the end of the last single support on this side, in the frame of its foot."""
    x, y, wh = ramps[0].bx, ramps[0].by, robot.omega * CONTROL_PERIOD
    zeta, free = (0.0, 0.0), True
    for k in range(1, len(ramps)):
        ramp = ramps[k]
        growth, first, last = ramp_weights(wh, ramp.ticks)
        # ζ is the DCM of reversed time.
        x = (x + first * ramp.bx + last * ramp.ax) / growth
        y = (y + first * ramp.by + last * ramp.ay) / growth
        foot = ramp.loading
        if is_single(ramp) and foot.left == ramps[0].unloading.left:
            zeta, free = rotate(-foot.yaw, x - ramp.bx, y - ramp.by), False
    return zeta, free


@compiled
def admits_target(
    trial: ZmpFunctions, pendulum: Pendulum, ramps: Records[Ramp], region: Region, robot: Model
) -> bool:
    """Aim at the walking state of a reference; return whether the ZMP can stay in the sole.

    Args:
        trial: ZMP functions with the last target, set if feasible.
        pendulum: present pendulum.
        ramps: reference.
        region: admissible ZMP.
        robot: constants.
    """
    ramp = ramps[0]
    if not is_single(ramp):
        return True
    target = walking_target(ramps, robot)
    if _is_near(trial, target):
        return True
    functions, (along, across) = _solve(pendulum, ramp, target, robot), _room(ramp, region)
    if abs(functions.level[0]) > along or abs(functions.level[1]) > across:
        return False
    _put_functions(trial, target, functions)
    trial.missed_x = trial.missed_y = 0.0
    return True


@compiled
def reaches_target(live: ZmpFunctions) -> bool:
    """Whether the functions lead to the DCM of their target."""
    return live.missed_x == 0.0 and live.missed_y == 0.0


@compiled
def reset_target(live: ZmpFunctions) -> None:
    """Drop the present target."""
    live.aimed = False
    live.missed_x = live.missed_y = 0.0


@compiled
def advance_functions(
    live: ZmpFunctions, pendulum: Pendulum, ramps: Records[Ramp], region: Region, robot: Model
) -> None:
    """Advance the pendulum by a tick along the ZMP functions, in double support along the DCM.

    Args:
        live: ZMP functions in force, changed.
        pendulum: changed.
        ramps: reference.
        region: admissible ZMP.
        robot: constants.
    """
    if not is_single(ramps[0]):
        reset_target(live)
        gain = robot.pattern.dcm_gain
        track_reference(pendulum, robot, gain, ramps, region)
        return
    if not admits_target(live, pendulum, ramps, region, robot):
        _approximate(live, pendulum, ramps, region, robot)
    _follow(live, pendulum, ramps[0], robot)


@compiled
def reachable_dcm(live: ZmpFunctions, pendulum: Pendulum, robot: Model) -> Point:
    """Return the reference of the DCM for balance feedback [m]."""
    x, y = dcm_of(pendulum, robot)
    return x - live.missed_x, y - live.missed_y


@compiled
def _is_near(plan: ZmpFunctions, target: WalkingTarget) -> bool:
    """Whether the target of a plan differs by rounding only."""
    if not plan.aimed or plan.free != target.free:
        return False
    x, y = target.xi
    gap = max(abs(x - plan.xi.x), abs(y - plan.xi.y))
    if not target.free:
        x, y = target.zeta
        gap = max(gap, abs(x - plan.zeta.x), abs(y - plan.zeta.y))
    return gap < SAME_TARGET


@compiled
def _put_functions(plan: ZmpFunctions, target: WalkingTarget, functions: TwoLevel) -> None:
    plan.aimed, plan.free = True, target.free
    plan.xi.x, plan.xi.y = target.xi
    plan.zeta.x, plan.zeta.y = target.zeta
    plan.level.x, plan.level.y = functions.level
    plan.switch.x, plan.switch.y = functions.switch


@compiled
def _solve(pendulum: Pendulum, ramp: Ramp, target: WalkingTarget, robot: Model) -> TwoLevel:
    w, time, yaw = robot.omega, ramp.ticks * CONTROL_PERIOD, ramp.unloading.yaw
    x, y = rotate(-yaw, pendulum.x - ramp.ax, pendulum.y - ramp.ay)
    vx, vy = rotate(-yaw, pendulum.vx / w, pendulum.vy / w)
    along, along_switch = _solve_axis(w, time, x, vx, target.xi[0], target.zeta[0], target.free)
    across, switch = _solve_axis(w, time, y, vy, target.xi[1], target.zeta[1], target.free)
    return TwoLevel((along, across), (along_switch, switch))


@compiled
def _solve_axis(
    w: float, time: float, x: float, v: float, xi: float, zeta: float, free: bool
) -> Point:
    """Return level [m] and switch [s] of an axis for position x [m] and v, velocity over ω [m]."""
    growth = exp(w * time)
    a = growth * (x + v) - xi
    if free:
        return a / (growth - 1.0), 0.0
    return zmp_function(w, time, a, zeta - (x - v) / growth)


@compiled
def _approximate(
    live: ZmpFunctions, pendulum: Pendulum, ramps: Records[Ramp], region: Region, robot: Model
) -> None:
    """Approximate the DCM of an infeasible reference by a constant ZMP."""
    ramp = ramps[0]
    target = WalkingTarget(walking_target(ramps, robot).xi, (0.0, 0.0), True)
    growth = exp(robot.omega * ramp.ticks * CONTROL_PERIOD)
    wanted, (along, across) = _solve(pendulum, ramp, target, robot), _room(ramp, region)
    u, v = wanted.level
    level = (clamp(u, along), clamp(v, across))
    _put_functions(live, target, TwoLevel(level, (0.0, 0.0)))
    missed_u = (u - level[0]) * (growth - 1.0) / growth
    missed_v = (v - level[1]) * (growth - 1.0) / growth
    live.missed_x, live.missed_y = rotate(ramp.unloading.yaw, missed_u, missed_v)


@compiled
def _follow(live: ZmpFunctions, pendulum: Pendulum, ramp: Ramp, robot: Model) -> None:
    """Advance by a tick under the ZMP functions, with a switch within the tick if needed."""
    left = ramp.ticks * CONTROL_PERIOD
    end = left - CONTROL_PERIOD
    level, switch = live.level, live.switch
    late, early = min(switch.x, switch.y), max(switch.x, switch.y)
    times = (early, late, end)
    for k in range(3):
        until = times[k]
        if k < 2 and not end < until < left:
            continue
        middle = 0.5 * (left + until)
        u = level.x if middle > switch.x else -level.x
        v = level.y if middle > switch.y else -level.y
        dx, dy = rotate(ramp.unloading.yaw, u, v)
        p, px, py, time = pendulum, ramp.ax + dx, ramp.ay + dy, left - until
        p.x, p.vx = hold(robot.omega, p.x, p.vx, px, time)
        p.y, p.vy = hold(robot.omega, p.y, p.vy, py, time)
        p.zmp_x, p.zmp_y = px, py
        left = until


@compiled
def _room(ramp: Ramp, region: Region) -> Point:
    """Return the range of the ZMP about its nominal point along and across the sole [m]."""
    u, v = rotate(-ramp.unloading.yaw, ramp.ax - region.bx, ramp.ay - region.by)
    return max(0.0, region.length - abs(u)), max(0.0, region.width - abs(v))
