"""Density of undetected obstacles on the ground around the robot.

Movers that were never detected drift through the ground that the robot does not see. Their
density by cell and direction of motion moves with them and falls where a frame shows the ground.
"""

from math import pi

import numpy as np
from numpy.typing import NDArray

from navigation.belief.local_map import LocalMap, shifted
from navigation.gaze import undetected_kernel
from navigation.parameters.risk import RiskParameters, UndetectedParameters

Array = NDArray[np.float64]


class Undetected:
    """Densities on the cells of the local map.

    Args:
        parameters: densities, speed and headings.
        local_map: whose cells it shares.
        time: [s].
    """

    def __init__(self, parameters: UndetectedParameters, local_map: LocalMap, time: float) -> None:
        p = self._parameters = parameters
        angles = 2.0 * pi * np.arange(p.headings) / p.headings
        self._velocities = p.speed * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        self._cell = local_map.cell
        self._corner = _corner(local_map)
        shape = local_map.age.shape
        self._new = p.movers / p.headings
        self._movers = np.full((p.headings, *shape), self._new)
        self._static = np.full(shape, p.static)
        self._drift = np.zeros((p.headings, 2))  # not yet a whole cell [cells]
        self._time = time

    def update(self, local_map: LocalMap, time: float) -> None:
        """Move the densities to `time` [s] and reduce them in the cells of the latest frame."""
        corner = _corner(local_map)
        self._drift += self._velocities * ((time - self._time) / self._cell)
        whole = np.round(self._drift).astype(int)
        self._drift -= whole
        self._time = time
        scroll, self._corner = corner - self._corner, corner
        for movers, move in zip(self._movers, scroll - whole, strict=True):
            columns, rows = move.tolist()
            movers[:] = shifted(movers, rows, columns, self._new)
        columns, rows = scroll.tolist()
        self._static = shifted(self._static, rows, columns, self._parameters.static)
        in_view = local_map.age <= 0.0
        undetected_kernel.see(self._movers, self._static, in_view, self._parameters.missed)

    def risks(self, position: Array, velocity: Array, parameters: RiskParameters) -> Array:
        """Return position in W [m] and risk of the cells around the robot (m, 3).

        Args:
            position: of the robot in W (2,) [m].
            velocity: of the robot in W (2,) [m/s].
            parameters: urgency.
        """
        p, r = self._parameters, parameters
        limits = (p.reach, p.gap, p.max_time, p.min_time, p.time, r.max_urgency, r.exponent)
        return undetected_kernel.risks(
            self._movers,
            self._static,
            self._velocities,
            np.array([*(self._corner * self._cell), self._cell]),
            np.concatenate([position, velocity]),
            np.array([*limits, p.walking_weight]),
        )


def _corner(local_map: LocalMap) -> NDArray[np.int64]:
    """Index of the first column and row, counted from the origin of W (2,)."""
    return np.round(np.array(local_map.origin) / local_map.cell).astype(np.int64)
