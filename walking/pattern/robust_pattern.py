"""Robust pattern generator: a planned ZMP inside the soles at all times, between ticks, too.

The planned ZMP is linear between knots at absolute times. Every knot of a single support is in the
sole, every knot of a double support in a parallelogram between the soles; a segment within a convex
set stays in it, so nothing is sampled. Along such a ZMP the pendulum is exact and its present DCM
is a weighted sum of the knots,

    ξ(0) = Σ_j w_j p_j + D ξ_ref,

with ξ_ref the DCM of the rest of the reference, which comes to rest on its last foothold. A plan
that satisfies this equation and the bounds of all knots can be walked to its end: it is feasible
again in the next tick, and is kept if a new one is infeasible.

The plan nearest to the reference is a quadratic program with two equations and bounds. Its dual has
two unknowns, solved by Newton's method; without active bounds that is one division.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

from walking.arrays import Array, Point, Vector
from walking.body.sole import Sole
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern import pendulum_kernel, zmp_layout_kernel, zmp_solver_kernel
from walking.pattern.dcm_pattern import DcmGenerator, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.support import SupportRegion

NO_DUAL = (0.0, 0.0)  # initial guess without a plan [1/m]
AHEAD = 5  # ramps of a plan compared in `holds`


@dataclass(slots=True)
class ZmpPlan:
    """Planned ZMP.

    Attributes:
        knots: ticks since the previous knot, x, y [m] (n, 3).
        ramps: reference of the plan, see `Ramps` (m, 13).
        dual: λ of the program, see `walking.pattern.zmp_solver_kernel` [1/m].
        next: index of the next knot.
    """

    knots: Array
    ramps: Array
    dual: Point
    next: int = 0


class RobustGenerator:
    """Pattern generator that plans the ZMP by knots in the soles.

    Args:
        lipm: pendulum.
        parameters: margins and maximum rate of the ZMP.
        sole: rectangle of the soles.
    """

    selective = True

    def __init__(self, lipm: Lipm, parameters: PatternParameters, sole: Sole) -> None:
        self._lipm = lipm
        self._sole, self._planned_sole = (
            (sole.centre, sole.half_length - margin, sole.half_width - margin)
            for margin in (parameters.sole_margin, parameters.plan_margin)
        )
        self._rate = parameters.zmp_rate * CONTROL_PERIOD
        self._tracker = DcmGenerator(lipm, parameters.dcm_gain)
        self._plan: ZmpPlan | None = None
        self._age = 0
        self._candidate: tuple[Sequence[ZmpRamp], ZmpPlan] | None = None

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        plan = self._solve(state, ramps, self._planned_sole)
        if plan is not None:
            self._candidate = (ramps, plan)
        return plan is not None

    def advance(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        candidate, self._candidate = self._candidate, None
        if candidate and candidate[0] is ramps:
            self._plan, self._age = candidate[1], 0
        else:
            self._replan(state, ramps)
        plan, tick = self._plan, self._lipm.tick
        if plan is None:
            self._tracker.advance(state, ramps, region)
            return
        then, plan.next = pendulum_kernel.follow(plan.knots, plan.next, state.row, tick)
        state.x, state.y, state.vx, state.vy, state.zmp_x, state.zmp_y = then
        self._age += 1

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> Point:
        if self._plan is None:
            return dcm_reference(self._lipm, ramps)
        return state.dcm(self._lipm.omega)

    def forget(self) -> None:
        self._plan, self._age = None, 0

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        plan, age = self._plan, self._age
        if plan is None or plan.next == len(plan.knots):
            return False
        planned = _supports(plan.ramps[:AHEAD])
        return all((end + age, feet) in planned for end, feet in _supports(table_of(ramps)[:2]))

    def _replan(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> None:
        """Plan for a reference that was not admitted, or keep the present plan, or none."""
        plan = self._solve(state, ramps, self._planned_sole)
        if plan is None and not self.holds(ramps):
            plan = self._solve(state, ramps, self._sole)
            self._plan = None
        if plan is not None or self._plan is None:
            self._plan, self._age = plan, 0

    def _solve(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], sole: Vector
    ) -> ZmpPlan | None:
        """Return the plan nearest to a reference, None if infeasible."""
        table, plan, dual = table_of(ramps), self._plan, NO_DUAL
        if plan is not None:
            growth = self._lipm.ramp(self._age).growth
            dual = plan.dual[0] / growth, plan.dual[1] / growth
        cells, starts, weights, dcm, knots = zmp_layout_kernel.lay_out(
            table, state.row, sole, self._lipm.tick, self._rate
        )
        feasible, dual, _ = zmp_solver_kernel.solve(cells, starts, weights, dcm, dual, knots)
        return ZmpPlan(knots, table, dual) if feasible else None


def _supports(ramps: Array) -> list[tuple[float, list[float]]]:
    """Return the end of each ramp in ticks from now, and its feet."""
    rows = ramps.tolist()
    return list(zip(accumulate(row[0] for row in rows), (row[5:] for row in rows), strict=True))
