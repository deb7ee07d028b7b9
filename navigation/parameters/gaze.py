"""Parameters of the gaze: partial evaluations, gaze map, deadline votes, timing."""

from dataclasses import dataclass, field
from math import pi
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Lt

from navigation.parameters.bounds import NonNegative, Positive, Rings, Share

GazeMode = Literal[
    "deadline",
    "urgency",
    "integrated",
    "psi-lm",
    "psi-sf",
    "psi-ob",
    "psi-way",
    "info",
    "sweep",
    "fixed",
]


@dataclass(frozen=True)
class EvaluationParameters:
    """Partial evaluations (1)-(4)."""

    d_nm: Positive = 0.30
    """Nearest sample points of the local map [m]."""
    d_fm: Positive = 1.30
    """Farthest sample points of the local map [m]."""
    ring_step: Positive = 0.20
    """Distance of the sample points along a ray [m]."""
    ray_step: Positive = pi / 18.0
    """Angle between the rays of sample points [rad]."""
    lambda_cf: Share = 0.85
    """Confidence below which a sample point is under-confident [1]."""
    map_ratio: Literal["printed", "fraction"] = "fraction"
    """psi_lm: N_lp/N_cp as printed, or the share N_lp/(N_lp + N_cp)."""
    t_sf: Positive = 0.05
    """Position uncertainty at which psi_sf is one [m]."""
    t_heading: NonNegative = 0.09
    """Heading uncertainty at which psi_sf is one; 0 leaves the heading out [rad]."""
    omega_o: Positive = 20.0
    """Normalisation of the obstacle evaluation [1/m]."""
    gamma_o: Positive = 0.25
    """Obstacle evaluation at which psi_ob is one [1/s]."""
    min_distance: Positive = 0.05
    """Distance below which an obstacle's evaluation grows no more [m]."""
    aim_height: NonNegative = 0.05
    """Height at which an obstacle is looked at: its foot gives the range [m]."""
    d_n_thres: Positive = 0.80
    """Obstacle-free distance at which psi_way is one [m]."""
    attention_range: Positive = 2.5
    """Distance up to which obstacles take part in the gaze [m]."""
    beacon_range: Positive = 4.5
    """Distance up to which beacons are worth a look [m]."""


@dataclass(frozen=True)
class DeadlineParameters:
    """Votes by age over half the worst-case time to contact."""

    static_speed: NonNegative = 0.02
    """Speed a static obstacle is feared to have [m/s]."""
    unknown_speed: Share = 0.70
    """Speed an undecided obstacle is feared to have, share of the robot's [1]."""
    mover_speed: Share = 0.80
    """Largest speed a mover is feared to have, share of the robot's [1]."""
    exponent: Positive = 1.5
    """Growth of a vote with its urgency [1]."""
    max_urgency: Positive = 4.0
    """Largest urgency of a vote [1]."""
    unknown_bonus: NonNegative = 1.0
    """Age added to undecided obstacles [s]."""
    fresh_bonus: NonNegative = 3.0
    """Age added besides to undecided obstacles of few detections, at any distance [s]."""
    fresh_hits: Annotated[int, Ge(0)] = 8
    """Detections below which they are few [1]."""
    static_weight: NonNegative = 0.12
    """Weight of votes of static obstacles [1]."""
    map_weight: NonNegative = 0.05
    """Weight of votes of the local map [1]."""
    map_rings: Rings = (0.45, 0.8, 1.2, 1.7)
    """Distances of the ground that votes [m]."""
    map_rays: Annotated[int, Ge(2)] = 17
    """Directions of it, from one end of the gaze's reach to the other [1]."""
    path_weight: NonNegative = 0.2
    """Weight of the vote of the way [1]."""
    unseen_ground_weight: NonNegative = 0.8
    """Vote for ground the confidence gate waits for [1]."""
    look_request_weight: NonNegative = 3.0
    """Vote for ground the body turned aside for [1]."""
    beacon_weight: NonNegative = 1.6
    """Weight of the votes of the beacons together [1]."""
    t_heading: Positive = 0.06
    """Heading uncertainty at which the beacons vote fully [rad]."""
    switch_ratio: Annotated[float, Ge(1.0)] = 1.03
    """Gain in the gaze map that moves the gaze [1]."""
    saccade_time: NonNegative = 0.25
    """Time ahead for which votes are cast: the head turns, and the body with it [s]."""
    look_ratio: Positive = 0.5
    """Share of the time to contact within which to look again [1]."""
    min_time: Positive = 0.4
    """Shortest time to contact counted [s]."""
    min_age: NonNegative = 0.1
    """Age of what was seen in the latest frame [s]."""
    max_age: Positive = 8.0
    """Age of ground from which its votes grow no more [s]."""
    clearance: NonNegative = 0.05
    """Distance from contact at which a look comes too late [m]."""
    map_speed: NonNegative = 0.70
    """Feared speed of what comes from ground not seen, share of the robot's [1]."""
    path_distance: Positive = 0.8
    """Distance of the floor looked at along the way [m]."""
    look_request_tilt: float = -0.6
    """Tilt of a look at what the body turned aside for; shows the floor from 0.3 m on [rad]."""


@dataclass(frozen=True)
class InformationParameters:
    """Greedy information gain: what one detection is taken to tell."""

    sight_sigma: Positive = 0.01
    """Standard deviation of a place seen at no distance [m]."""
    sight_rate: NonNegative = 0.015
    """Growth of that with distance [1]."""
    presence: Annotated[float, Ge(0.0), Le(0.5)] = 0.02
    """Chance that something stands on a sample point never seen [1]."""


@dataclass(frozen=True)
class UrgencyParameters:
    """Votes of obstacles by age over time to contact; the other evaluations as in (6)."""

    max_urgency: Positive = 10.0
    """Largest urgency [1]."""
    bonus: NonNegative = 0.3
    """Age added to obstacles [s]."""
    unknown_bonus: NonNegative = 1.0
    """Age added to undecided obstacles instead [s]."""
    min_time: Positive = 0.4
    """Shortest time to contact counted [s]."""
    side_weight: Share = 0.6
    """Weight of what is not ahead [1]."""
    static_weight: NonNegative = 0.15
    """Weight of static obstacles [1]."""
    unseen_ground_weight: NonNegative = 0.8
    """Vote for ground the confidence gate waits for [1]."""


@dataclass(frozen=True)
class GazeParameters:
    """Gaze map (5)-(6) and the timing of the gaze."""

    mode: GazeMode = "deadline"
    """deadline: ours; urgency: what it grew from; integrated: (1)-(6); psi-lm, psi-sf, psi-ob,
    psi-way: one of them alone; info: greedy information gain; sweep: from side to side by the
    clock; fixed: ahead."""
    w_lm: NonNegative = 0.09
    """Weight of the local map in (6) [1]."""
    w_way: NonNegative = 0.23
    """Weight of the way point in (6) [1]."""
    w_sf: NonNegative = 0.23
    """Weight of self-localization in (6) [1]."""
    w_ob: NonNegative = 0.45
    """Weight of obstacles in (6) [1]."""
    step: Positive = pi / 36.0
    """Step of the gaze map [rad]."""
    box_fraction: Annotated[float, Gt(0.0), Le(0.5)] = 0.45
    """Half width of the box of a vote, share of the field of view [1]."""
    obstacle_votes: Literal["mean", "sum"] = "sum"
    """Votes of the obstacles in (6): divided by their number as printed, or summed."""
    map_votes: Literal["mean", "each"] = "each"
    """Vote of the local map: at the mean under-confident point as printed, or at each."""
    candidates: Literal["obstacles", "beacons"] = "beacons"
    """Who votes for self-localization: obstacles and beacons, or beacons alone."""
    switch_ratio: Annotated[float, Ge(1.0)] = 1.1
    """Gain in the gaze map that moves the gaze; mode deadline has its own [1]."""
    max_pan: Positive = pi / 2.0
    """Largest pan to either side [rad]."""
    min_tilt: Annotated[float, Lt(0.0)] = -pi / 3.0
    """Lowest tilt [rad]."""
    max_tilt: NonNegative = pi / 9.0
    """Highest tilt [rad]."""
    dwell: NonNegative = 0.1
    """Time the gaze rests after arrival before it is decided again [s]."""
    arrival_tolerance: Positive = 0.06
    """Distance from the target at which the head has arrived [rad]."""
    max_saccade_time: Positive = 0.6
    """Time after which the gaze is decided again even without arrival [s]."""
    fixed_tilt: float = -0.45
    """Tilt of the fixed gaze and of the sweep [rad]."""
    sweep_amplitude: NonNegative = 1.2
    """Pan amplitude of the sweep [rad]."""
    sweep_period: Positive = 4.0
    """Period of the sweep [s]."""
    urgency: UrgencyParameters = field(default_factory=UrgencyParameters)
    """Urgency votes."""
    deadline: DeadlineParameters = field(default_factory=DeadlineParameters)
    """Deadline votes."""
    information: InformationParameters = field(default_factory=InformationParameters)
    """Greedy information gain."""
