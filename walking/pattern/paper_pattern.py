"""Modifiable walking pattern: ZMP functions that lead to a walking state.

Lee et al., "Modifiable Walking Pattern of a Humanoid Robot by Using Allowable ZMP Variation",
IEEE T-RO 2008; the formulas are derived here from the pendulum. In the frame of the support
foot, with remaining single support τ, the divergent component ξ = x + x'/ω and the convergent one
ζ = x - x'/ω obey

    ξ(τ) = e^{ωτ} ξ(0) - A,    A = ∫ ω e^{ω(τ-s)} p(s) ds
    ζ(τ) = e^{-ωτ} ζ(0) + B,   B = ∫ ω e^{-ω(τ-s)} p(s) ds

so a walking state at touchdown is two linear equations in the ZMP function p. For |p| ≤ P the set
of reachable (A, B) is convex and its boundary is reached by one switch from +P to -P or back; the
function of minimum peak for (A, B) is therefore that boundary function scaled down, and the command
is feasible exactly if the scale is at most one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, inf, log, sqrt

from walking.arrays import Point
from walking.clamp import clamp
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern.dcm_pattern import DcmGenerator, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion
from walking.planar import rotate

SAME_TARGET = 1e-7  # rounding error of a walking state [m]


@dataclass(frozen=True, slots=True)
class ZmpFunction:
    """Two-level ZMP function: `level` until the switch, then -`level`.

    Attributes:
        level: ZMP relative to its nominal point, in the frame of the support foot [m].
        switch: time of the switch before the end of single support [s].
    """

    level: float
    switch: float


def zmp_function(omega: float, time: float, a: float, b: float) -> ZmpFunction:
    """Return the two-level function of minimum peak for A and B [m].

    With z = e^{ω · switch} and E = e^{ωτ} the boundary function of peak one has A = 1 + E - 2z and
    B = 2/z - 1/E - 1; (A, B) on its ray is a quadratic in z with one root in [1, E].

    Args:
        omega: of the pendulum [1/s].
        time: τ > 0 [s].
        a: A of the function [m].
        b: B of the function [m].
    """
    growth = exp(omega * time)
    if a == 0.0 and b == 0.0:
        return ZmpFunction(0.0, 0.0)
    middle = b * (1.0 + growth) + a * (1.0 + 1.0 / growth)
    # Both roots without cancellation: q / (2b) and 2a / q.
    q = 0.5 * (middle + (1.0 if middle >= 0.0 else -1.0) * sqrt(max(0.0, middle * middle - 16.0 * a * b)))
    roots = [2.0 * a / q if q != 0.0 else inf, q / (2.0 * b) if b != 0.0 else inf]
    z = min(roots, key=lambda root: max(1.0 - root, root - growth))
    z = min(growth, max(1.0, z))
    unit_a, unit_b = 1.0 + growth - 2.0 * z, 2.0 / z - 1.0 / growth - 1.0
    # Least squares of the two ratios, which differ by rounding only.
    level = (a * unit_a + b * unit_b) / (unit_a * unit_a + unit_b * unit_b)
    return ZmpFunction(level, log(z) / omega)


@dataclass(frozen=True, slots=True)
class WalkingTarget:
    """Walking state at the end of single support, in the frame of the support foot.

    Attributes:
        xi: divergent component relative to the nominal ZMP, along and across the foot [m].
        zeta: convergent component relative to the nominal ZMP; None leaves it free [m].
    """

    xi: Point
    zeta: Point | None

    def near(self, other: "WalkingTarget | None") -> bool:
        """Whether another target differs by rounding only."""
        if other is None or (self.zeta is None) != (other.zeta is None):
            return False
        gap = max(abs(a - b) for a, b in zip(self.xi, other.xi, strict=True))
        if self.zeta is not None and other.zeta is not None:
            gap = max(gap, *(abs(a - b) for a, b in zip(self.zeta, other.zeta, strict=True)))
        return gap < SAME_TARGET


class PaperGenerator:
    """Pattern generator with ZMP functions in single and DCM tracking in double support.

    Args:
        lipm: pendulum.
        parameters: gain of DCM tracking.
    """

    selective = True

    def __init__(self, lipm: Lipm, parameters: PatternParameters) -> None:
        self._lipm = lipm
        self._double = DcmGenerator(lipm, parameters.dcm_gain)
        self._target: WalkingTarget | None = None
        self._functions = (ZmpFunction(0.0, 0.0), ZmpFunction(0.0, 0.0))
        self._residual = (0.0, 0.0)

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        ramp = ramps[0]
        if ramp.feet[0] is not ramp.feet[1]:
            return True
        target = self.walking_target(ramps)
        if target.near(self._target):
            return True
        functions = self._solve(state, ramp, target)
        room = _room(ramp, region)
        if any(abs(f.level) > r for f, r in zip(functions, room, strict=True)):
            return False
        self._target, self._functions = target, functions
        self._residual = (0.0, 0.0)
        return True

    def advance(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        ramp = ramps[0]
        if ramp.feet[0] is not ramp.feet[1]:
            self._target = None
            self._residual = (0.0, 0.0)
            self._double.advance(state, ramps, region)
            return
        if not self.admits(state, ramps, region):
            self._approximate(state, ramps, region)
        self._follow(state, ramp)

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> Point:
        (x, y), (rx, ry) = state.dcm(self._lipm.omega), self._residual
        return x - rx, y - ry

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        return self._residual == (0.0, 0.0)

    def forget(self) -> None:
        self._target, self._residual = None, (0.0, 0.0)

    def walking_target(self, ramps: Sequence[ZmpRamp]) -> WalkingTarget:
        """Return the DCM of the planned footholds, and ζ of the periodic walk they lead to."""
        first = ramps[0]
        if len(ramps) == 1:
            return WalkingTarget((0.0, 0.0), None)
        x, y = dcm_reference(self._lipm, ramps[1:])
        xi = rotate(-first.feet[0].yaw, x - first.bx, y - first.by)
        return WalkingTarget(xi, self._periodic(ramps))

    def _periodic(self, ramps: Sequence[ZmpRamp]) -> Point | None:
        """Return ζ at the end of the last single support on this side, in the frame of its foot."""
        x, y = ramps[0].bx, ramps[0].by
        side, zeta = ramps[0].feet[0].left, None
        for ramp in ramps[1:]:
            c = self._lipm.ramp(ramp.ticks)
            # ζ is the DCM of reversed time.
            x = (x + c.first * ramp.bx + c.last * ramp.ax) / c.growth
            y = (y + c.first * ramp.by + c.last * ramp.ay) / c.growth
            foot = ramp.feet[1]
            if ramp.feet[0] is foot and foot.left is side:
                zeta = rotate(-foot.yaw, x - ramp.bx, y - ramp.by)
        return zeta

    def _solve(
        self, state: PendulumState, ramp: ZmpRamp, target: WalkingTarget
    ) -> tuple[ZmpFunction, ZmpFunction]:
        w, time = self._lipm.omega, ramp.ticks * CONTROL_PERIOD
        growth = exp(w * time)
        yaw = ramp.feet[0].yaw
        position = rotate(-yaw, state.x - ramp.ax, state.y - ramp.ay)
        speed = rotate(-yaw, state.vx / w, state.vy / w)
        functions = []
        for axis in (0, 1):
            x, v = position[axis], speed[axis]
            a = growth * (x + v) - target.xi[axis]
            if target.zeta is None:
                functions.append(ZmpFunction(a / (growth - 1.0), 0.0))
            else:
                b = target.zeta[axis] - (x - v) / growth
                functions.append(zmp_function(w, time, a, b))
        return functions[0], functions[1]

    def _approximate(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        """Approximate the DCM of an infeasible reference by a constant ZMP."""
        ramp = ramps[0]
        target = WalkingTarget(self.walking_target(ramps).xi, None)
        growth = exp(self._lipm.omega * ramp.ticks * CONTROL_PERIOD)
        functions, missed = [], []
        wanted = self._solve(state, ramp, target)
        for function, room in zip(wanted, _room(ramp, region), strict=True):
            level = clamp(function.level, room)
            functions.append(ZmpFunction(level, 0.0))
            missed.append((function.level - level) * (growth - 1.0) / growth)
        self._target, self._functions = target, (functions[0], functions[1])
        self._residual = rotate(ramp.feet[0].yaw, missed[0], missed[1])

    def _follow(self, state: PendulumState, ramp: ZmpRamp) -> None:
        """Advance by a tick under the ZMP functions, with a switch within the tick if needed."""
        lipm, yaw = self._lipm, ramp.feet[0].yaw
        left = ramp.ticks * CONTROL_PERIOD
        along, across = self._functions
        changes = {f.switch for f in self._functions if left - CONTROL_PERIOD < f.switch < left}
        for until in (*sorted(changes, reverse=True), left - CONTROL_PERIOD):
            middle = 0.5 * (left + until)
            u = along.level if middle > along.switch else -along.level
            v = across.level if middle > across.switch else -across.level
            dx, dy = rotate(yaw, u, v)
            px, py = ramp.ax + dx, ramp.ay + dy
            state.x, state.vx = lipm.hold(state.x, state.vx, px, left - until)
            state.y, state.vy = lipm.hold(state.y, state.vy, py, left - until)
            state.zmp_x, state.zmp_y = px, py
            left = until


def _room(ramp: ZmpRamp, region: SupportRegion) -> Point:
    """Return the range of the ZMP about its nominal point along and across the sole [m]."""
    foot = ramp.feet[0]
    x, y, _, _, length, width = region.row[4:].tolist()
    u, v = rotate(-foot.yaw, ramp.ax - x, ramp.ay - y)
    return max(0.0, length - abs(u)), max(0.0, width - abs(v))
