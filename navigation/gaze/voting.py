"""Gaze at the highest centre of a map of votes."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from navigation.gaze.gaze_map import GazeGrid, Votes
from navigation.gaze.policy import Gaze, GazeContext, GazePolicy

Array = NDArray[np.float64]


class VotingGaze(GazePolicy):
    """Gaze at the highest centre of the gaze map.

    The gaze stays if the highest centre does not exceed it by the switch ratio. With a ratio of 1
    it always moves to the highest centre, as printed.

    Args:
        votes: voting rule.
        grid: cells of the gaze map.
        switch_ratio: gain in the gaze map that moves the gaze, at least 1.
    """

    steady = True
    stabilized = True

    def __init__(
        self, votes: Callable[[GazeContext], Votes], grid: GazeGrid, switch_ratio: float
    ) -> None:
        self._votes = votes
        self._grid = grid
        self._ratio = switch_ratio

    def look(self, context: GazeContext, now: Gaze) -> tuple[Array, Gaze]:
        gaze_map = self._grid.gaze_map(self._votes(context))
        if float(gaze_map.max()) >= self._ratio * self._grid.value_at(gaze_map, *now):
            return gaze_map, self._grid.highest_centre(gaze_map, *now)
        return gaze_map, now
