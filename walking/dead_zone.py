"""A dead zone: what is small does not count, and what is large counts by its excess."""


def dead_zone(value: float, zone: float) -> float:
    """What exceeds a dead zone of ±`zone`, zero inside it."""
    if value > zone:
        return value - zone
    if value < -zone:
        return value + zone
    return 0.0
