"""Paths of movers: cubic pieces of a phase, which advances with time.

The phase is (offset + speed (t - depart)) / unit: the distance travelled, a number of sides, or the
time of a recording. It is folded into a period, if there is one. Before the first and after the
last knot the mover stands at that end. Outside a window of the phase it is away from the field.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import Records, record_class, records

Array = NDArray[np.float64]
Point = tuple[float, float]


@record_class
class Clock:
    """Clock of a mover: attributes of its `Path`, and its pieces."""

    offset: float
    speed: float
    depart: float  # [s]
    unit: float
    first: float
    period: float
    window: Annotated[Array, 2]
    away: Annotated[Array, 2]  # [m]
    end: int  # index after its last piece


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """Path of a mover.

    Attributes:
        knots: begin of each piece, and the end of the last one (k + 1,).
        origins: phases from which the polynomials count (k,).
        cubics: coefficients of x and y, highest power first (k, 2, 4) [m].
        offset: distance or time before time zero.
        speed: rate of that distance or time.
        depart: time at which it begins [s].
        unit: distance or time per phase.
        first: begin of the first period.
        period: period of the phase; infinite without one.
        window: first phase, and end, of the presence of the mover.
        away: position of an absent mover [m].
    """

    knots: Array
    origins: Array
    cubics: Array
    offset: float = 0.0
    speed: float = 1.0
    depart: float = 0.0
    unit: float = 1.0
    first: float = 0.0
    period: float = inf
    window: tuple[float, float] = (-inf, inf)
    away: tuple[float, float] = (inf, inf)


class Law:
    """Motion of a mover: along its path, or on a circle, which has none."""

    __slots__ = ()

    @property
    def path(self) -> Path:
        """Path of the mover."""
        raise NotImplementedError

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        x, y = self.state(time)[:2].tolist()
        return x, y

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; where it jumps, the velocity after it."""
        x, y = self.state(time)[2:4].tolist()
        return x, y

    def state(self, time: float) -> Array:
        """Return the state at `time` [s], see `Paths.states` (6,)."""
        state: Array = Paths([self.path]).states(np.array([time]))[0]
        return state


class Paths:
    """Paths of several movers, evaluated together, each at its own time or all at one time.

    Args:
        paths: paths, at least one.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._clocks = records(Clock, len(paths))
        pieces = 0
        for clock, path in zip(self._clocks, paths, strict=True):
            for name in ("offset", "speed", "depart", "unit", "first", "period", "window", "away"):
                setattr(clock, name, getattr(path, name))
            pieces += len(path.cubics)
            clock.end = pieces
        knots = [np.stack([p.knots[:-1], p.knots[1:], p.origins], axis=1) for p in paths]
        self._knots = np.concatenate(knots)
        self._cubics = np.concatenate([path.cubics for path in paths])

    def states(self, times: Array) -> Array:
        """Return position, velocity, phase, and 1 for a present mover (..., n, 6) [m, m/s].

        Args:
            times: times (..., n or 1) [s].
        """
        n, rows = self._clocks.size, np.ascontiguousarray(times, dtype=float)
        states = np.empty((*times.shape[:-1], n, 6))
        _evaluate(
            self._clocks,
            self._knots,
            self._cubics,
            rows.reshape(-1, times.shape[-1]),
            states.reshape(-1, n, 6),
        )
        return states

    def positions(self, times: Array) -> Array:
        """Return the positions at `times` (..., n or 1) [s], in order (..., n, 2) [m]."""
        return self.states(times)[..., :2]

    def velocities(self, times: Array) -> Array:
        """Return the velocities at `times` (..., n or 1) [s], in order (..., n, 2) [m/s]."""
        return self.states(times)[..., 2:4]


@compiled
def _evaluate(
    clocks: Records[Clock], knots: Array, cubics: Array, times: Array, states: Array
) -> None:
    """Set the states of all movers at some times.

    Args:
        clocks: clocks of the movers (n,).
        knots: begin, end and origin of each piece of all movers (k, 3).
        cubics: coefficients of the pieces (k, 2, 4).
        times: times (t, n or 1) [s].
        states: set to the states (t, n, 6), see `Paths.states`.
    """
    for i in range(len(times)):
        first = 0
        for j in range(clocks.size):
            clock, last = clocks[j], clocks[j].end - 1
            time = times[i, j] if times.shape[1] > 1 else times[i, 0]
            phase = (clock.offset + clock.speed * (time - clock.depart)) / clock.unit
            if clock.period < inf:
                phase = clock.first + (phase - clock.first) % clock.period
            at = min(max(phase, knots[first, 0]), knots[last, 1])
            piece, beyond = first, last + 1  # the last one that begins until then
            while beyond - piece > 1:
                middle = (piece + beyond) // 2
                if knots[middle, 0] <= at:
                    piece = middle
                else:
                    beyond = middle
            u, state = at - knots[piece, 2], states[i, j]
            present = clock.window[0] <= phase < clock.window[1]
            rate = clock.speed / clock.unit if knots[first, 0] <= phase < knots[last, 1] else 0.0
            for axis in range(2):
                c = cubics[piece, axis]
                state[axis] = c[3] + u * (c[2] + u * (c[1] + u * c[0]))
                state[2 + axis] = rate * (c[2] + u * (2.0 * c[1] + u * (3.0 * c[0])))
                if not present:
                    state[axis] = clock.away[axis]
            state[4], state[5] = phase, present
            first = last + 1


def straight_pieces(points: Array, along: Array) -> Array:
    """Return the cubics of straight pieces (k, 2, 4) [m].

    Args:
        points: positions at the origins of the pieces (k, 2) [m].
        along: motion per phase (k, 2) [m].
    """
    zeros = np.zeros_like(points)
    return np.stack([zeros, zeros, along, points], axis=-1)


def hermite_pieces(knots: Array, points: Array, rates: Array) -> Array:
    """Return the cubics through points with given rates (k, 2, 4) [m].

    Args:
        knots: increasing phases (k + 1,).
        points: positions at the knots (k + 1, 2) [m].
        rates: derivatives of the position by the phase (k + 1, 2) [m].
    """
    steps = np.diff(knots)[:, None]
    slopes = np.diff(points, axis=0) / steps
    bend = (rates[:-1] + rates[1:] - 2.0 * slopes) / steps
    parts = [bend / steps, (slopes - rates[:-1]) / steps - bend, rates[:-1], points[:-1]]
    return np.stack(parts, axis=-1)
