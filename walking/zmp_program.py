"""From a reference to the program of its ZMP: where the knots are and what they weigh."""

from math import cos, hypot, sin

from walking.lipm import Lipm
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern import PendulumState, ZmpRamp, dcm_reference
from walking.robot_model import Sole
from walking.state import Footstep
from walking.zmp_fit import Cell, ZmpFit, limited, sides

SINGLE_SPACING = 9  # ticks between knots in single support
LATER_SPACING = 27  # ticks between knots in the single support after that
DOUBLE_SPACING = 18  # ticks between knots in a long double support
REST = 72  # ticks that a plan that ends goes on standing

Knot = tuple[int, float, float]
"""Ticks since the knot before, x, y [m]."""


class ZmpProgram:
    """The program of a reference.

    The ZMP is linear between knots at absolute times, so that they stay where they are as
    time goes by. A knot of a single support lies in the sole, one of a double support in a
    parallelogram within the hull of the two, its last one on the sole that carries next.

    Args:
        lipm: pendulum.
        parameters: largest rate of the ZMP.
        sole: rectangle of the soles.
        state: of the pendulum.
        ramps: reference.
        margin: distance of the knots from the edge of the sole [m].

    Attributes:
        fit: the quadratic program.
    """

    def __init__(
        self,
        lipm: Lipm,
        parameters: PatternParameters,
        sole: Sole,
        state: PendulumState,
        ramps: list[ZmpRamp],
        *,
        margin: float,
    ) -> None:
        self._sole, self._margin = sole, margin
        self._half = (sole.half_length - self._margin, sole.half_width - self._margin)
        near, far = _split(ramps)
        last = near[-1]
        self._end = (last.bx, last.by)
        rest = dcm_reference(lipm, far) if far else self._end
        self._cells: list[Cell] = []
        self._spans: list[int] = []
        self._lay_out(near)
        if self._cells and near[0].feet[0] is near[0].feet[1]:
            self._limit_rate(state, parameters.zmp_rate * CONTROL_PERIOD)
        self._left = sum(ramp.ticks for ramp in near) - sum(self._spans)
        self.fit = ZmpFit(self._cells, *self._weigh(lipm, state, rest))

    def knots(self) -> list[Knot]:
        """The knots of the solution, the end of the plan included."""
        points = zip(self._spans, self.fit.points(), strict=True)
        return [*((ticks, x, y) for ticks, (x, y) in points), (self._left, *self._end)]

    def _lay_out(self, near: list[ZmpRamp]) -> None:
        cells, spans = self._cells, self._spans
        every, since, carried = SINGLE_SPACING, 0, 0
        for index, ramp in enumerate(near):
            first, second = ramp.feet
            final = index == len(near) - 1
            # Counted from the end, so that the knots keep their times.
            if first is second:
                lefts = [*range((ramp.ticks - 1) // every * every, 0, -every)]
                lefts += [] if final else [0]
                if lefts or carried:
                    cells.append(self._on_sole(first, ramp, carried + len(lefts)))
                carried = 0
                every = LATER_SPACING
            else:
                lands = not final and near[index + 1].feet == (second, second)
                lefts = [
                    *range((ramp.ticks - 1) // DOUBLE_SPACING * DOUBLE_SPACING, 0, -DOUBLE_SPACING)
                ]
                lefts += [] if final or lands else [0]
                for left in lefts:
                    cells.append(self._between(ramp, 1.0 - left / ramp.ticks))
                if lands:
                    # On the next sole, with the knots of the single support on it.
                    carried = 1
                    lefts.append(0)
            for left in lefts:
                spans.append(since + ramp.ticks - left)
                since = left - ramp.ticks
            since += ramp.ticks

    def _on_sole(self, foot: Footstep, ramp: ZmpRamp, knots: int) -> Cell:
        c, s = cos(foot.yaw), sin(foot.yaw)
        cx, cy = foot.x + self._sole.centre * c, foot.y + self._sole.centre * s
        dx, dy = ramp.ax - cx, ramp.ay - cy
        length, width = self._half
        box = (c * dx + s * dy, c * dy - s * dx, -length, length, -width, width)
        return Cell((cx, cy), ((c, s), (-s, c)), box, knots)

    def _between(self, ramp: ZmpRamp, elapsed: float) -> Cell:
        """A parallelogram between the outer edges of two soles."""
        first, second = ramp.feet
        middle = 0.5 * (first.yaw + second.yaw)
        # Turned by as much as the soles are apart, an edge as long as they stays in them.
        slant = abs(sin(0.5 * (first.yaw - second.yaw)))
        length, width = self._half
        length = min(length, width / slant) if slant > 0.0 else length
        ax, ay = self._edge(first, width - length * slant)
        bx, by = self._edge(second, width - length * slant)
        span = hypot(bx - ax, by - ay)
        axes = ((cos(middle), sin(middle)), ((bx - ax) / span, (by - ay) / span))
        cx, cy = 0.5 * (ax + bx), 0.5 * (ay + by)
        x = ramp.ax + elapsed * (ramp.bx - ramp.ax)
        y = ramp.ay + elapsed * (ramp.by - ramp.ay)
        u, v = sides(axes, x - cx, y - cy)
        return Cell((cx, cy), axes, (u, v, -length, length, -0.5 * span, 0.5 * span))

    def _edge(self, foot: Footstep, outward: float) -> tuple[float, float]:
        """A point of the sole on the side away from the other one [m]."""
        c, s = cos(foot.yaw), sin(foot.yaw)
        across = outward if foot.left else -outward
        return (
            foot.x + self._sole.centre * c - s * across,
            foot.y + self._sole.centre * s + c * across,
        )

    def _limit_rate(self, state: PendulumState, reach: float) -> None:
        first = self._cells[0]
        knot = limited(first, state.zmp_x, state.zmp_y, reach * self._spans[0])
        first.knots -= 1
        self._cells[0:1] = [knot, first] if first.knots else [knot]

    def _weigh(
        self, lipm: Lipm, state: PendulumState, rest: tuple[float, float]
    ) -> tuple[float, float]:
        """Set the weights of the knots; the DCM that they have to bring about [m]."""
        spans = [*self._spans, self._left]
        w, c = lipm.omega, lipm.ramp(spans[0])
        decay = 1.0 / c.growth
        now, weight = decay * c.first, decay * c.last
        weights = []
        for ticks in spans[1:]:
            c = lipm.ramp(ticks)
            decay /= c.growth
            weights.append(weight + decay * c.first)
            weight = decay * c.last
        at = 0
        for cell in self._cells:
            cell.weigh(weights[at : at + cell.knots])
            at += cell.knots
        (ex, ey), (rx, ry) = self._end, rest
        return (
            state.x + state.vx / w - now * state.zmp_x - weight * ex - decay * rx,
            state.y + state.vy / w - now * state.zmp_y - weight * ey - decay * ry,
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
