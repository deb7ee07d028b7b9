"""Paired comparison of a quantity measured twice on the same seeds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RESAMPLES = 10_000
BATCH = 2_000_000  # numbers resampled at a time, which bounds the memory


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """B minus A over common seeds, in the quantity's unit.

    Attributes:
        n: number of seeds.
        mean_a, mean_b: means over these seeds.
        mean: mean difference.
        low, high: its 95 % interval, paired percentile bootstrap.
        p_value: Wilcoxon signed-rank test, two-sided; 1 without any difference.
    """

    n: int
    mean_a: float
    mean_b: float
    mean: float
    low: float
    high: float
    p_value: float


def compare_paired(a: Array, b: Array) -> PairedDifference:
    """Compare `a` and `b` (n,), in the same order; deterministic.

    Raises:
        ValueError: they are empty, differ in length, or are not finite.
    """
    from scipy.stats import bootstrap, wilcoxon  # noqa: PLC0415  takes a second

    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.ndim != 1 or a.shape != b.shape or len(a) == 0:
        raise ValueError(f"expected two arrays of equal length, got {a.shape} and {b.shape}")
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("numbers must be finite")
    difference = b - a
    low = high = mean = float(difference.mean())
    if len(difference) > 1:
        interval = bootstrap(
            (difference,),
            np.mean,
            n_resamples=RESAMPLES,
            batch=max(1, BATCH // len(difference)),
            method="percentile",
            rng=np.random.default_rng(0),
        ).confidence_interval
        low, high = float(interval.low), float(interval.high)
    p = float(wilcoxon(difference).pvalue) if difference.any() else 1.0
    return PairedDifference(len(a), float(a.mean()), float(b.mean()), mean, low, high, p)
