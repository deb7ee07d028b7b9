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

from walking.lipm import Lipm
from walking.parameters import PatternParameters
from walking.pattern import DcmTracker, PendulumState, ZmpRamp, dcm_reference
from walking.robot_model import Sole
from walking.state import Footstep
from walking.support import SupportRegion
from walking.value import value
from walking.zmp_program import Knot, ZmpProgram

Feet = tuple[Footstep, Footstep]


@value
class ZmpPlan:
    """Knots from now on, and what they were made for.

    Attributes:
        knots: ticks since the one before, x, y [m].
        supports: end of the first ramps in ticks from now, and their feet.
        dual: of its program, see `ZmpFit` [1/m].
    """

    knots: list[Knot]
    supports: list[tuple[int, Feet]]
    dual: tuple[float, float]


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
        self._parameters = parameters
        self._sole = sole
        self._tracker = DcmTracker(lipm, parameters.dcm_gain)
        self._plan: ZmpPlan | None = None
        self._age = 0
        self._candidate: tuple[list[ZmpRamp], ZmpPlan] | None = None

    def admits(self, state: PendulumState, ramps: list[ZmpRamp], region: SupportRegion) -> bool:
        """Whether a plan with all knots in place leads into a reference."""
        plan = self._solve(state, ramps, self._parameters.plan_margin)
        if plan is not None:
            self._candidate = (ramps, plan)
        return plan is not None

    def advance(
        self,
        state: PendulumState,
        ramps: list[ZmpRamp],
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
        self._follow(state, self._plan.knots)
        self._age += 1

    def planned_dcm(self, state: PendulumState, ramps: list[ZmpRamp]) -> tuple[float, float]:
        """The pendulum's own DCM under a plan, that of the footholds without one."""
        if self._plan is None:
            return dcm_reference(self._lipm, ramps)
        w = self._lipm.omega
        return state.x + state.vx / w, state.y + state.vy / w

    def forget(self) -> None:
        """Give up the plan under way: the pendulum has been moved."""
        self._plan, self._age = None, 0

    def holds(self, ramps: list[ZmpRamp]) -> bool:
        """Whether there is a plan under way, and for the supports of a reference."""
        plan, age = self._plan, self._age
        if plan is None or not plan.knots:
            return False
        return all((end + age, feet) in plan.supports for end, feet in _supports(ramps)[:2])

    def _follow(self, state: PendulumState, knots: list[Knot]) -> None:
        """One tick along a plan, which loses its first segment when that is over."""
        lipm = self._lipm
        px, py = state.zmp_x, state.zmp_y
        if knots:
            ticks, x, y = knots[0]
            if ticks == 1:
                px, py = x, y
                del knots[0]
            else:
                px, py = px + (x - px) / ticks, py + (y - py) / ticks
                knots[0] = (ticks - 1, x, y)
        state.x, state.vx = lipm.slide(state.x, state.vx, state.zmp_x, px)
        state.y, state.vy = lipm.slide(state.y, state.vy, state.zmp_y, py)
        state.zmp_x, state.zmp_y = px, py

    def _replan(self, state: PendulumState, ramps: list[ZmpRamp]) -> None:
        """A plan for what nobody has asked about, or the one under way, or none."""
        p = self._parameters
        plan = self._solve(state, ramps, p.plan_margin)
        if plan is None and not self.holds(ramps):
            plan = self._solve(state, ramps, p.sole_margin)
            self._plan = None
        if plan is not None or self._plan is None:
            self._plan, self._age = plan, 0

    def _solve(self, state: PendulumState, ramps: list[ZmpRamp], margin: float) -> ZmpPlan | None:
        """The plan nearest to a reference, or None if none leads into it."""
        program = ZmpProgram(self._lipm, self._parameters, self._sole, state, ramps, margin=margin)
        growth = self._lipm.ramp(self._age).growth
        lx, ly = self._plan.dual if self._plan is not None else (0.0, 0.0)
        if not program.fit.solve((lx / growth, ly / growth)):
            return None
        return ZmpPlan(program.knots(), _supports(ramps), program.fit.dual)


def _supports(ramps: list[ZmpRamp]) -> list[tuple[int, Feet]]:
    ends, now = [], 0
    for ramp in ramps[:5]:
        now += ramp.ticks
        ends.append((now, ramp.feet))
    return ends
