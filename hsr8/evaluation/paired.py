"""A quantity measured twice on the same seeds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import wilcoxon

Array = NDArray[np.float64]

RESAMPLES = 10_000


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """B minus A over common seeds, in the quantity's unit.

    Attributes:
        n: seeds on which both were measured.
        mean_a, mean_b: means over these seeds.
        mean: mean difference.
        low, high: its 95 % interval, by a paired percentile bootstrap.
        p_value: of the Wilcoxon signed-rank test, two-sided; 1 where nothing differs.
    """

    n: int
    mean_a: float
    mean_b: float
    mean: float
    low: float
    high: float
    p_value: float


def compare_paired(a: Array, b: Array) -> PairedDifference:
    """Compare `a` and `b` (n,), in the same order; always the same answer for the same numbers.

    Raises:
        ValueError: they are empty, not as long as each other, or not finite.
    """
    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.ndim != 1 or a.shape != b.shape or len(a) == 0:
        raise ValueError(f"two rows of equal length are needed, got {a.shape} and {b.shape}")
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("numbers must be finite")
    difference = b - a
    low, high = _bootstrap(difference)
    p = float(wilcoxon(difference).pvalue) if difference.any() else 1.0
    return PairedDifference(
        len(a), float(a.mean()), float(b.mean()), float(difference.mean()), low, high, p
    )


def _bootstrap(values: Array) -> tuple[float, float]:
    """95 % percentile interval of the mean; drawn in slices, for memory."""
    rng = np.random.default_rng(0)
    n = len(values)
    piece = max(1, 2_000_000 // n)
    means = [
        values[rng.integers(0, n, (min(piece, RESAMPLES - done), n))].mean(axis=1)
        for done in range(0, RESAMPLES, piece)
    ]
    low, high = np.quantile(np.concatenate(means), (0.025, 0.975)).tolist()
    return float(low), float(high)
