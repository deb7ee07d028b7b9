"""Sums in a fixed order, so that equal runs have equal results to the last bit."""

from math import sqrt

import numpy as np
from numpy.typing import ArrayLike


def total(values: ArrayLike) -> float:
    """Return the sum of values (n,), added one after the other."""
    sums = np.cumsum(np.asarray(values, dtype=np.float64))
    return float(sums[-1]) if len(sums) else 0.0


def mean(values: ArrayLike) -> float | None:
    """Return the mean of values (n,); None without values."""
    n = np.size(values)
    return total(values) / n if n else None


def root_mean(squares: ArrayLike) -> float | None:
    """Return the root of the mean of squares (n,); None without values."""
    square = mean(squares)
    return None if square is None else sqrt(square)
