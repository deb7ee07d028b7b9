"""Two shares counted on the same seeds."""

from dataclasses import dataclass
from math import sqrt

from scipy.stats import binomtest

from hsr8.evaluation.wilson import Z


@dataclass(frozen=True, slots=True)
class PairedShares:
    """What changed from A to B, seed by seed.

    Attributes:
        both, only_a, only_b, neither: seeds by where they succeeded.
    """

    both: int
    only_a: int
    only_b: int
    neither: int

    @classmethod
    def count(cls, a: list[bool], b: list[bool]) -> "PairedShares":
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
        """Share of B minus share of A."""
        return (self.only_b - self.only_a) / self.n if self.n else 0.0

    def p_value(self) -> float:
        """Exact two-sided McNemar test: of the seeds that changed, half should go either way."""
        changed = self.only_a + self.only_b
        return float(binomtest(self.only_b, changed).pvalue) if changed else 1.0

    def interval(self) -> tuple[float, float]:
        """95 % interval of the difference (Bonett and Price 2012, adjusted Wald)."""
        a, b = (self.only_a + 1) / (self.n + 2), (self.only_b + 1) / (self.n + 2)
        half = Z * sqrt(max(0.0, a + b - (b - a) ** 2) / (self.n + 2))
        return max(-1.0, b - a - half), min(1.0, b - a + half)
