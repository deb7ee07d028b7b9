"""Sizes of the obstacles and beacons in a world, which the robot knows."""

from dataclasses import dataclass
from math import sqrt

Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Sizes:
    """Sizes of obstacles and beacons: upright cylinders.

    Attributes:
        obstacle_height: minimum and maximum height of an obstacle [m].
        obstacle_radius: minimum and maximum radius of an obstacle [m].
        beacon_height: height of a beacon, whose two colours meet in the middle [m].
        beacon_radius: radius of a beacon [m].
    """

    obstacle_height: Range = (0.30, 0.30)
    obstacle_radius: Range = (0.05, 0.12)
    beacon_height: float = 0.60
    beacon_radius: float = 0.05

    @property
    def top(self) -> float:
        """Maximum height of an obstacle [m]."""
        return self.obstacle_height[1]

    @property
    def height_sigma(self) -> float:
        """Standard deviation of the uniform prior of an obstacle's height [m]."""
        low, high = self.obstacle_height
        return (high - low) / sqrt(12.0)

    @property
    def radius_prior(self) -> Range:
        """Mean and standard deviation of the uniform prior of an obstacle's radius [m]."""
        low, high = self.obstacle_radius
        return 0.5 * (low + high), (high - low) / sqrt(12.0)
