"""Types of arrays, points and vectors."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Point = tuple[float, float]
Vector = tuple[float, float, float]
