"""Settings of the detector."""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Gt


@dataclass(frozen=True)
class VisionParameters:
    """What the robot knows of the things it looks for, and how much it trusts pixels."""

    obstacle_height: Annotated[float, Gt(0.0)] = 0.30
    """Height of every obstacle [m]."""
    min_radius: Annotated[float, Gt(0.0)] = 0.05
    """Smallest radius of an obstacle [m]."""
    max_radius: Annotated[float, Gt(0.0)] = 0.12
    """Largest radius of an obstacle [m]."""
    beacon_height: Annotated[float, Gt(0.0)] = 0.60
    """Height of a beacon; its two colours meet in the middle [m]."""
    beacon_radius: Annotated[float, Gt(0.0)] = 0.05
    """Radius of a beacon [m]."""
    obstacle_range: Annotated[float, Gt(0.0)] = 3.5
    """Obstacles farther than this are not reported [m]."""
    beacon_range: Annotated[float, Gt(0.0)] = 5.5
    """Beacons farther than this are not reported [m]."""
    min_area: Annotated[int, Ge(1)] = 20
    """Smallest blob taken for an obstacle [pixel]."""
    min_beacon_area: Annotated[int, Ge(1)] = 5
    """Smallest blob taken for one colour of a beacon [pixel]."""
    edge_sigma: Annotated[float, Gt(0.0)] = 0.35
    """Standard deviation of one edge of a blob [pixel]."""
    roundness_sigma: Annotated[float, Ge(0.0)] = 0.01
    """Standard deviation of a cylinder's outline, relative to its radius [1]."""
    step: Annotated[float, Gt(0.0)] = 2.5
    """An outline that leaves one cylinder's by so much shows another cylinder [pixel]."""
    max_misfit: Annotated[float, Gt(0.0)] = 8.0
    """Sum of squared normalised residuals above which a blob is not one cylinder [1]."""
    max_relative_sigma: Annotated[float, Gt(0.0)] = 0.35
    """Detections whose distance is less certain, relative to itself, are dropped [1]."""
