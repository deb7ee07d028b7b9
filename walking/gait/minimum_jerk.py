"""Motion of minimum jerk, at rest at both ends (Flash & Hogan 1985)."""

PEAK = 1.875  # its peak speed over its mean [1]


def minimum_jerk(share: float) -> float:
    """Share of the way after a share of the time [1]."""
    s = min(1.0, max(0.0, share))
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))
