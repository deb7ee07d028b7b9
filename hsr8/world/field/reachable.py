"""Reachability in the space-time lattice, layer by layer."""

from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.lattice import ALL, DIRECTIONS, Bits, Lattice, Move, shifted

Array = NDArray[np.float64]
State = tuple[int, int, int, int]
"""Points passed, indices of the cell, heading."""

EIGHTH = 2.0 * pi / len(DIRECTIONS)
SHEETS = 2  # propagated at a time


class Reachable:
    """All states that are reachable without contact, as sheets of cells.

    One sheet holds the states after a number of passed points; a state at the next point is also
    in the next sheet. The two farthest sheets are propagated: the first state at a point may be
    trapped there while later ones are not.

    Args:
        lattice: cells and moves.
        targets: states (n, m) that pass each point, in order.

    Attributes:
        passed: points passed by the farthest state.
    """

    def __init__(self, lattice: Lattice, targets: list[Bits]) -> None:
        self._lattice, self._targets = lattice, targets
        self._max_layers = max(lattice.turn, *(move.layers for move in lattice.moves))
        self._shape = len(lattice.x), len(lattice.y)
        self._layers: list[_Sheets] = []
        self.passed = 0

    @property
    def arrived(self) -> bool:
        """Whether the last point is reached."""
        return self.passed == len(self._targets)

    @property
    def time(self) -> float:
        """Time of the last layer [s]."""
        return (len(self._layers) - 1) * self._lattice.layer

    @property
    def work(self) -> int:
        """Number of cells in all layers."""
        return len(self._layers) * self._shape[0] * self._shape[1]

    def propagate(self, heading: float, turn: float, layers: int) -> None:
        """Propagate all states until the last point is reached, none is left, or time is over.

        Args:
            heading: heading at the start [rad].
            turn: duration of the turn to the nearest heading of the lattice [s].
            layers: maximum number.
        """
        i, j = self._lattice.start
        begin = ceil(turn / self._lattice.layer - 1e-9)
        states = np.zeros((len(self._targets) + 1, *self._shape), dtype=np.uint8)
        self._layers = [_Sheets(0, states[:1])] * (begin + 1)
        if not all(self._lattice.is_free(layer, i, j) for layer in range(begin)):
            return
        states[0, i, j] = 1 << round(heading / EIGHTH) % len(DIRECTIONS)
        self._pass_points(0, states)
        self._layers[-1] = _Sheets(0, states[: self.passed + 1])
        low, clear = 0, [np.full(self._shape, np.uint8(ALL)) for _ in range(self._max_layers + 1)]
        while not self.arrived and len(self._layers) <= layers:
            free = self._lattice.free(len(self._layers) - 1)
            # clear[m]: free during the last m layers.
            clear = [clear[0], *(before & free for before in clear[:-1])]
            states = self._next(low, clear, states)
            self._pass_points(low, states)
            self._layers.append(_Sheets(low, states[low : self.passed + 1]))
            low = max(low, self.passed + 1 - SHEETS)
            if not states[low:].any() and len(self._layers) > begin + self._max_layers:
                return

    def path(self) -> Array:
        """Return a path to the last point, which is reached: time, x, y, heading (n, 4).

        Units [s, m, m, rad]. The path waits as late as possible, so that it has no detours.
        """
        layer, passed = len(self._layers) - 1, self.passed
        (last,) = self._layers[layer].within(passed, passed + 1, self._shape)
        i, j = (int(k[0]) for k in np.nonzero(last))
        bits = int(last[i, j])
        state: State = (passed, i, j, bits.bit_length() - 1)
        knots = [(layer, state)]
        while True:
            before = self._before(layer, state)
            if before is None:
                break
            layer, state = before
            knots.append(before)
        rows = [
            (layer * self._lattice.layer, self._lattice.x[i], self._lattice.y[j], EIGHTH * heading)
            for layer, (_, i, j, heading) in reversed(knots)
        ]
        path = np.array(rows)
        path[:, 3] = np.unwrap(path[:, 3])
        if len(path) == 1:  # the last point is the start
            return path
        # Keep the rows at which the motion changes.
        rates = np.diff(path[:, 1:], axis=0) / np.diff(path[:, :1], axis=0)
        bends = np.abs(np.diff(rates, axis=0)).max(axis=1) > 1e-9
        kept: Array = path[np.concatenate([[True], bends, [True]])]
        return kept

    def _next(self, low: int, clear: list[Bits], before: Bits) -> Bits:
        """Return the states of the next layer, from those of the last one."""
        high = self.passed + 1
        states = np.zeros_like(before)
        states[low:high] = before[low:high] & clear[1]
        since: dict[int, Bits] = {}
        made: dict[int, Bits] = {}
        for layers in {self._lattice.turn, *(move.layers for move in self._lattice.moves)}:
            if layers <= len(self._layers):
                sheets = self._layers[-layers].within(low, high, self._shape)
                since[layers] = sheets & clear[layers]
                made[layers] = np.zeros_like(since[layers])
        for move in self._lattice.moves:
            if move.layers not in since:
                continue
            made[move.layers] |= shifted(since[move.layers] & move.edge, move.direction)
        turning = since.get(self._lattice.turn)
        if turning is not None:
            made[self._lattice.turn] |= (
                (turning << 1) | (turning >> 7) | (turning >> 1) | (turning << 7)
            )
        for layers, moved in made.items():
            states[low:high] |= moved & clear[layers]
        return states

    def _pass_points(self, low: int, states: Bits) -> None:
        while True:
            for k in range(low, self.passed + 1):
                if k < len(self._targets):
                    states[k + 1] |= states[k] & self._targets[k]
            if self.arrived or not states[self.passed + 1].any():
                return
            self.passed += 1

    def _before(self, layer: int, state: State) -> tuple[int, State] | None:
        """Return a predecessor of `state` and its layer; None at the start."""
        passed, i, j, heading = state
        if self._has(layer - 1, state) and self._clear(layer, 1, i, j):
            return layer - 1, state
        if passed and self._has(layer, (passed - 1, i, j, heading)):
            bit = 1 << heading
            if int(self._targets[passed - 1][i, j]) & bit:
                return self._before(layer, (passed - 1, i, j, heading))
        for move in self._lattice.moves:
            source = self._source(layer, state, move)
            if source is not None:
                return source
        turn = self._lattice.turn
        for other in ((heading + 1) % len(DIRECTIONS), (heading - 1) % len(DIRECTIONS)):
            if self._has(layer - turn, (passed, i, j, other)) and self._clear(layer, turn, i, j):
                return layer - turn, (passed, i, j, other)
        return None

    def _source(self, layer: int, state: State, move: Move) -> tuple[int, State] | None:
        passed, i, j, heading = state
        dx, dy = move.direction
        cell = i - dx, j - dy
        n, m = self._targets[0].shape
        if not (0 <= cell[0] < n and 0 <= cell[1] < m):
            return None
        before: State = (passed, *cell, heading)
        if not (int(move.edge[cell]) & (1 << heading) and self._has(layer - move.layers, before)):
            return None
        clear = all(self._clear(layer, move.layers, *end) for end in (cell, (i, j)))
        return (layer - move.layers, before) if clear else None

    def _has(self, layer: int, state: State) -> bool:
        passed, i, j, heading = state
        return layer >= 0 and bool(self._layers[layer].at(passed, i, j) & (1 << heading))

    def _clear(self, layer: int, layers: int, i: int, j: int) -> bool:
        """Return whether a cell was free during some layers before `layer`."""
        return all(self._lattice.is_free(k, i, j) for k in range(layer - layers, layer))


class _Sheets:
    """States of one layer: some sheets, cut to the smallest rectangle that has all states.

    Args:
        low: number of the first sheet.
        sheets: states (k, n, m).
    """

    def __init__(self, low: int, sheets: Bits) -> None:
        self._low = low
        self._rows = _extent(np.flatnonzero(sheets.any(axis=(0, 2))))
        self._columns = _extent(np.flatnonzero(sheets.any(axis=(0, 1))))
        self._cut = sheets[:, self._rows, self._columns].copy()

    def within(self, low: int, high: int, shape: tuple[int, int]) -> Bits:
        """Return the sheets from `low` to less than `high` (high - low, n, m)."""
        sheets = np.zeros((high - low, *shape), dtype=np.uint8)
        first, last = max(low, self._low), min(high, self._low + len(self._cut))
        if first < last:
            own = self._cut[first - self._low : last - self._low]
            sheets[first - low : last - low, self._rows, self._columns] = own
        return sheets

    def at(self, passed: int, i: int, j: int) -> int:
        """Return the states of a cell on a sheet."""
        k, row, column = passed - self._low, i - self._rows.start, j - self._columns.start
        if min(k, row, column) < 0 or any(np.greater_equal((k, row, column), self._cut.shape)):
            return 0
        return int(self._cut[k, row, column])


def _extent(indices: NDArray[np.intp]) -> slice:
    """Return the range of rising indices."""
    return slice(int(indices[0]), int(indices[-1]) + 1) if len(indices) else slice(0, 0)
