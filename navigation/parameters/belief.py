"""Parameters of the belief: localization, tracks and local map."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt

from navigation.parameters.bounds import NonNegative, Positive, Share


@dataclass(frozen=True)
class LocalizationParameters:
    """Filter of the robot's pose from odometry and beacons, or what it maps itself."""

    map: Literal["beacons", "none"] = "beacons"
    """beacons: their known places; none: the static obstacles it meets, as if there were none."""
    drift: NonNegative = 0.0001
    """Random walk of position and heading that the odometry's covariance lacks
    [m/s^0.5, rad/s^0.5]."""
    gate: Positive = 13.8
    """Normalised innovation squared above which a beacon sighting is rejected [1]."""
    lost_run: Annotated[int, Ge(2)] = 8
    """Rejected sightings in a row, of two or more beacons, that mean being lost [1]."""
    lost_time: Positive = 2.0
    """Duration of such a run that means being lost whatever the number of beacons [s]."""
    displaced_hits: Annotated[int, Ge(2)] = 10
    """Frames in a row that contradict one beacon and fit others: it was moved [1]."""
    lost_sigma: Positive = 1.0
    """Standard deviation of position and heading while lost [m, rad]."""
    recovery_sigma: Positive = 0.15
    """Standard deviation of position and heading after recovery from beacons [m, rad]."""
    recovery_window: Positive = 6.0
    """Age up to which sightings of beacons serve recovery [s]."""


@dataclass(frozen=True)
class MappingParameters:
    """Landmarks that the robot maps itself, where `localization.map` is none."""

    match_distance: Positive = 0.2
    """Distance up to which a detection, a static track and a landmark are of one thing [m]."""
    search_distance: Positive = 1.0
    """Distance from a landmark within which its detection is looked for [m]."""


@dataclass(frozen=True)
class RecognitionParameters:
    """Finding back by the arrangement of the landmarks that the robot has mapped itself."""

    sigma_limit: Positive = 0.02
    """Standard deviation of a distance from which on a sighting is of no use [m]."""
    same_thing: Positive = 0.15
    """Distance up to which two sightings of one colour are of one thing [m]."""
    least_sightings: Annotated[int, Ge(2)] = 3
    """Sightings that must fall on landmarks [1]."""
    least_share: Share = 0.5
    """Share of the sightings, or of the landmarks if they are fewer, that must do so [1]."""
    tolerance: Positive = 0.06
    """Distance up to which a sighting falls on a landmark [m]."""
    least_separation: Positive = 0.4
    """Distance of two sightings without which they tell no heading [m]."""
    same_pose: Positive = 0.3
    """Difference up to which two poses are one [m, rad]."""


@dataclass(frozen=True)
class TrackingParameters:
    """Obstacle tracks: filters, association, classification, birth and death."""

    acceleration_noise: Positive = 0.003
    """White acceleration of a mover [m/s^1.5]."""
    turn_sigma: Positive = 0.15
    """Standard deviation of the rate at which movers bend [rad/s]."""
    turn_time: Positive = 100.0
    """Time over which a mover changes that rate [s]."""
    static_diffusion: Positive = 5e-7
    """Random walk of what stands still [m²/s]."""
    velocity_sigma: Positive = 0.07
    """Standard deviation of each component of the velocity of what begins to move [m/s]."""
    top_speed: Positive = 0.2
    """Speed that no obstacle exceeds [m/s]."""
    reach_sigmas: NonNegative = 3.0
    """Size of the last sighting's ellipse in the reach, in standard deviations [1]."""
    reversal_rate: NonNegative = 1.0 / 12.0
    """Rate at which a mover turns back [1/s]."""
    start_rate: Positive = 0.01
    """Rate at which what stands still begins to move [1/s]."""
    stop_rate: Positive = 0.01
    """Rate at which a mover stops for good [1/s]."""
    correlation_time: NonNegative = 0.03
    """Correlation time of the error of successive detections of one obstacle [s]."""
    lasting_error: NonNegative = 0.15
    """Error common to all detections of a static obstacle, as a share of its best detection's
    standard deviation; averaging does not reduce it [1]."""
    static_velocity_sigma: Positive = 0.005
    """Standard deviation of each component of the velocity of a static track [m/s]."""
    gate: Positive = 13.8
    """Squared Mahalanobis distance above which no mode explains a detection [1]."""
    anywhere: Annotated[float, Gt(0.0), Lt(1.0)] = 0.2
    """Probability that a lost track is anywhere in reach, not where its particles are [1]."""
    birth_density: Positive = 0.1
    """Density of new obstacles where the floor was not seen yet [1/m²]."""
    intruder_density: Positive = 0.004
    """Density of new obstacles where the floor was seen empty: movers not met before [1/m²]."""
    birth_range: Positive = 3.5
    """Distance beyond which no track begins: below the range of vision, near which only
    sightings that err short are reported [m]."""
    birth_hits: Annotated[int, Ge(2)] = 2
    """Detections that make a track [1]."""
    birth_time: Positive = 0.5
    """Time within which they must come [s]."""
    birth_moving: Annotated[float, Gt(0.0), Lt(1.0)] = 0.3
    """Probability that a new track moves [1]."""
    intruder_moving: Annotated[float, Gt(0.0), Lt(1.0)] = 0.8
    """The same where the floor was seen empty before [1]."""
    evidence: Positive = 6.0
    """Largest logarithm of the ratio of the modes' likelihoods, per detection [1]."""
    recognised: Annotated[float, Gt(0.5), Lt(1.0)] = 0.9
    """Probability of moving above which an undecided track moves [1]."""
    moving_speed: NonNegative = 0.02
    """Speed above which a track may move [m/s]."""
    moving_hits: Annotated[int, Ge(1)] = 4
    """Detections without which no track moves [1]."""
    standing: Annotated[float, Gt(0.0), Lt(0.5)] = 0.02
    """Probability of moving below which an undecided track is static [1]."""
    static_time: NonNegative = 2.0
    """Time from first to last detection without which no track is static [s]."""
    static_hits: Annotated[int, Ge(1)] = 6
    """Detections without which no track is static [1]."""
    doubted: Annotated[float, Gt(0.0), Lt(1.0)] = 0.5
    """Probability of moving above which a static track is undecided again [1]."""
    stopped: Annotated[float, Gt(0.0), Lt(0.5)] = 0.01
    """Probability of moving below which a mover is static [1]."""
    line_width: Positive = 0.15
    """Distance from where it could be at which a mover may still be found [m]."""
    reach_factor: Positive = 1.2
    """How many times as far as its speed says a lost mover may have got [1]."""
    lost_time: Positive = 0.35
    """Time unseen after which a track that may move becomes particles [s]."""
    particles: Annotated[int, Ge(2)] = 16
    """Hypotheses per lost track [1]."""
    detection_probability: Annotated[float, Gt(0.0), Lt(1.0)] = 0.8
    """Probability of detecting what is clearly in view, over one `refutation_time` [1]."""
    refutation_time: Positive = 0.1
    """Time in view over which one failed detection counts against a hypothesis [s]."""
    resample_share: Annotated[float, Gt(0.0), Le(1.0)] = 0.35
    """Share of effective particles below which they are resampled [1]."""
    position_jitter: Positive = 0.03
    """Spread of the copies of one particle, and least width of each [m]."""
    velocity_jitter: NonNegative = 0.01
    """Spread of the velocities of these copies [m/s]."""
    refuted: Annotated[float, Gt(0.0), Lt(1.0)] = 0.05
    """Probability of having seen nothing, given the particles, below which they are refuted [1]."""
    scatter: Annotated[int, Ge(1)] = 4
    """Places tried then per particle; with fewer out of view than particles the track ends [1]."""
    forget_time: Positive = 25.0
    """Time unseen after which a track that may move is dropped [s]."""
    tentative_time: Positive = 12.0
    """The same for a track with too few detections to move [s]."""
    sure_range: Positive = 2.2
    """Distance up to which an obstacle in clear view is sure to be detected [m]."""
    view_margin: NonNegative = 0.07
    """Distance from the border of the view inside which a detection is expected [rad]."""
    hiding_slack: NonNegative = 0.08
    """Widening of an obstacle within which it may hide what is behind it [m]."""
    miss_time: Positive = 0.2
    """Time in view without detection that counts as one miss [s]."""
    misses: Annotated[int, Ge(1)] = 5
    """Misses in a row that end a track that does not move [1]."""
    overlap: Annotated[float, Gt(0.0), Le(1.0)] = 0.8
    """Share of the sum of radii below which two tracks of a colour are one obstacle [1]."""
    radius_limit: Positive = 0.005
    """Least standard deviation of a track's radius [m]."""
    # Beyond it is mostly what was taken for granted: fusing it often would make that certain.
    vague_radius: Positive = 0.01
    """Standard deviation above which the radius of what is seen in part is not fused [m]."""
    pose_sigma_limit: Positive = 0.10
    """Largest pose uncertainty carried into the tracks, for they matter relatively [m]."""


@dataclass(frozen=True)
class LocalMapParameters:
    """Confidence and occupancy around the robot."""

    cell: Positive = 0.10
    """Side of a cell [m]."""
    size: Positive = 6.0
    """Side of the map [m]."""
    attenuation: Annotated[float, Lt(0.0)] = -0.03
    """Rate xi_lm at which confidence decays out of sight [1/s]."""
    range: Positive = 2.5
    """Distance up to which the floor is searched for obstacles [m]."""
    free_rate: Annotated[float, Lt(0.0)] = -6.0
    """Rate at which the log odds of occupancy of a cell change that is seen empty [1/s]."""
    occupied_rate: Positive = 15.0
    """Rate at which those of a cell under a detection change [1/s]."""
    look: Positive = 0.2
    """Time for which a single look counts at most, after a gap between frames [s]."""
    evidence_limit: Positive = 4.0
    """Largest absolute log odds [1]."""


@dataclass(frozen=True)
class BeliefParameters:
    """All parameters of the belief."""

    localization: LocalizationParameters = field(default_factory=LocalizationParameters)
    """Robot pose."""
    mapping: MappingParameters = field(default_factory=MappingParameters)
    """Landmarks that the robot maps itself."""
    recognition: RecognitionParameters = field(default_factory=RecognitionParameters)
    """Finding back by their arrangement."""
    tracking: TrackingParameters = field(default_factory=TrackingParameters)
    """Obstacles."""
    local_map: LocalMapParameters = field(default_factory=LocalMapParameters)
    """Map around the robot."""
