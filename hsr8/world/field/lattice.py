"""Places and moves of a disc that walks among obstacles, and which are free when.

The robot is a disc on a square lattice with eight headings; it walks forward, turns on the
spot, or stands. Walking backward and sideways are left out: a proof may do without. Time
goes in layers. A move goes to a neighbour, or turns by 45 deg, in a whole number of layers,
never faster than the robot can. During a move the disc is nearer than half the move to one of
its two places, so both are asked to be free with that much to spare; standing obstacles
are compared with the whole way instead. A mover is looked at in the middle of each layer,
and its radius grows by the way it goes in half of one. So what is free here is free.
"""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.robot import SpeedEnvelope
from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]
Bits = NDArray[np.uint8]
"""One byte for each place, one bit for each heading."""

ALL = 0xFF
DISC = ROBOT_RADIUS + 0.02  # radius of the disc, the robot's and something to spare [m]
WAYS = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
HALF_MOVE = 0.5 * 2.0**0.5  # of the longest move [cell]
LAYERS_PER_CELL = 2  # layers in which the robot walks one cell forward


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """Forward from a place to its neighbour.

    Attributes:
        way: to the neighbour, in cells.
        layers: how long it takes.
        edge: states from which it can be made (n, m).
    """

    way: tuple[int, int]
    layers: int
    edge: Bits


class Lattice:
    """The lattice of a world; the start is one of its places.

    Args:
        layout: the world.
        speed: what the robot can do.
        cell: distance of neighbours [m].

    Attributes:
        cell: distance of neighbours [m].
        layer: duration of a layer [s].
        moves: all that leave a place.
        turn: layers that a turn by 45 deg takes.
        x: coordinates of the places (n,) [m].
        y: likewise (m,) [m].
        start: indices of the start.
    """

    def __init__(self, layout: Layout, speed: SpeedEnvelope, cell: float) -> None:
        self.cell = cell
        self.layer = cell / speed.vx / LAYERS_PER_CELL
        self.turn = self._layers(0.25 * pi / speed.wz)
        half = 0.5 * np.asarray(layout.field_size) - DISC
        self.x, i = _aligned(half[0], layout.start[0], cell)
        self.y, j = _aligned(half[1], layout.start[1], cell)
        self.start = i, j
        self._movers = layout.motion()
        reach = np.array([o.radius for o in layout.movers]) + DISC + HALF_MOVE * cell
        self._reach2 = (reach + 0.5 * self.layer * self._movers.top_speeds()) ** 2
        self._standing = self._clear(layout, (0.0, 0.0))
        self.moves = self._moves(layout, speed.vx)

    def free(self, layer: int) -> Bits:
        """Places that are free during a layer (n, m), 0 or `ALL`."""
        if len(self._movers) == 0:
            return self._standing
        at = self._movers.positions((layer + 0.5) * self.layer)
        dx2, dy2 = (self.x - at[:, :1]) ** 2, (self.y - at[:, 1:]) ** 2
        hit = (dx2[:, :, None] + dy2[:, None, :] <= self._reach2[:, None, None]).any(axis=0)
        return np.where(hit, np.uint8(0), self._standing)

    def connected(self) -> Bits:
        """Places that could be reached if nothing moved (n, m), 0 or `ALL`."""
        n, m = self._standing.shape
        found = np.zeros_like(self._standing)
        found[self.start] = self._standing[self.start]
        count = -1
        while count != (count := int(np.count_nonzero(found))):
            for move in self.moves:
                dx, dy = move.way
                leave = np.where(move.edge, found, np.uint8(0))
                found[max(dx, 0) : n + min(dx, 0), max(dy, 0) : m + min(dy, 0)] |= leave[
                    max(-dx, 0) : n - max(dx, 0), max(-dy, 0) : m - max(dy, 0)
                ]
        return found

    def near(self, point: tuple[float, float] | list[float], distance: float) -> Bits:
        """Places within `distance` [m] of `point` (n, m), 0 or `ALL`."""
        gap = np.hypot((self.x - point[0])[:, None], (self.y - point[1])[None])
        return _bits(gap <= distance)

    def _moves(self, layout: Layout, forward: float) -> tuple[Move, ...]:
        moves = []
        for way, (dx, dy) in enumerate(WAYS):
            edge = self._edge(layout, (dx, dy)) & np.uint8(1 << way)
            time = self.cell * (dx * dx + dy * dy) ** 0.5 / forward
            moves.append(Move((dx, dy), self._layers(time), edge))
        return tuple(moves)

    def _layers(self, time: float) -> int:
        return ceil(time / self.layer - 1e-9)

    def _edge(self, layout: Layout, way: tuple[int, int]) -> Bits:
        """Places from which the neighbour in some way exists and is reached without contact."""
        free = self._clear(layout, (self.cell * way[0], self.cell * way[1]))
        (dx, dy), there = way, np.zeros_like(free)
        n, m = free.shape
        there[max(-dx, 0) : n - max(dx, 0), max(-dy, 0) : m - max(dy, 0)] = ALL
        edge: Bits = free & there
        return edge

    def _clear(self, layout: Layout, move: tuple[float, float]) -> Bits:
        """Places from which a straight `move` [m] clears all standing obstacles."""
        clear = np.ones((len(self.x), len(self.y)), dtype=bool)
        square = move[0] ** 2 + move[1] ** 2
        for obstacle in layout.static:
            dx = (self.x - obstacle.position[0])[:, None]
            dy = (self.y - obstacle.position[1])[None]
            # Share of the move at which it comes nearest.
            share = np.clip(-(dx * move[0] + dy * move[1]) / (square or 1.0), 0.0, 1.0)
            gap2 = (dx + share * move[0]) ** 2 + (dy + share * move[1]) ** 2
            clear &= gap2 > (obstacle.radius + DISC) ** 2
        return _bits(clear)


def _aligned(half: float, through: float, cell: float) -> tuple[Array, int]:
    """Multiples of `cell` from `through` within +-`half` [m], and the index of `through`."""
    below = max(0, int((half + through) / cell + 1e-9))
    above = max(0, int((half - through) / cell + 1e-9))
    places: Array = through + cell * np.arange(-below, above + 1, dtype=np.float64)
    return places, below


def _bits(mask: NDArray[np.bool_]) -> Bits:
    return np.where(mask, np.uint8(ALL), np.uint8(0))
