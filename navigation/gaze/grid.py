"""Grid of gaze angles: the directions that the gaze can choose."""

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

ROUNDING = 1e-9  # of the number of steps [1]


@value
class GazeGrid:
    """Centres of the cells of a gaze map, its columns and rows.

    Attributes:
        pan: pans, symmetric about straight ahead (n,) [rad].
        tilt: tilts from low to high, a single one for a camera without a neck (m,) [rad].
        step: distance of the centres [rad].
    """

    pan: Array
    tilt: Array
    step: float

    @classmethod
    def of(cls, parameters: GazeParameters) -> "GazeGrid":
        """Fill the limits of the gaze."""
        p = parameters
        columns = int(p.max_pan / p.step + ROUNDING)
        pan = p.step * np.arange(-columns, columns + 1, dtype=np.float64)
        lowest, highest = (p.min_tilt, p.max_tilt) if p.moved_by == "head" else (p.fixed_tilt,) * 2
        rows = int((highest - lowest) / p.step + ROUNDING) + 1
        return cls(pan, lowest + p.step * np.arange(rows, dtype=np.float64), p.step)
