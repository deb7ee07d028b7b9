"""The gaze map GM over pan and tilt, Yoo & Kim, eqs. (5) and (6)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from navigation.value import value

Array = NDArray[np.float64]

_FLAT = 1e-9
"""Cells this close to the maximum belong to the top plateau."""


@value
class Votes:
    """Weighted directions that ask for a look.

    Attributes:
        pan, tilt: candidate directions (n,) [rad].
        value: weight times partial evaluation (n,).
    """

    pan: Array
    tilt: Array
    value: Array

    @classmethod
    def one(cls, pan: float, tilt: float, value: float) -> "Votes":
        """A single vote."""
        return cls(np.array([pan]), np.array([tilt]), np.array([value]))

    @classmethod
    def join(cls, parts: list["Votes"]) -> "Votes":
        """All votes of `parts` together."""
        if not parts:
            return cls(np.zeros(0), np.zeros(0), np.zeros(0))
        return cls(
            np.concatenate([p.pan for p in parts]),
            np.concatenate([p.tilt for p in parts]),
            np.concatenate([p.value for p in parts]),
        )


class GazeGrid:
    """Cells of gaze angles and the boxes in which a vote counts.

    Boxes in pan and tilt only approximate what a pinhole camera shows; they serve for
    votes, never to decide what was seen.
    """

    def __init__(
        self,
        *,
        max_pan: float,
        min_tilt: float,
        max_tilt: float,
        step: float,
        half_pan: float,
        half_tilt: float,
    ) -> None:
        """Build the grid.

        Args:
            max_pan: largest pan to either side [rad].
            min_tilt: lowest tilt [rad].
            max_tilt: highest tilt [rad].
            step: distance of cells [rad].
            half_pan: half width of a box [rad].
            half_tilt: half height of a box [rad].
        """
        self._step = step
        columns = int(max_pan / step + _FLAT)
        self.pan: Array = step * np.arange(-columns, columns + 1, dtype=np.float64)
        rows = int((max_tilt - min_tilt) / step + _FLAT) + 1
        self.tilt: Array = min_tilt + step * np.arange(rows, dtype=np.float64)
        self.half_pan = half_pan
        self.half_tilt = half_tilt

    def gaze_map(self, votes: Votes) -> Array:
        """GM (tilts, pans): the sum of the regions R(theta_k) of all votes.

        Sources: Yoo & Kim, eqs. (5) and (6); the weights of (6) are in the values of the votes.
        """
        pans = np.abs(self.pan - votes.pan[:, None]) <= self.half_pan + _FLAT
        tilts = np.abs(self.tilt - votes.tilt[:, None]) <= self.half_tilt + _FLAT
        total: Array = (tilts * votes.value[:, None]).T @ pans.astype(np.float64)
        return total

    def value_at(self, gaze_map: Array, pan: float, tilt: float) -> float:
        """GM of the cell nearest to the gaze (pan, tilt) [rad]."""
        row, column = self._cell(pan, tilt)
        return float(gaze_map[row, column])

    def highest_centre(self, gaze_map: Array, pan: float, tilt: float) -> tuple[float, float]:
        """theta*, the centre of the largest plateau of greatest GM.

        Of plateaus of equal size the one nearest the present gaze wins, then the smaller
        pan; a centroid outside its plateau gives way to the nearest member.

        Args:
            gaze_map: GM (tilts, pans).
            pan: present gaze [rad].
            tilt: present gaze [rad].

        Returns:
            Pan and tilt [rad]; the present gaze if GM is zero everywhere.
        """
        top = float(gaze_map.max())
        if top <= 0.0:
            return pan, tilt
        labels, count = ndimage.label(gaze_map >= top - _FLAT * max(1.0, top))
        sizes = np.bincount(labels.ravel())[1:]
        best: tuple[float, float, int] | None = None
        for label in range(1, count + 1):
            if sizes[label - 1] < sizes.max():
                continue
            row, column = self._centre(labels == label)
            distance = abs(self.pan[column] - pan) + abs(self.tilt[row] - tilt)
            key = (round(float(distance), 9), float(self.pan[column]), row)
            if best is None or key < best:
                best = key
        assert best is not None
        return best[1], float(self.tilt[best[2]])

    def _centre(self, member: NDArray[np.bool_]) -> tuple[int, int]:
        rows, columns = np.nonzero(member)
        centre_row, centre_column = float(rows.mean()), float(columns.mean())
        row, column = round(centre_row), round(centre_column)
        if member[row, column]:
            return row, column
        nearest = int(np.argmin((rows - centre_row) ** 2 + (columns - centre_column) ** 2))
        return int(rows[nearest]), int(columns[nearest])

    def _cell(self, pan: float, tilt: float) -> tuple[int, int]:
        row = round((tilt - float(self.tilt[0])) / self._step)
        column = round((pan - float(self.pan[0])) / self._step)
        return (
            min(max(row, 0), len(self.tilt) - 1),
            min(max(column, 0), len(self.pan) - 1),
        )
