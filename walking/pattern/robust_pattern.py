"""A pattern whose ZMP is inside the soles at all times, between the ticks too.

The planned ZMP is linear between knots at absolute times. Every knot of a single support
lies in the sole, every knot of a double support in a parallelogram between the two; a
segment within one convex set stays in it, so nothing has to be sampled. Along such a ZMP
the pendulum is exact and its DCM now is a weighted sum of the knots,

    ξ(0) = Σ_j w_j p_j + D ξ_ref,

with ξ_ref the DCM that walks the rest of the reference and comes to rest on its last
foothold. A plan that fulfils this equation with all knots in place can always be walked to
its end: it is feasible in the next tick again, and it is what is walked if a new one is not.

Among all such plans the one nearest to the reference is a quadratic program with two
equations and bounds. Its dual has two unknowns, found by Newton's method; without active
bounds that is one division.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from walking.body.sole import Sole
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern import zmp_kernel
from walking.pattern.dcm_tracker import DcmTracker, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.support import SupportRegion

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

NO_DUAL = (0.0, 0.0)  # to begin with where nothing is known [1/m]
AHEAD = 5  # ramps of a plan that are looked at to tell whether it can be carried on


@dataclass(slots=True)
class ZmpPlan:
    """Knots from now on, and what they were made for.

    Attributes:
        knots: ticks since the one before, x, y [m] (n, 3); see `next`.
        ramps: reference that the plan was made for, see `Ramps` (m, 13).
        dual: λ of its program, see `walking.pattern.zmp_kernel` [1/m].
        next: index of the first knot to come.
    """

    knots: Array
    ramps: Array
    dual: tuple[float, float]
    next: int = 0


class RobustGenerator:
    """Plans the ZMP by knots in the soles.

    Args:
        lipm: pendulum.
        parameters: margin and largest rate of the ZMP.
        sole: rectangle of the soles.
    """

    selective = True

    def __init__(self, lipm: Lipm, parameters: PatternParameters, sole: Sole) -> None:
        self._lipm = lipm
        self._sole, self._planned_sole = (
            (sole.centre, sole.half_length - margin, sole.half_width - margin)
            for margin in (parameters.sole_margin, parameters.plan_margin)
        )
        self._wh = lipm.omega * CONTROL_PERIOD
        self._rate = parameters.zmp_rate * CONTROL_PERIOD
        self._tracker = DcmTracker(lipm, parameters.dcm_gain)
        self._plan: ZmpPlan | None = None
        self._age = 0
        self._candidate: tuple[Sequence[ZmpRamp], ZmpPlan] | None = None

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        """Whether a plan with all knots in place leads into a reference."""
        plan = self._solve(state, ramps, self._planned_sole)
        if plan is not None:
            self._candidate = (ramps, plan)
        return plan is not None

    def advance(
        self,
        state: PendulumState,
        ramps: Sequence[ZmpRamp],
        region: SupportRegion,
    ) -> None:
        """Advance `state` in place; its ZMP never leaves `region`.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: where the ZMP may be.
        """
        candidate, self._candidate = self._candidate, None
        if candidate and candidate[0] is ramps:
            self._plan, self._age = candidate[1], 0
        else:
            self._replan(state, ramps)
        if self._plan is None:
            self._tracker.follow(state, ramps, region)
            return
        self._follow(state, self._plan)
        self._age += 1

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
        """The pendulum's own DCM under a plan, that of the footholds without one."""
        if self._plan is None:
            return dcm_reference(self._lipm, ramps)
        w = self._lipm.omega
        return state.x + state.vx / w, state.y + state.vy / w

    def forget(self) -> None:
        """Give up the plan under way: the pendulum has been moved."""
        self._plan, self._age = None, 0

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        """Whether there is a plan under way, and for the supports of a reference."""
        plan, age = self._plan, self._age
        if plan is None or plan.next == len(plan.knots):
            return False
        planned = _supports(plan.ramps[:AHEAD])
        return all((end + age, feet) in planned for end, feet in _supports(table_of(ramps)[:2]))

    def _follow(self, state: PendulumState, plan: ZmpPlan) -> None:
        """One tick along a plan."""
        now = (state.x, state.y, state.vx, state.vy, state.zmp_x, state.zmp_y)
        then, plan.next = zmp_kernel.follow(plan.knots, plan.next, now, self._lipm.tick)
        state.x, state.y, state.vx, state.vy, state.zmp_x, state.zmp_y = then

    def _replan(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> None:
        """A plan for what nobody has asked about, or the one under way, or none."""
        plan = self._solve(state, ramps, self._planned_sole)
        if plan is None and not self.holds(ramps):
            plan = self._solve(state, ramps, self._sole)
            self._plan = None
        if plan is not None or self._plan is None:
            self._plan, self._age = plan, 0

    def _solve(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], sole: Vector
    ) -> ZmpPlan | None:
        """The plan nearest to a reference, or None if none leads into it."""
        w, table, plan, dual = self._lipm.omega, table_of(ramps), self._plan, NO_DUAL
        if plan is not None:
            growth = self._lipm.ramp(self._age).growth
            dual = plan.dual[0] / growth, plan.dual[1] / growth
        feasible, dual, _, knots = zmp_kernel.plan(
            table,
            (state.x, state.y, state.vx / w, state.vy / w, state.zmp_x, state.zmp_y),
            sole,
            self._wh,
            self._rate,
            dual,
        )
        return ZmpPlan(knots, table, dual) if feasible else None


def _supports(ramps: Array) -> list[tuple[float, list[float]]]:
    """End of each ramp in ticks from now, and its feet."""
    rows = ramps.tolist()
    return list(zip(accumulate(row[0] for row in rows), (row[5:] for row in rows), strict=True))
