"""Where a robot that knows everything can be, layer of time after layer of time."""

from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.lattice import ALL, WAYS, Bits, Lattice, Move

Array = NDArray[np.float64]
State = tuple[int, int, int, int]
"""Points passed, indices of the place, heading."""

EIGHTH = 2.0 * pi / len(WAYS)
SHEETS = 2  # followed at a time


class Reachable:
    """All states that are reached without contact, as sheets of places.

    One sheet holds the states after a number of points passed; a state at the next point
    is in the next sheet as well. The two farthest sheets are followed: the first to reach
    a point may be trapped there while those behind it are not.

    Args:
        lattice: places and moves.
        targets: states (n, m) that pass each point, in order.

    Attributes:
        passed: points passed by the farthest state.
    """

    def __init__(self, lattice: Lattice, targets: list[Bits]) -> None:
        self._lattice, self._targets = lattice, targets
        self._longest = max(lattice.turn, *(move.layers for move in lattice.moves))
        self._free: list[Bits] = []
        self._states: list[Bits] = []
        self.passed = 0

    @property
    def arrived(self) -> bool:
        """Whether the last point is reached."""
        return self.passed == len(self._targets)

    @property
    def time(self) -> float:
        """How far it was followed [s]."""
        return (len(self._states) - 1) * self._lattice.layer

    def follow(self, heading: float, turn: float, layers: int) -> None:
        """Follow all states until the last point is reached, none is left, or time is over.

        Args:
            heading: at the start [rad].
            turn: time for the turn to the nearest heading of the lattice [s].
            layers: to follow at most.
        """
        places = len(self._lattice.x), len(self._lattice.y)
        sheets = np.zeros((len(self._targets) + 1, *places), dtype=np.uint8)
        self._states.append(sheets)
        i, j = self._lattice.start
        begin, standing = ceil(turn / self._lattice.layer - 1e-9), True
        while len(self._states) <= begin:
            self._free.append(self._lattice.free(len(self._free)))
            self._states.append(np.zeros_like(sheets))
            standing = standing and bool(self._free[-1][i, j])
        if not standing:
            return
        self._states[-1][0, i, j] = 1 << round(heading / EIGHTH) % len(WAYS)
        self._pass_points(0, self._states[-1])
        low, clear = 0, [np.full_like(sheets[0], ALL) for _ in range(self._longest + 1)]
        while not self.arrived and len(self._states) <= layers:
            free = self._lattice.free(len(self._free))
            self._free.append(free)
            # clear[m]: free during the last m layers.
            clear = [clear[0], *(before & free for before in clear[:-1])]
            states = self._next(low, clear)
            self._states.append(states)
            self._pass_points(low, states)
            low = max(low, self.passed + 1 - SHEETS)
            if not states[low:].any() and len(self._states) > begin + self._longest:
                return

    def path(self) -> Array:
        """A path to the last point: time, x, y, heading (n, 4) [s, m, m, rad].

        It waits as late as it can, for else it would make ways that lead nowhere.

        Raises:
            ValueError: the last point is not reached.
        """
        if not self.arrived:
            raise ValueError("there is no path: the last point is not reached")
        layer, passed = len(self._states) - 1, self.passed
        i, j = (int(k[0]) for k in np.nonzero(self._states[layer][passed]))
        bits = int(self._states[layer][passed, i, j])
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
        # Only where the motion changes.
        rates = np.diff(path[:, 1:], axis=0) / np.diff(path[:, :1], axis=0)
        bends = np.abs(np.diff(rates, axis=0)).max(axis=1) > 1e-9
        kept: Array = path[np.concatenate([[True], bends, [True]])]
        return kept

    def _next(self, low: int, clear: list[Bits]) -> Bits:
        """States of the layer after the last."""
        high = self.passed + 1
        states = np.zeros_like(self._states[-1])
        states[low:high] = self._states[-1][low:high] & clear[1]
        n, m = clear[0].shape
        since: dict[int, Bits] = {}
        made: dict[int, Bits] = {}
        for layers in {self._lattice.turn, *(move.layers for move in self._lattice.moves)}:
            if layers <= len(self._states):
                since[layers] = self._states[-layers][low:high] & clear[layers]
                made[layers] = np.zeros_like(since[layers])
        for move in self._lattice.moves:
            if move.layers not in since:
                continue
            dx, dy = move.way
            leave = since[move.layers] & move.edge
            made[move.layers][:, max(dx, 0) : n + min(dx, 0), max(dy, 0) : m + min(dy, 0)] |= leave[
                :, max(-dx, 0) : n - max(dx, 0), max(-dy, 0) : m - max(dy, 0)
            ]
        turning = since.get(self._lattice.turn)
        if turning is not None:
            made[self._lattice.turn] |= (
                (turning << 1) | (turning >> 7) | (turning >> 1) | (turning << 7)
            )
        for layers, there in made.items():
            states[low:high] |= there & clear[layers]
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
        """A state from which `state` was reached, and its layer; None at the start."""
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
        for other in ((heading + 1) % len(WAYS), (heading - 1) % len(WAYS)):
            if self._has(layer - turn, (passed, i, j, other)) and self._clear(layer, turn, i, j):
                return layer - turn, (passed, i, j, other)
        return None

    def _source(self, layer: int, state: State, move: Move) -> tuple[int, State] | None:
        passed, i, j, heading = state
        dx, dy = move.way
        there = i - dx, j - dy
        n, m = self._targets[0].shape
        if not (0 <= there[0] < n and 0 <= there[1] < m):
            return None
        before: State = (passed, *there, heading)
        if not (int(move.edge[there]) & (1 << heading) and self._has(layer - move.layers, before)):
            return None
        clear = all(self._clear(layer, move.layers, *place) for place in (there, (i, j)))
        return (layer - move.layers, before) if clear else None

    def _has(self, layer: int, state: State) -> bool:
        passed, i, j, heading = state
        return layer >= 0 and bool(int(self._states[layer][passed, i, j]) & (1 << heading))

    def _clear(self, layer: int, layers: int, i: int, j: int) -> bool:
        """Whether a place was free during some layers before `layer`."""
        return all(self._free[k][i, j] for k in range(layer - layers, layer))
