"""Parameters of the belief: localization, tracking and local map."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

import numpy as np
from annotated_types import Interval, doc
from numpy.typing import NDArray

from navigation.parameters.bounds import NonNegative, Positive

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LocalizationParameters:
    """Kalman filter of the robot's pose."""

    landmarks: Annotated[
        Literal["known", "mapped"],
        doc(
            "known: beacons at known positions; mapped: static obstacles, mapped while walking "
            "(SLAM)."
        ),
    ] = "known"
    # process noise of the position on top of the odometry's
    drift: Annotated[float, "m/s^0.5"] = 0.0001
    # the same of the heading [rad/√s]
    heading_drift: Annotated[float, "1/s^0.5"] = 0.0001
    gate: float = 13.8  # chi-square gate of a beacon detection: squared Mahalanobis distance [1]
    lost_rejections: int = 8  # successive rejected detections, of two or more beacons: lost
    lost_time: float = 2.0  # duration of such a run with one beacon only: lost [s]
    displaced_rejections: int = 10  # successive frames that contradict one beacon only: displaced
    lost_sigma: Annotated[float, "m"] = 1.0  # standard deviation of the position while lost
    lost_heading_sigma: float = 1.0  # standard deviation of the heading while lost [rad]
    # standard deviation of the position after recovery, and its maximum residual
    recovery_sigma: Annotated[float, "m"] = 0.15
    recovery_heading_sigma: float = 0.15  # standard deviation of the heading after recovery [rad]
    recovery_window: Annotated[float, "s"] = 6.0  # maximum age of a detection used for recovery

    def drift_rate(self) -> Array:
        """Return the rate of the covariance by drift (3, 3) [m²/s, rad²/s]."""
        return np.diag(np.square([self.drift, self.drift, self.heading_drift]))

    def lost_covariance(self) -> Array:
        """Return the covariance of the pose while lost (3, 3) [m², rad²]."""
        return np.diag(np.square([self.lost_sigma, self.lost_sigma, self.lost_heading_sigma]))

    def recovery_covariance(self) -> Array:
        """Return the covariance of the pose after recovery (3, 3) [m², rad²]."""
        sigma = self.recovery_sigma
        return np.diag(np.square([sigma, sigma, self.recovery_heading_sigma]))


@dataclass(frozen=True)
class MappingParameters:
    """Data association of mapped landmarks (SLAM)."""

    # between a detection, a static track and a landmark
    match_distance: Annotated[float, "m"] = 0.2
    # radius around a landmark in which detections are gated
    search_distance: Annotated[float, "m"] = 1.0


@dataclass(frozen=True)
class RelocalizationParameters:
    """Relocalization by the constellation of the mapped landmarks."""

    # maximum standard deviation of a detection's distance
    max_range_sigma: Annotated[float, "m"] = 0.02
    # between detections of one colour that are one obstacle
    merge_distance: Annotated[float, "m"] = 0.15
    min_matches: int = 3  # minimum number of inliers
    min_match_fraction: float = 0.5  # inliers / min(detections, landmarks) [1]
    match_distance: Annotated[float, "m"] = 0.06  # distance of an inlier from its landmark
    # distance of the two detections that define a hypothesis
    min_baseline: Annotated[float, "m"] = 0.4
    # difference of position below which two hypotheses are one
    position_tolerance: Annotated[float, "m"] = 0.3
    heading_tolerance: float = 0.3  # difference of heading below which they are one [rad]


@dataclass(frozen=True)
class TrackingParameters:
    """Multi-object tracking: motion models, association, classification, birth and death."""

    acceleration_noise: Annotated[float, "m/s^1.5"] = 0.003  # white acceleration of a mover
    # standard deviation of a mover's turn rate [rad/s]
    turn_rate_sigma: Annotated[float, "1/s"] = 0.15
    turn_rate_time: Annotated[float, "s"] = 100.0  # correlation time of the turn rate
    static_diffusion: Annotated[float, "m²/s"] = 5e-7  # random walk of a static obstacle
    # of each component of a mover's initial velocity
    velocity_sigma: Annotated[float, "m/s"] = 0.07
    max_speed: Annotated[Positive, "m/s", doc("Maximum speed of an obstacle [m/s].")] = 0.2
    reach_sigmas: float = 3.0  # radius of the reachable disc at the last detection [sigma]
    reversal_rate: Annotated[
        NonNegative, "1/s", doc("Rate at which a mover reverses its direction [1/s].")
    ] = 1.0 / 12.0
    start_rate: Annotated[float, "1/s"] = 0.01  # rate at which a static obstacle starts to move
    stop_rate: Annotated[float, "1/s"] = 0.01  # rate at which a mover stops
    correlation_time: float = 0.03  # of the errors of successive detections of one obstacle [s]
    # Bias of all detections of a static obstacle / sigma of the most precise one [1].
    bias_fraction: float = 0.15
    # of each component of a static track's velocity
    static_velocity_sigma: Annotated[float, "m/s"] = 0.005
    gate: float = 13.8  # association gate: squared Mahalanobis distance to the nearest mode [1]
    uniform_probability: float = 0.2  # of a lost track: anywhere in reach, not at its particles
    birth_density: Annotated[float, "1/m²"] = 0.1  # of new obstacles on floor never seen before
    # of new obstacles on floor seen empty before
    intruder_density: Annotated[float, "1/m²"] = 0.004
    # Below the range of vision, close to which only errors towards the camera are reported.
    birth_range: Annotated[float, "m"] = 3.5  # maximum distance of a track birth
    birth_hits: int = 2  # detections that confirm a track
    birth_time: float = 1.5  # time within which they must follow each other [s]
    birth_moving_probability: float = 0.3  # that a new track moves
    intruder_moving_probability: float = 0.8  # the same on floor seen empty before
    max_log_ratio: float = 6.0  # log likelihood ratio of two modes from one detection [1]
    moving_probability: float = 0.9  # of moving, above which an undecided track is moving
    min_moving_speed: Annotated[float, "m/s"] = 0.02  # of a moving track
    min_moving_hits: int = 4  # detections of a moving track
    static_probability: float = 0.02  # of moving, below which an undecided track is static
    min_static_time: Annotated[float, "s"] = 2.0  # from first to last detection of a static track
    min_static_hits: int = 6  # detections of a static track
    static_exit_probability: float = 0.5  # of moving, above which a static track is undecided
    moving_exit_probability: float = 0.01  # of moving, below which a moving track is static
    # half width of the corridor in which a lost mover is searched
    path_width: Annotated[float, "m"] = 0.15
    reach_factor: float = 1.2  # range of a lost mover / (speed x time)
    lost_time: Annotated[float, "s"] = 0.35  # unseen time after which a track becomes particles
    particles: Annotated[
        int, Interval(ge=2, le=1000), doc("Number of particles per lost track [1].")
    ] = 16
    detection_probability: float = 0.8  # of an obstacle in clear view, per `detection_time`
    detection_time: float = 0.1  # interval between independent missed detections [s]
    min_effective_fraction: float = 0.35  # effective sample size / particles: below, resample
    position_jitter: Annotated[float, "m"] = 0.03  # roughening of resampled positions, kernel width
    velocity_jitter: Annotated[float, "m/s"] = 0.01  # roughening of resampled velocities
    min_existence: float = 0.05  # probability of the missed detections: below, redistribute
    candidates_per_particle: int = 4  # positions sampled per particle when redistributed
    forget_time: Annotated[
        Positive, "s", doc("Unseen time after which a track that may move is deleted [s].")
    ] = 25.0
    # the same for a track of fewer than `min_moving_hits`
    tentative_time: Annotated[float, "s"] = 12.0
    # distance within which a detection is certain in clear view
    detection_range: Annotated[float, "m"] = 2.2
    view_margin: float = 0.07  # distance from the border of the view to expect a detection [rad]
    occlusion_margin: Annotated[float, "m"] = 0.08  # enlargement of occluding obstacles
    miss_time: float = 0.2  # unseen time in clear view that counts as one miss [s]
    max_misses: int = 5  # successive misses after which a static track is deleted
    merge_fraction: float = 0.8  # distance / sum of radii below which two tracks are one [1]
    # floor of the standard deviation of a track's radius
    min_radius_sigma: Annotated[float, "m"] = 0.005
    # A less certain radius is mostly the prior: fusing it repeatedly would make the prior certain.
    # of the radius of a partly visible obstacle to be fused
    max_radius_sigma: Annotated[float, "m"] = 0.01
    max_pose_sigma: Annotated[float, "m"] = 0.10  # pose uncertainty propagated to the tracks


@dataclass(frozen=True)
class LocalMapParameters:
    """Confidence and occupancy grid around the robot."""

    cell: Annotated[Positive, "m", doc("Side of a cell [m].")] = 0.10
    size: Annotated[Positive, "m", doc("Side of the map [m].")] = 6.0
    attenuation: Annotated[float, "1/s"] = -0.03  # rate xi_lm of the confidence of unseen cells
    range: Annotated[Positive, "m", doc("Distance within which the floor counts as seen [m].")] = (
        2.5
    )
    free_rate: float = -6.0  # rate of the log odds of a cell seen empty [1/s]
    occupied_rate: float = 15.0  # rate of the log odds of a cell below a detection [1/s]
    max_look_time: float = 0.2  # maximum time credited to one frame [s]
    max_log_odds: float = 4.0  # maximum absolute log odds [1]


@dataclass(frozen=True)
class BeliefParameters:
    """All parameters of the belief."""

    localization: Annotated[LocalizationParameters, doc("Robot pose.")] = field(
        default_factory=LocalizationParameters
    )
    mapping: MappingParameters = field(default_factory=MappingParameters)
    """Data association of mapped landmarks (SLAM)."""
    relocalization: RelocalizationParameters = field(default_factory=RelocalizationParameters)
    """Relocalization by the mapped landmarks."""
    tracking: Annotated[TrackingParameters, doc("Obstacle tracks.")] = field(
        default_factory=TrackingParameters
    )
    local_map: Annotated[LocalMapParameters, doc("Map around the robot.")] = field(
        default_factory=LocalMapParameters
    )
