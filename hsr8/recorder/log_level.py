"""Levels of detail of the Rerun log, and of the images that a run keeps."""

from dataclasses import dataclass
from enum import StrEnum


class LogLevel(StrEnum):
    """Level of a log: poses and curves; also images and beliefs; every record and frame."""

    MINIMAL = "minimal"
    STANDARD = "standard"
    FULL = "full"


@dataclass(frozen=True, slots=True)
class LogRates:
    """Minimum intervals of a level.

    Attributes:
        pose: between two poses and points of curves [s].
        frame: between two camera frames [s].
        belief: whether images and beliefs are shown.
    """

    pose: float
    frame: float
    belief: bool


RATES = {
    LogLevel.MINIMAL: LogRates(pose=0.06, frame=0.18, belief=False),
    LogLevel.STANDARD: LogRates(pose=0.06, frame=0.18, belief=True),
    LogLevel.FULL: LogRates(pose=0.0, frame=0.0, belief=True),
}


@dataclass(frozen=True, slots=True)
class ImageRates:
    """Images of the head camera that a run keeps.

    Attributes:
        period: minimum interval between two images [s].
        quality: quality of the compression [%].
    """

    period: float
    quality: int


IMAGES = {"none": None, "standard": ImageRates(0.18, 75), "full": ImageRates(0.0, 90)}
"""Rates by the scenario's key ``recorder.images``."""
