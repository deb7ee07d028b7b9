"""Sole of a foot."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sole:
    """Rectangle of a sole in the foot frame.

    Attributes:
        centre: middle of the sole ahead of the ankle [m].
        half_length: half of its length [m].
        half_width: half of its width [m].
    """

    centre: float
    half_length: float
    half_width: float
