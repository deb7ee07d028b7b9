"""Paired comparison of a quantity measured twice on the same seeds."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RESAMPLES = 10_000
BATCH = 2_000_000  # numbers resampled at a time, which bounds the memory
Z = 1.959963984540054  # quantile of a two-sided 95 % interval


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """Difference over common seeds, in the unit of the quantity.

    Attributes:
        test: "McNemar" for proportions, else "Wilcoxon".
        n: number of seeds.
        a, b: proportion or mean.
        difference: b - a.
        low, high: its 95 % interval.
        p_value: two-sided.
    """

    test: str
    n: int
    a: float
    b: float
    difference: float
    low: float
    high: float
    p_value: float

    def points(self) -> str:
        """Return the difference in points, for example ``-12.0 [-20.1, -3.9], p 0.004``."""
        low, high = 100.0 * self.low, 100.0 * self.high
        return f"{100.0 * self.difference:+.1f} [{low:+.1f}, {high:+.1f}], p {self.p_value:.2g}"


def compare_values(a: Array, b: Array) -> PairedDifference:
    """Compare numbers (n,) in the same order by the Wilcoxon signed-rank test; deterministic.

    The interval is a percentile bootstrap of the pairs.

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
    means = float(a.mean()), float(b.mean())
    return PairedDifference("Wilcoxon", len(a), *means, mean, low, high, p)


def compare_successes(a: Sequence[bool], b: Sequence[bool]) -> PairedDifference:
    """Compare proportions of successes, at least one, by the exact McNemar test.

    The interval is the adjusted Wald interval (Bonett and Price 2012).
    """
    from scipy.stats import binomtest  # noqa: PLC0415  takes a second

    pairs = list(zip(a, b, strict=True))
    n, only_a, only_b = len(pairs), pairs.count((True, False)), pairs.count((False, True))
    p = float(binomtest(only_b, only_a + only_b).pvalue) if only_a + only_b else 1.0
    x, y = (only_a + 1) / (n + 2), (only_b + 1) / (n + 2)
    half = Z * sqrt(max(0.0, x + y - (y - x) ** 2) / (n + 2))
    low, high = max(-1.0, y - x - half), min(1.0, y - x + half)
    difference = (only_b - only_a) / n
    return PairedDifference("McNemar", n, sum(a) / n, sum(b) / n, difference, low, high, p)
