"""Statistics: sums in a fixed order, proportions, efficiency, differences on common seeds."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

RESAMPLES = 10_000
BATCH = 2_000_000  # numbers resampled at a time, which bounds the memory
Z = 1.959963984540054  # quantile of a two-sided 95 % interval


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


def holm(p_values: Sequence[float]) -> list[float]:
    """Return p-values of several tests, corrected by the step-down method of Holm (1979)."""
    corrected, floor, n = [0.0] * len(p_values), 0.0, len(p_values)
    for rank, k in enumerate(sorted(range(n), key=p_values.__getitem__)):
        corrected[k] = floor = max(floor, min(1.0, (n - rank) * p_values[k]))
    return corrected


@dataclass(frozen=True, slots=True)
class Proportion:
    """Proportion of `count` in `n` with its 95 % Wilson score interval."""

    count: int
    n: int
    fraction: float
    low: float
    high: float

    @classmethod
    def counted(cls, count: int, n: int) -> "Proportion":
        """Return the proportion; without any run the interval is 0 to 1."""
        if n == 0:
            return cls(0, 0, 0.0, 0.0, 1.0)
        from scipy.stats import binomtest  # noqa: PLC0415  takes a second

        interval = binomtest(count, n).proportion_ci(method="wilson")
        return cls(count, n, count / n, float(interval.low), float(interval.high))

    def __str__(self) -> str:
        """Return for example ``19 of 20, 95.0 % (76.4 to 99.1 %)``."""
        if self.n == 0:
            return "none"
        interval = f"{100 * self.low:.1f} to {100 * self.high:.1f} %"
        return f"{self.count} of {self.n}, {100 * self.fraction:.1f} % ({interval})"


def spl(success: bool, shortest: float, actual: float) -> float:
    """Return success weighted by the path length (Anderson et al. 2018), from 0 to 1.

    With times in place of lengths it is success weighted by time (SPT).

    Args:
        success: whether the run succeeded.
        shortest: length of the shortest path, positive.
        actual: length of the path of the run, in the same unit.
    """
    return shortest / max(shortest, actual) if success else 0.0


def optimal_time_ratio(success: bool, shortest: float, actual: float) -> float:
    """Return success times shortest over actual time, without an upper bound.

    It is the metric of the BARN challenge without its clipping.

    Args:
        success: whether the run succeeded.
        shortest: shortest time [s].
        actual: time of the run, positive if it succeeded [s].
    """
    return shortest / actual if success else 0.0
