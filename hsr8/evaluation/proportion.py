"""A counted proportion with its confidence interval."""

from dataclasses import dataclass


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
