"""A pattern whose ZMP is inside the soles at all times, between the ticks too.

The planned ZMP is linear between knots at absolute times. Every knot of a single support
lies in the sole, every knot of a double support in a rectangle between the two soles; a
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

from dataclasses import dataclass, replace

from walking.lipm import Lipm
from walking.parameters import PatternParameters
from walking.pattern import PendulumState, ZmpRamp
from walking.robot_model import Sole
from walking.state import Footstep
from walking.support import SupportRegion
from walking.zmp_program import DOUBLE_SPACING, Knot, Lean, ZmpProgram

Feet = tuple[Footstep, Footstep]


@dataclass(frozen=True, slots=True)
class ZmpPlan:
    """Knots from now on, and what they were made for.

    Attributes:
        knots: ticks since the one before, x, y [m].
        supports: end of the first ramps in ticks from now, and their feet.
        missed: DCM that the plan does not lead back to the reference, zero if feasible [m].
        dual: of its program, see `ZmpFit` [1/m].
    """

    knots: list[Knot]
    supports: list[tuple[int, Feet]]
    missed: tuple[float, float]
    dual: tuple[float, float]

    @property
    def feasible(self) -> bool:
        """Whether the plan leads to its end."""
        return self.missed == (0.0, 0.0)


@dataclass(slots=True)
class Undisturbed:
    """What the pendulum would do had it not to catch the body.

    Attributes:
        state: of the pendulum.
        knots: that it follows.
        missed: DCM that they do not lead back to the reference [m].
    """

    state: PendulumState
    knots: list[Knot]
    missed: tuple[float, float]


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
        self._plan = ZmpPlan([], [], (0.0, 0.0), (0.0, 0.0))
        self._age = 0
        self._candidate: tuple[list[ZmpRamp], ZmpPlan] | None = None
        self._undisturbed: Undisturbed | None = None

    def admits(self, state: PendulumState, ramps: list[ZmpRamp], region: SupportRegion) -> bool:
        """Whether a plan with all knots in place leads into a reference."""
        plan = self._solve(state, ramps)
        if plan is not None:
            self._candidate = (ramps, plan)
        return plan is not None

    def advance(
        self,
        state: PendulumState,
        ramps: list[ZmpRamp],
        region: SupportRegion,
        *,
        forced: bool = False,
    ) -> None:
        """Advance `state` in place; its ZMP never leaves `region`.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: where the ZMP may be.
            forced: whether the footholds of the reference catch the body.
        """
        self._set_aside(state, forced=forced)
        candidate, self._candidate = self._candidate, None
        plan = candidate[1] if candidate and candidate[0] is ramps else self._solve(state, ramps)
        if plan is not None:
            self._plan, self._age = plan, 0
        elif not self._still_holds(ramps):
            self._plan, self._age = self._nearest(state, ramps), 0
        self._follow(state, self._plan.knots)
        self._age += 1

    def planned_dcm(self, state: PendulumState, ramps: list[ZmpRamp]) -> tuple[float, float]:
        """DCM of a pendulum that had no body to catch, if it can be led back to its reference.

        While footholds are moved to catch the body the pendulum goes with it; the body's
        distance from this DCM is what has to be caught.
        """
        aside, w, growth = self._undisturbed, self._lipm.omega, self._lipm.ramp(self._age).growth
        if aside is not None:
            state, missed, growth = aside.state, aside.missed, 1.0
        else:
            missed = self._plan.missed
        mx, my = missed
        return state.x + state.vx / w - growth * mx, state.y + state.vy / w - growth * my

    def _set_aside(self, state: PendulumState, *, forced: bool) -> None:
        """Begin, carry on or end the motion that catches nothing."""
        aside, growth = self._undisturbed, self._lipm.ramp(1).growth
        if not forced:
            self._undisturbed = None
            return
        if aside is None:
            plan, elapsed = self._plan, self._lipm.ramp(self._age).growth
            mx, my = plan.missed
            aside = Undisturbed(replace(state), list(plan.knots), (elapsed * mx, elapsed * my))
            self._undisturbed = aside
        self._follow(aside.state, aside.knots)
        aside.missed = (growth * aside.missed[0], growth * aside.missed[1])

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

    def _still_holds(self, ramps: list[ZmpRamp]) -> bool:
        """Whether the plan under way is feasible and was made for the same supports."""
        plan, age = self._plan, self._age
        if not plan.feasible or not plan.knots:
            return False
        return all((end + age, feet) in plan.supports for end, feet in _supports(ramps)[:2])

    def _solve(self, state: PendulumState, ramps: list[ZmpRamp]) -> ZmpPlan | None:
        """The plan nearest to a reference, or None if none leads into it."""
        program = self._program(state, ramps, None)
        growth = self._lipm.ramp(self._age).growth
        lx, ly = self._plan.dual
        if not program.fit.solve((lx / growth, ly / growth)):
            if not _long_double(ramps):
                return None
            # Two soles have more room than the slices about the reference.
            program = self._program(state, ramps, program.fit.approach())
            if not program.fit.solve((0.0, 0.0)):
                return None
        return ZmpPlan(program.knots(), _supports(ramps), (0.0, 0.0), program.fit.dual)

    def _nearest(self, state: PendulumState, ramps: list[ZmpRamp]) -> ZmpPlan:
        """The plan that misses the DCM of a reference by as little as may be."""
        program = self._program(state, ramps, None)
        missed = program.fit.approach()
        if _long_double(ramps):
            program = self._program(state, ramps, missed)
            missed = program.fit.approach()
        return ZmpPlan(program.knots(), _supports(ramps), missed, (0.0, 0.0))

    def _program(self, state: PendulumState, ramps: list[ZmpRamp], lean: Lean | None) -> ZmpProgram:
        return ZmpProgram(self._lipm, self._parameters, self._sole, state, ramps, lean=lean)


def _long_double(ramps: list[ZmpRamp]) -> bool:
    """Whether the reference begins with a double support that has knots within."""
    first = ramps[0]
    return first.feet[0] is not first.feet[1] and first.ticks > DOUBLE_SPACING


def _supports(ramps: list[ZmpRamp]) -> list[tuple[int, Feet]]:
    ends, now = [], 0
    for ramp in ramps[:5]:
        now += ramp.ticks
        ends.append((now, ramp.feet))
    return ends
