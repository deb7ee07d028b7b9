"""Paired comparison of two proportions counted on the same seeds."""

from dataclasses import dataclass
from math import sqrt

Z = 1.959963984540054  # quantile of a two-sided 95 % interval


@dataclass(frozen=True, slots=True)
class PairedOutcomes:
    """Successes of A and B on the same seeds.

    Attributes:
        both, only_a, only_b, neither: number of seeds by who succeeded.
    """

    both: int
    only_a: int
    only_b: int
    neither: int

    @classmethod
    def count(cls, a: list[bool], b: list[bool]) -> "PairedOutcomes":
        """Count the seeds; `a` and `b` are in the same order."""
        pairs = list(zip(a, b, strict=True))
        return cls(
            both=pairs.count((True, True)),
            only_a=pairs.count((True, False)),
            only_b=pairs.count((False, True)),
            neither=pairs.count((False, False)),
        )

    @property
    def n(self) -> int:
        """Number of seeds."""
        return self.both + self.only_a + self.only_b + self.neither

    @property
    def difference(self) -> float:
        """Proportion of B minus proportion of A."""
        return (self.only_b - self.only_a) / self.n if self.n else 0.0

    def p_value(self) -> float:
        """Return the p value of the exact two-sided McNemar test."""
        from scipy.stats import binomtest  # noqa: PLC0415  takes a second

        discordant = self.only_a + self.only_b
        return float(binomtest(self.only_b, discordant).pvalue) if discordant else 1.0

    def interval(self) -> tuple[float, float]:
        """Return the 95 % interval of the difference (Bonett and Price 2012, adjusted Wald)."""
        a, b = (self.only_a + 1) / (self.n + 2), (self.only_b + 1) / (self.n + 2)
        half = Z * sqrt(max(0.0, a + b - (b - a) ** 2) / (self.n + 2))
        return max(-1.0, b - a - half), min(1.0, b - a + half)
