"""How much the Rerun log of a run holds."""

from dataclasses import dataclass
from enum import StrEnum


class LogLevel(StrEnum):
    """Amount of a log: poses and curves; what people look at; everything."""

    MINIMAL = "minimal"
    STANDARD = "standard"
    FULL = "full"


@dataclass(frozen=True, slots=True)
class LogRates:
    """What a level logs, and how often at most.

    Attributes:
        pose: time between two poses and points of curves [s].
        frame: time between two camera frames [s].
        map: time between two local maps, clouds of particles and planner's fields [s].
        jpeg: quality of the images, 0 for neither images nor beliefs [%].
    """

    pose: float
    frame: float
    map: float
    jpeg: int

    @property
    def pictures(self) -> bool:
        """Whether there are images, beliefs and plans."""
        return self.jpeg > 0


RATES = {
    LogLevel.MINIMAL: LogRates(pose=0.06, frame=0.18, map=0.0, jpeg=0),
    LogLevel.STANDARD: LogRates(pose=0.06, frame=0.18, map=1.0, jpeg=75),
    LogLevel.FULL: LogRates(pose=0.0, frame=0.0, map=0.0, jpeg=90),
}
