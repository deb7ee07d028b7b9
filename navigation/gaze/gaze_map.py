"""The gaze map GM over pan and tilt, Yoo & Kim, eqs. (5) and (6)."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from compilation.value import value
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

_FLAT = 1e-9
"""Relative difference from the maximum within which cells belong to the top plateau."""


@value
class Votes:
    """Weighted directions of requested looks.

    Attributes:
        pan, tilt: candidate directions (n,) [rad].
        value: weight times partial evaluation (n,).
    """

    pan: Array
    tilt: Array
    value: Array

    @classmethod
    def one(cls, pan: float, tilt: float, value: float) -> "Votes":
        """Return a single vote."""
        return cls(np.array([pan]), np.array([tilt]), np.array([value]))

    @classmethod
    def join(cls, parts: list["Votes"]) -> "Votes":
        """Concatenate votes."""
        if not parts:
            return cls(np.zeros(0), np.zeros(0), np.zeros(0))
        return cls(
            np.concatenate([p.pan for p in parts]),
            np.concatenate([p.tilt for p in parts]),
            np.concatenate([p.value for p in parts]),
        )


class GazeGrid:
    """Cells of gaze angles and the boxes in which a vote counts.

    Boxes in pan and tilt approximate the view of a pinhole camera. They serve for votes only;
    visibility is computed by projection.

    Attributes:
        pan, tilt: centres of the columns and rows [rad].
    """

    def __init__(
        self, parameters: GazeParameters, horizontal_fov: float, vertical_fov: float
    ) -> None:
        """Build the grid.

        Args:
            parameters: limits of the gaze, resolution and size of the boxes.
            horizontal_fov: horizontal field of view of the camera [rad].
            vertical_fov: vertical field of view of the camera [rad].
        """
        p = parameters
        self._step = p.step
        columns = int(p.max_pan / p.step + _FLAT)
        self.pan: Array = p.step * np.arange(-columns, columns + 1, dtype=np.float64)
        lowest, highest = (p.min_tilt, p.max_tilt) if p.moved_by == "head" else (p.fixed_tilt,) * 2
        rows = int((highest - lowest) / p.step + _FLAT) + 1
        self.tilt: Array = lowest + p.step * np.arange(rows, dtype=np.float64)
        self._half_pan = p.box_fraction * horizontal_fov
        self._half_tilt = p.box_fraction * vertical_fov

    def gaze_map(self, votes: Votes) -> Array:
        """Return GM (tilts, pans), the sum of the regions R(theta_k) of all votes.

        Sources: Yoo & Kim, eqs. (5) and (6); the weights of (6) are in the values of the votes.
        """
        pans = np.abs(self.pan - votes.pan[:, None]) <= self._half_pan + _FLAT
        tilts = np.abs(self.tilt - votes.tilt[:, None]) <= self._half_tilt + _FLAT
        total: Array = (tilts * votes.value[:, None]).T @ pans.astype(np.float64)
        return total

    def value_at(self, gaze_map: Array, pan: float, tilt: float) -> float:
        """Return GM of the cell nearest to the gaze (pan, tilt) [rad]."""
        row, column = self._cell(pan, tilt)
        return float(gaze_map[row, column])

    def highest_centre(self, gaze_map: Array, pan: float, tilt: float) -> tuple[float, float]:
        """Return theta*, the centre of the largest plateau of maximum GM.

        Of plateaus of equal size the one nearest to the present gaze wins, then the smaller pan.
        If the centroid is outside its plateau, the nearest member replaces it.

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
