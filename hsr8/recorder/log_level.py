"""Levels of detail of the Rerun log."""

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
        jpeg: quality of the images, 0 for neither images nor beliefs [%].
    """

    pose: float
    frame: float
    jpeg: int


RATES = {
    LogLevel.MINIMAL: LogRates(pose=0.06, frame=0.18, jpeg=0),
    LogLevel.STANDARD: LogRates(pose=0.06, frame=0.18, jpeg=75),
    LogLevel.FULL: LogRates(pose=0.0, frame=0.0, jpeg=90),
}
