"""Settings of the detector."""

from dataclasses import dataclass, field
from typing import Annotated

from annotated_types import Ge, Gt, Interval


@dataclass(frozen=True)
class PoseParameters:
    """How well the body knows where its camera is: measured while walking, noise and all."""

    tilt_sigma: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.0009
    """Standard deviation of the camera's pitch [rad]."""
    roll_sigma: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.0008
    """Standard deviation of its roll [rad]."""
    yaw_sigma: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.0005
    """Standard deviation of its direction from the robot's heading [rad]."""
    height_sigma: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.0003
    """Standard deviation of its height [m]."""


@dataclass(frozen=True)
class SplitParameters:
    """Blobs that one obstacle does not explain, told apart into several."""

    extra_radius: Annotated[float, Ge(0.0)] = 0.04
    """A foot and a head match if the cylinder between is thicker or thinner by so much [m]."""
    side_match: Annotated[float, Gt(0.0)] = 2.5
    """The same if their sides differ by so much [column]."""
    side_sigma: Annotated[float, Gt(0.0)] = 1.0
    """Standard deviation of an end of a piece of the outline [column]."""
    extra_misfit: Annotated[float, Ge(1.0)] = 2.0
    """A part may misfit so many times more than a whole blob [1]."""
    slack: Annotated[float, Ge(0.0)] = 0.3
    """Its radius may lie beyond those of obstacles by such a share of their range [1]."""
    shared: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.85
    """Parts whose axes are nearer than this share of the sum of their radii are one [1]."""


@dataclass(frozen=True)
class VisionParameters:
    """What the robot knows of the things it looks for, and how much it trusts pixels."""

    color_table: str = ""
    """File of a colour table, from `hsr8 colours`; the declared colours if empty."""
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
    obstacle_range: Annotated[float, Gt(0.0)] = 4.5
    """Obstacles farther than this are not reported [m]."""
    beacon_range: Annotated[float, Gt(0.0)] = 5.5
    """Beacons farther than this are not reported [m]."""
    min_area: Annotated[int, Ge(1)] = 20
    """Smallest blob taken for an obstacle [pixel]."""
    min_beacon_area: Annotated[int, Ge(1)] = 5
    """Smallest blob taken for one colour of a beacon [pixel]."""
    edge_sigma: Annotated[float, Gt(0.0)] = 0.30
    """Standard deviation of one point of an edge of a blob [pixel]."""
    edge_correlation: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.02
    """Correlation of the errors of two points of one edge [1]."""
    roundness_sigma: Annotated[float, Ge(0.0)] = 0.008
    """Standard deviation of a cylinder's outline, relative to its radius [1]."""
    step: Annotated[float, Gt(0.0)] = 2.5
    """Jump of an outline that separates two cylinders; half of it makes a rim point stray
    [pixel]."""
    max_misfit: Annotated[float, Gt(0.0)] = 16.0
    """Sum of squared normalised residuals above which a blob is not one cylinder [1]."""
    astray: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.2
    """Share of the points of a rim off that of one cylinder above which it is not one [1]."""
    doubt: Annotated[float, Ge(1.0)] = 4.0
    """The covariance of what is not explained grows at least so many times [1]."""
    covered: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.1
    """Share of a rim next to another colour above which a thing counts as occluded [1]."""
    max_relative_sigma: Annotated[float, Gt(0.0)] = 0.35
    """Detections whose distance is less certain, relative to itself, are dropped [1]."""
    beacon_radius_sigma: Annotated[float, Gt(0.0)] = 0.0005
    """Standard deviation of a beacon's radius [m]."""
    beacon_seam: Annotated[float, Interval(ge=0.0, le=1.0)] = 0.6
    """Least share of the upper colour's width that rests on the lower one [1]."""
    beacon_sides: Annotated[float, Gt(0.0)] = 4.0
    """Largest difference of the sides of the two colours, in standard deviations [1]."""
    beacon_misfit: Annotated[float, Ge(1.0)] = 5.0
    """A beacon may misfit so many times more than an obstacle [1]."""
    split: SplitParameters = field(default_factory=SplitParameters)
    """Blobs that are several obstacles."""
    pose: PoseParameters = field(default_factory=PoseParameters)
    """Uncertainty of the camera's pose."""
