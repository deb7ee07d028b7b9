"""Parameters of the belief: localization, tracking and local map."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Interval

from navigation.parameters.bounds import NonNegative, Positive


@dataclass(frozen=True)
class LocalizationParameters:
    """Kalman filter of the robot's pose."""

    landmarks: Literal["known", "mapped"] = "known"
    """known: beacons at known positions; mapped: static obstacles, mapped while walking (SLAM)."""
    drift: float = 0.0001  # process noise of the pose on top of the odometry's [m/√s, rad/√s]
    gate: float = 13.8  # chi-square gate of a beacon detection: squared Mahalanobis distance [1]
    lost_rejections: int = 8  # successive rejected detections, of two or more beacons: lost
    lost_time: float = 2.0  # duration of such a run with one beacon only: lost [s]
    displaced_rejections: int = 10  # successive frames that contradict one beacon only: displaced
    lost_sigma: float = 1.0  # standard deviation of position and heading while lost [m, rad]
    recovery_sigma: float = 0.15  # the same after recovery, and its maximum residual [m, rad]
    recovery_window: float = 6.0  # maximum age of a detection used for recovery [s]


@dataclass(frozen=True)
class MappingParameters:
    """Data association of mapped landmarks (SLAM)."""

    match_distance: float = 0.2  # between a detection, a static track and a landmark [m]
    search_distance: float = 1.0  # radius around a landmark in which detections are gated [m]


@dataclass(frozen=True)
class RelocalizationParameters:
    """Relocalization by the constellation of the mapped landmarks."""

    max_range_sigma: float = 0.02  # maximum standard deviation of a detection's distance [m]
    merge_distance: float = 0.15  # between detections of one colour that are one obstacle [m]
    min_matches: int = 3  # minimum number of inliers
    min_match_fraction: float = 0.5  # inliers / min(detections, landmarks) [1]
    match_distance: float = 0.06  # distance of an inlier from its landmark [m]
    min_baseline: float = 0.4  # distance of the two detections that define a hypothesis [m]
    pose_tolerance: float = 0.3  # difference below which two hypotheses are one [m, rad]


@dataclass(frozen=True)
class TrackingParameters:
    """Multi-object tracking: motion models, association, classification, birth and death."""

    acceleration_noise: float = 0.003  # white acceleration of a mover [m/s^1.5]
    turn_rate_sigma: float = 0.15  # standard deviation of a mover's turn rate [rad/s]
    turn_rate_time: float = 100.0  # correlation time of the turn rate [s]
    static_diffusion: float = 5e-7  # random walk of a static obstacle [m²/s]
    velocity_sigma: float = 0.07  # of each component of a mover's initial velocity [m/s]
    max_speed: Positive = 0.2
    """Maximum speed of an obstacle [m/s]."""
    reach_sigmas: float = 3.0  # radius of the reachable disc at the last detection [sigma]
    reversal_rate: NonNegative = 1.0 / 12.0
    """Rate at which a mover reverses its direction [1/s]."""
    start_rate: float = 0.01  # rate at which a static obstacle starts to move [1/s]
    stop_rate: float = 0.01  # rate at which a mover stops [1/s]
    correlation_time: float = 0.03  # of the errors of successive detections of one obstacle [s]
    # Bias of all detections of a static obstacle / sigma of the most precise one [1].
    bias_fraction: float = 0.15
    static_velocity_sigma: float = 0.005  # of each component of a static track's velocity [m/s]
    gate: float = 13.8  # association gate: squared Mahalanobis distance to the nearest mode [1]
    uniform_probability: float = 0.2  # of a lost track: anywhere in reach, not at its particles
    birth_density: float = 0.1  # of new obstacles on floor never seen before [1/m²]
    intruder_density: float = 0.004  # of new obstacles on floor seen empty before [1/m²]
    # Below the range of vision, close to which only errors towards the camera are reported.
    birth_range: float = 3.5  # maximum distance of a track birth [m]
    birth_hits: int = 2  # detections that confirm a track
    birth_time: float = 0.5  # time within which they must follow each other [s]
    birth_moving_probability: float = 0.3  # that a new track moves
    intruder_moving_probability: float = 0.8  # the same on floor seen empty before
    max_log_ratio: float = 6.0  # log likelihood ratio of two modes from one detection [1]
    moving_probability: float = 0.9  # of moving, above which an undecided track is moving
    min_moving_speed: float = 0.02  # of a moving track [m/s]
    min_moving_hits: int = 4  # detections of a moving track
    static_probability: float = 0.02  # of moving, below which an undecided track is static
    min_static_time: float = 2.0  # from first to last detection of a static track [s]
    min_static_hits: int = 6  # detections of a static track
    static_exit_probability: float = 0.5  # of moving, above which a static track is undecided
    moving_exit_probability: float = 0.01  # of moving, below which a moving track is static
    path_width: float = 0.15  # half width of the corridor in which a lost mover is searched [m]
    reach_factor: float = 1.2  # range of a lost mover / (speed x time)
    lost_time: float = 0.35  # unseen time after which a track becomes particles [s]
    particles: Annotated[int, Interval(ge=2, le=1000)] = 16
    """Number of particles per lost track [1]."""
    detection_probability: float = 0.8  # of an obstacle in clear view, per `detection_time`
    detection_time: float = 0.1  # interval between independent missed detections [s]
    min_effective_fraction: float = 0.35  # effective sample size / particles: below, resample
    position_jitter: float = 0.03  # roughening of resampled positions, kernel width [m]
    velocity_jitter: float = 0.01  # roughening of resampled velocities [m/s]
    min_existence: float = 0.05  # probability of the missed detections: below, redistribute
    candidates_per_particle: int = 4  # positions sampled per particle when redistributed
    forget_time: Positive = 25.0
    """Unseen time after which a track that may move is deleted [s]."""
    tentative_time: float = 12.0  # the same for a track of fewer than `min_moving_hits` [s]
    detection_range: float = 2.2  # distance within which a detection is certain in clear view [m]
    view_margin: float = 0.07  # distance from the border of the view to expect a detection [rad]
    occlusion_margin: float = 0.08  # enlargement of occluding obstacles [m]
    miss_time: float = 0.2  # unseen time in clear view that counts as one miss [s]
    max_misses: int = 5  # successive misses after which a static track is deleted
    merge_fraction: float = 0.8  # distance / sum of radii below which two tracks are one [1]
    min_radius_sigma: float = 0.005  # floor of the standard deviation of a track's radius [m]
    # A less certain radius is mostly the prior: fusing it repeatedly would make the prior certain.
    max_radius_sigma: float = 0.01  # of the radius of a partly visible obstacle to be fused [m]
    max_pose_sigma: float = 0.10  # pose uncertainty propagated to the tracks [m]


@dataclass(frozen=True)
class LocalMapParameters:
    """Confidence and occupancy grid around the robot."""

    cell: Positive = 0.10
    """Side of a cell [m]."""
    size: Positive = 6.0
    """Side of the map [m]."""
    attenuation: float = -0.03  # rate xi_lm of the confidence of unseen cells [1/s]
    range: Positive = 2.5
    """Distance within which the floor counts as seen [m]."""
    free_rate: float = -6.0  # rate of the log odds of a cell seen empty [1/s]
    occupied_rate: float = 15.0  # rate of the log odds of a cell below a detection [1/s]
    max_look_time: float = 0.2  # maximum time credited to one frame [s]
    max_log_odds: float = 4.0  # maximum absolute log odds [1]


@dataclass(frozen=True)
class BeliefParameters:
    """All parameters of the belief."""

    localization: LocalizationParameters = field(default_factory=LocalizationParameters)
    """Robot pose."""
    mapping: MappingParameters = field(default_factory=MappingParameters)
    """Data association of mapped landmarks (SLAM)."""
    relocalization: RelocalizationParameters = field(default_factory=RelocalizationParameters)
    """Relocalization by the mapped landmarks."""
    tracking: TrackingParameters = field(default_factory=TrackingParameters)
    """Obstacle tracks."""
    local_map: LocalMapParameters = field(default_factory=LocalMapParameters)
    """Map around the robot."""
