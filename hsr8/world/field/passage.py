"""One way across the field: a mover that waits, goes straight on, and stays where it arrives."""

from dataclasses import dataclass
from math import hypot

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Passage:
    """Straight from one point to another at constant speed, once.

    Attributes:
        start: where it stands until it departs [m].
        end: where it stays [m].
        speed: [m/s].
        depart: when it begins to move [s].
    """

    start: Point
    end: Point
    speed: float
    depart: float = 0.0

    @property
    def length(self) -> float:
        """Distance from `start` to `end` [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        gone = self.speed * (time - self.depart)
        share = min(max(gone / self.length, 0.0), 1.0)
        return (
            self.start[0] + share * (self.end[0] - self.start[0]),
            self.start[1] + share * (self.end[1] - self.start[1]),
        )

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]; at an end, the one it goes on with."""
        gone, length = self.speed * (time - self.depart), self.length
        if not 0.0 <= gone < length:
            return 0.0, 0.0
        rate = self.speed / length
        return rate * (self.end[0] - self.start[0]), rate * (self.end[1] - self.start[1])
