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

from dataclasses import dataclass

from walking.lipm import Lipm
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern import PendulumState, ZmpRamp, dcm_reference
from walking.robot_model import Sole
from walking.state import Footstep
from walking.support import SupportRegion, support_region
from walking.zmp_fit import Knot, ZmpFit, knot_at, limit_rate

SINGLE_SPACING = 9  # ticks between knots in single support
LATER_SPACING = 27  # ticks between knots in the single support after that
DOUBLE_SPACING = 18  # ticks between knots in a long double support
REST = 72  # ticks that a plan that ends goes on standing

Feet = tuple[Footstep, Footstep]


@dataclass(frozen=True, slots=True)
class ZmpPlan:
    """Knots from now on, and what they were made for.

    Attributes:
        knots: ticks since the one before, x, y [m].
        supports: end of the first ramps in ticks from now, and their feet.
        missed: DCM that the plan does not lead back to the reference, zero if feasible [m].
    """

    knots: list[tuple[int, float, float]]
    supports: list[tuple[int, Feet]]
    missed: tuple[float, float]

    @property
    def feasible(self) -> bool:
        """Whether the plan leads to its end."""
        return self.missed == (0.0, 0.0)


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
        self._margin = parameters.sole_margin
        self._reach = parameters.zmp_rate * CONTROL_PERIOD
        self._sole = sole
        self._plan = ZmpPlan([], [], (0.0, 0.0))
        self._age = 0
        self._candidate: tuple[list[ZmpRamp], ZmpPlan] | None = None

    def admits(self, state: PendulumState, ramps: list[ZmpRamp], region: SupportRegion) -> bool:
        """Whether a plan with all knots in place leads into a reference."""
        plan = self._solve(state, ramps)
        if plan.feasible:
            self._candidate = (ramps, plan)
        return plan.feasible

    def advance(
        self,
        state: PendulumState,
        ramps: list[ZmpRamp],
        dcm: tuple[float, float],
        region: SupportRegion,
    ) -> None:
        """Advance `state` in place; its ZMP never leaves `region`.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            dcm: `dcm_reference` of the ramps [m].
            region: where the ZMP may be.
        """
        candidate, self._candidate = self._candidate, None
        plan = candidate[1] if candidate and candidate[0] is ramps else self._solve(state, ramps)
        if plan.feasible or not self._still_holds(ramps):
            self._plan, self._age = plan, 0
        self._follow(state)
        self._age += 1

    def planned_dcm(self, state: PendulumState, dcm: tuple[float, float]) -> tuple[float, float]:
        """The pendulum's own DCM, less what the plan does not lead back to the reference."""
        w = self._lipm.omega
        mx, my = self._plan.missed
        return state.x + state.vx / w - mx, state.y + state.vy / w - my

    def _follow(self, state: PendulumState) -> None:
        """One tick along the plan, which loses its first segment when that is over."""
        lipm, knots = self._lipm, self._plan.knots
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

    def _solve(self, state: PendulumState, ramps: list[ZmpRamp]) -> ZmpPlan:
        """The plan nearest to a reference, or the one that misses its DCM by little."""
        near, far = _split(ramps)
        last = near[-1]
        knots = self._knots(state, near)
        left = sum(ramp.ticks for ramp in near) - sum(knot.ticks for knot in knots)
        end = (last.bx, last.by)
        rest = dcm_reference(self._lipm, far) if far else end
        fit = ZmpFit(knots, *self._weigh(state, knots, left, end, rest))
        missed = fit.solve()
        points = [
            (k.ticks, k.cx + k.c * k.u - k.s * k.v, k.cy + k.s * k.u + k.c * k.v) for k in knots
        ]
        return ZmpPlan([*points, (left, *end)], _supports(ramps), missed)

    def _knots(self, state: PendulumState, near: list[ZmpRamp]) -> list[Knot]:
        knots: list[Knot] = []
        spacing = SINGLE_SPACING
        for index, ramp in enumerate(near):
            first, second = ramp.feet
            region = support_region(self._sole, first, second, self._margin)
            since = 0
            every = spacing if first is second else DOUBLE_SPACING
            # Counted from the end, so that the knots keep their times as time goes by.
            for ticks in (*range(ramp.ticks - 1 - (ramp.ticks - 1) % every, 0, -every), 0):
                now = ramp.ticks - ticks
                if ticks == 0 and index == len(near) - 1:
                    break
                share = now / ramp.ticks
                x = ramp.ax + share * (ramp.bx - ramp.ax)
                y = ramp.ay + share * (ramp.by - ramp.ay)
                lands = ticks == 0 and near[index + 1].feet == (second, second)
                knots.append(knot_at(now - since, region, x, y, on_second=lands))
                since = now
            if first is second:
                spacing = LATER_SPACING
        if knots and near[0].feet[0] is near[0].feet[1]:
            limit_rate(knots[0], state.zmp_x, state.zmp_y, self._reach * knots[0].ticks)
        return knots

    def _weigh(
        self,
        state: PendulumState,
        knots: list[Knot],
        left: int,
        end: tuple[float, float],
        rest: tuple[float, float],
    ) -> tuple[float, float]:
        """Set the weights of the knots; the DCM that they have to bring about [m].

        Args:
            state: of the pendulum.
            knots: all but the first point and the last.
            left: ticks from the last knot to the end.
            end: ZMP there [m].
            rest: DCM there [m].
        """
        w, lipm = self._lipm.omega, self._lipm
        c = lipm.ramp(knots[0].ticks)
        decay = 1.0 / c.growth
        now, weight = decay * c.first, decay * c.last
        spans = [*(knot.ticks for knot in knots[1:]), left]
        for knot, ticks in zip(knots, spans, strict=True):
            c = lipm.ramp(ticks)
            decay /= c.growth
            knot.weight = weight + decay * c.first
            weight = decay * c.last
        return (
            state.x + state.vx / w - now * state.zmp_x - weight * end[0] - decay * rest[0],
            state.y + state.vy / w - now * state.zmp_y - weight * end[1] - decay * rest[1],
        )


def _split(ramps: list[ZmpRamp]) -> tuple[list[ZmpRamp], list[ZmpRamp]]:
    """The ramps whose ZMP is planned, and the others.

    Planned is the ZMP up to the end of the second single support and through the double
    support after it; a reference that ends before is drawn out by a time of standing.
    """
    singles = 0
    for index, ramp in enumerate(ramps[:-1]):
        singles += ramp.feet[0] is ramp.feet[1]
        if singles == 2:
            return ramps[: index + 2], ramps[index + 2 :]
    last = ramps[-1]
    return [*ramps, ZmpRamp(REST, last.bx, last.by, last.bx, last.by, last.feet)], []


def _supports(ramps: list[ZmpRamp]) -> list[tuple[int, Feet]]:
    ends, now = [], 0
    for ramp in ramps[:5]:
        now += ramp.ticks
        ends.append((now, ramp.feet))
    return ends
