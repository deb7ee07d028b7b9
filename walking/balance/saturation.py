"""Small nonlinear functions of a scalar."""


def beyond(value: float, zone: float) -> float:
    """What exceeds a dead zone of ±`zone`, zero inside it."""
    if value > zone:
        return value - zone
    if value < -zone:
        return value + zone
    return 0.0
