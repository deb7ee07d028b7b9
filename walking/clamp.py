"""Saturation and dead zone of a scalar."""

from compilation import compiled


@compiled
def clamp(value: float, limit: float) -> float:
    """Clip a value to ±`limit`."""
    return min(limit, max(-limit, value))


@compiled
def dead_zone(value: float, zone: float) -> float:
    """Return the excess of a value over a dead zone of ±`zone`, zero inside it."""
    if value > zone:
        return value - zone
    if value < -zone:
        return value + zone
    return 0.0
