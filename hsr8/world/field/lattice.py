"""Space-time lattice of a disc among obstacles: cells, moves and free cells over time.

The robot is a disc on a square lattice with eight headings. It walks forward, turns in place or
stands; backward and sideways walking are left out, which a proof may do. Time has layers. A move
leads to a neighbour, or turns by 45 deg, in a whole number of layers, never faster than the robot
can. During a move the disc is closer than half the move to one of the two cells, so both must be
free with that margin. Static obstacles are checked against the whole move instead. A mover is
checked in the middle of each layer, with its radius enlarged by its motion in half a layer. A
free cell is therefore free of collisions.
"""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.scenario.robot import Robot
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]
Bits = NDArray[np.uint8]
"""One byte per cell, one bit per heading."""

ALL = 0xFF
MARGIN = 0.02  # of the disc around the robot, in a world of scale 1 [m]
DIRECTIONS = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
HALF_MOVE = 0.5 * 2.0**0.5  # of the longest move [cell]
LAYERS_PER_CELL = 2  # layers of a straight move to a neighbour [1]


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """Move forward to a neighbour.

    Attributes:
        direction: direction to the neighbour [cells].
        layers: duration [layers].
        edge: states in which the move can start (n, m).
    """

    direction: tuple[int, int]
    layers: int
    edge: Bits


class Lattice:
    """Lattice of a world; the start is one of its cells.

    Args:
        layout: the world.
        robot: radius and speed limits.
        cell: distance of neighbours [m].

    Attributes:
        cell: distance of neighbours [m].
        layer: duration of a layer [s].
        moves: all moves from a cell.
        turn: duration of a turn by 45 deg [layers].
        x: coordinates of the cells along x (n,) [m].
        y: coordinates of the cells along y (m,) [m].
        start: indices of the start.
    """

    def __init__(self, layout: Layout, robot: Robot, cell: float) -> None:
        speed = robot.speed
        self.cell = cell
        self._disc = robot.radius + MARGIN * layout.scale
        self.layer = cell / speed.vx / LAYERS_PER_CELL
        self.turn = self._layers(0.25 * pi / speed.wz)
        half = 0.5 * np.asarray(layout.field_size) - self._disc
        self.x, i = _aligned(half[0], layout.start[0], cell)
        self.y, j = _aligned(half[1], layout.start[1], cell)
        self.start = i, j
        self._movers = layout.motion()
        reach = np.array([o.radius for o in layout.movers]) + self._disc + HALF_MOVE * cell
        self._reach2 = (reach + 0.5 * self.layer * self._movers.top_speeds()) ** 2
        self._static = self._clear(layout, (0.0, 0.0))
        self.moves = self._moves(layout, speed.vx)

    def free(self, layer: int) -> Bits:
        """Return the cells that are free during a layer (n, m), 0 or `ALL`."""
        if len(self._movers) == 0:
            return self._static
        at = self._movers.positions((layer + 0.5) * self.layer)
        free = self._static.copy()
        for (x, y), reach2 in zip(at, self._reach2, strict=True):
            rows, columns = _near(self.x, x, reach2**0.5), _near(self.y, y, reach2**0.5)
            gap2 = ((self.x[rows] - x) ** 2)[:, None] + (self.y[columns] - y) ** 2
            free[rows, columns][gap2 <= reach2] = 0
        return free

    def is_free(self, layer: int, i: int, j: int) -> bool:
        """Return whether a cell is free during a layer."""
        if not self._static[i, j]:
            return False
        at = self._movers.positions((layer + 0.5) * self.layer)
        dx2, dy2 = (self.x[i] - at[:, 0]) ** 2, (self.y[j] - at[:, 1]) ** 2
        return not bool((dx2 + dy2 <= self._reach2).any())

    def connected(self) -> Bits:
        """Return the cells reachable among static obstacles alone (n, m), 0 or `ALL`."""
        reached = np.zeros_like(self._static)
        if self._static[self.start]:
            edges = np.bitwise_or.reduce([move.edge for move in self.moves])
            flood(edges, *self.start, reached)
        return reached

    def near(self, point: tuple[float, float] | list[float], distance: float) -> Bits:
        """Return the cells within `distance` [m] of `point` (n, m), 0 or `ALL`."""
        gap = np.hypot((self.x - point[0])[:, None], (self.y - point[1])[None])
        return _bits(gap <= distance)

    def _moves(self, layout: Layout, forward: float) -> tuple[Move, ...]:
        moves = []
        for heading, (dx, dy) in enumerate(DIRECTIONS):
            edge = self._edge(layout, (dx, dy)) & np.uint8(1 << heading)
            time = self.cell * (dx * dx + dy * dy) ** 0.5 / forward
            moves.append(Move((dx, dy), self._layers(time), edge))
        return tuple(moves)

    def _layers(self, time: float) -> int:
        return ceil(time / self.layer - 1e-9)

    def _edge(self, layout: Layout, direction: tuple[int, int]) -> Bits:
        """Return the cells whose neighbour in a direction exists and can be reached."""
        dx, dy = direction
        free = self._clear(layout, (self.cell * dx, self.cell * dy))
        edge: Bits = free & shifted(np.full_like(free, ALL), (-dx, -dy))
        return edge

    def _clear(self, layout: Layout, move: tuple[float, float]) -> Bits:
        """Return the cells from which a straight `move` [m] clears all static obstacles."""
        clear = np.ones((len(self.x), len(self.y)), dtype=bool)
        square = move[0] ** 2 + move[1] ** 2
        for obstacle in layout.static:
            reach = obstacle.radius + self._disc + square**0.5
            rows = _near(self.x, obstacle.position[0], reach)
            columns = _near(self.y, obstacle.position[1], reach)
            dx = (self.x[rows] - obstacle.position[0])[:, None]
            dy = (self.y[columns] - obstacle.position[1])[None]
            # Fraction of the move at the closest approach.
            fraction = np.clip(-(dx * move[0] + dy * move[1]) / (square or 1.0), 0.0, 1.0)
            gap2 = (dx + fraction * move[0]) ** 2 + (dy + fraction * move[1]) ** 2
            clear[rows, columns] &= gap2 > (obstacle.radius + self._disc) ** 2
        return _bits(clear)


@compiled
def flood(edges: Bits, i: int, j: int, reached: Bits) -> None:
    """Mark the cells that can be reached from a cell.

    Args:
        edges: possible moves from each cell, a bit per direction (n, m).
        i: row of the first cell.
        j: column of the first cell.
        reached: set to `ALL` in the reached cells, 0 before (n, m).
    """
    n, m = edges.shape
    waiting = np.empty(n * m, np.int64)
    waiting[0], count = i * m + j, 1
    reached[i, j] = ALL
    while count > 0:
        count -= 1
        row, column = divmod(waiting[count], m)
        for direction in range(len(DIRECTIONS)):
            if edges[row, column] >> direction & 1:
                dx, dy = DIRECTIONS[direction]
                if reached[row + dx, column + dy] == 0:
                    reached[row + dx, column + dy] = ALL
                    waiting[count] = (row + dx) * m + column + dy
                    count += 1


def shifted(bits: Bits, direction: tuple[int, int]) -> Bits:
    """Return `bits` (..., n, m) moved by some cells along both axes, filled up with 0."""
    (dx, dy), (n, m) = direction, bits.shape[-2:]
    moved = np.zeros_like(bits)
    moved[..., max(dx, 0) : n + min(dx, 0), max(dy, 0) : m + min(dy, 0)] = bits[
        ..., max(-dx, 0) : n - max(dx, 0), max(-dy, 0) : m - max(dy, 0)
    ]
    return moved


def _aligned(half: float, through: float, cell: float) -> tuple[Array, int]:
    """Return multiples of `cell` from `through` within +-`half` [m], and the index of `through`."""
    below = max(0, int((half + through) / cell + 1e-9))
    above = max(0, int((half - through) / cell + 1e-9))
    coordinates: Array = through + cell * np.arange(-below, above + 1, dtype=np.float64)
    return coordinates, below


def _near(coordinates: Array, centre: float, distance: float) -> slice:
    """Return the rising coordinates within a distance of a centre, and one more on both sides."""
    first, last = np.searchsorted(coordinates, (centre - distance, centre + distance))
    return slice(max(0, int(first) - 1), int(last) + 1)


def _bits(mask: NDArray[np.bool_]) -> Bits:
    return np.where(mask, np.uint8(ALL), np.uint8(0))
