"""Parameters of the detector."""

from dataclasses import dataclass, field
from typing import Annotated

from annotated_types import Interval, doc

Sigma = Annotated[float, Interval(ge=0.0, le=1.0)]


@dataclass(frozen=True)
class PoseParameters:
    """Uncertainty of the camera pose from the robot's kinematics and IMU while walking."""

    tilt_sigma: Annotated[Sigma, doc("Standard deviation of the camera's pitch [rad].")] = 0.0009
    roll_sigma: Annotated[Sigma, doc("Standard deviation of its roll [rad].")] = 0.0008
    yaw_sigma: Annotated[
        Sigma, doc("Standard deviation of its yaw relative to the robot's heading [rad].")
    ] = 0.0005
    height_sigma: Annotated[Sigma, "m", doc("Standard deviation of its height [m].")] = 0.0003


@dataclass(frozen=True)
class SplitParameters:
    """Segmentation of merged blobs."""

    # Change of distance at the step of an outline that separates two cylinders.
    min_gap: Annotated[float, "m"] = 0.03
    side_sigma: float = 1.0  # standard deviation of an end of a piece of the outline [column]
    radius_margin: float = 0.3  # excess of a part's radius, relative to the range of radii [1]
    # Distance of two axes, relative to the sum of the radii, below which two parts are one [1].
    min_separation: float = 0.85


@dataclass(frozen=True)
class VisionParameters:
    """Error models and thresholds; the sizes of obstacles and beacons are those of the world."""

    color_table: Annotated[
        str,
        doc(
            "File of a colour table made by `hsr8 color-table`; empty: the built-in colour classes."
        ),
    ] = ""
    max_obstacle_range: Annotated[
        float,
        Interval(ge=0.001, le=100.0),
        "m",
        doc("Maximum distance of a reported obstacle [m]."),
    ] = 4.5
    max_beacon_range: Annotated[
        float, Interval(ge=0.001, le=100.0), "m", doc("Maximum distance of a reported beacon [m].")
    ] = 5.5
    unit: Annotated[float, "m"] = 1.0  # of the bounds of the fit of a cylinder
    min_area: int = 20  # minimum area of an obstacle's blob [pixel]
    min_beacon_area: int = 5  # minimum area of the blob of one colour of a beacon [pixel]
    edge_sigma: float = 0.30  # standard deviation of an edge point [pixel]
    edge_correlation: float = 0.02  # correlation of the errors of two points of one edge [1]
    roundness_sigma: float = 0.008  # standard deviation of a cylinder's outline / radius [1]
    # Step of an outline that separates two cylinders; half of it makes a rim point an outlier.
    outline_step: float = 2.5  # [pixel]
    max_misfit: float = 16.0  # maximum sum of squared normalized residuals of one cylinder [1]
    max_outlier_fraction: float = 0.2  # maximum fraction of outliers among a rim's points [1]
    covariance_inflation: float = 4.0  # minimum inflation for a blob that no cylinder explains [1]
    max_occlusion_fraction: float = 0.1  # of a rim next to another colour: more is occluded [1]
    max_relative_sigma: float = 0.35  # maximum standard deviation of a distance / distance [1]
    known_radius_sigma: Annotated[float, "m"] = 0.0005  # standard deviation of a known radius
    min_beacon_seam_fraction: float = 0.6  # minimum width of the seam / width of the upper colour
    beacon_side_tolerance: float = 4.0  # difference of the two colours' sides [sigma]
    beacon_misfit_factor: float = 5.0  # max_misfit of a beacon relative to that of an obstacle [1]
    split: SplitParameters = field(default_factory=SplitParameters)
    """Segmentation of merged blobs."""
    pose: Annotated[PoseParameters, doc("Uncertainty of the camera pose.")] = field(
        default_factory=PoseParameters
    )
