"""Parameters of the gaze: partial evaluations, gaze map, votes, timing.

Public keys of a scenario have bounds and a docstring; all other fields are for studies.
"""

from dataclasses import dataclass, field
from math import pi
from typing import Annotated, Literal

from annotated_types import Ge, Interval, Le, Lt, doc

from navigation.parameters.bounds import NonNegative, Positive

GazeMode = Literal["risk", "integrated", "steps", "triangle", "fixed"]


@dataclass(frozen=True)
class EvaluationParameters:
    """Partial evaluations (1)-(4)."""

    d_nm: Annotated[
        Positive, "m", doc("Minimum distance of the sample points of the local map [m].")
    ] = 0.30
    d_fm: Annotated[
        float,
        Ge(0.01),
        Le(50.0),
        "m",
        doc("Maximum distance of the sample points of the local map [m]."),
    ] = 1.30

    ring_step: Annotated[float, "m"] = 0.20  # distance of the sample points along a ray
    ray_step: float = pi / 18.0  # angle between the rays of sample points [rad]
    lambda_cf: float = 0.85  # confidence below which a sample point is under-confident [1]
    t_sf: Annotated[float, "m"] = 0.05  # position uncertainty at which psi_sf is one
    t_heading: float = 0.09  # heading uncertainty at which psi_sf is one; 0 ignores it [rad]
    omega_o: Annotated[float, "1/m"] = 20.0  # normalization of the obstacle evaluation
    gamma_o: Annotated[float, "1/s"] = 0.25  # obstacle evaluation at which psi_ob is one
    # lower bound of the distance in the obstacle evaluation
    min_distance: Annotated[float, "m"] = 0.05
    aim_height: Annotated[float, "m"] = 0.05  # height on an obstacle at which the gaze aims
    d_n_thres: Annotated[float, "m"] = 0.80  # obstacle-free distance at which psi_way is one
    attention_range: Annotated[float, "m"] = 2.5  # maximum distance of obstacles in the set O
    beacon_range: Annotated[float, "m"] = 4.5  # maximum distance of beacons that get votes


@dataclass(frozen=True)
class UndetectedParameters:
    """Density of movers and static obstacles that were never detected."""

    movers: Annotated[float, "1/m²"] = 1.5  # density of movers on ground never seen
    static: Annotated[float, "1/m²"] = 0.3  # density of static obstacles on ground never seen
    headings: int = 16  # directions of motion of undetected movers [1]
    speed: Annotated[float, "m/s"] = 0.20  # of undetected movers
    missed: float = 0.15  # fraction that one frame misses [1]
    reach: Annotated[float, "m"] = 1.5  # distance up to which undetected movers count
    gap: Annotated[float, "m"] = 0.30  # distance of two axes that counts as a collision
    max_time: Annotated[float, "s"] = 6.0  # time to collision from which they do not count
    # half the time to collision at which the urgency is one
    time: Annotated[float, "s"] = 2.0
    min_time: Annotated[float, "s"] = 0.25  # lower bound of the time to collision
    # weight of collisions of the robot that walks on; the others are those of one that stops [1]
    walking_weight: float = 0.5


@dataclass(frozen=True)
class GroundAheadParameters:
    """Points of the ground ahead of the robot that the gaze keeps seen."""

    # nearest ground checked; a look 20 deg down shows none nearer
    near: Annotated[float, "m"] = 0.36
    far: Annotated[float, "m"] = 0.60  # farthest ground checked
    half_width: Annotated[float, "m"] = 0.10  # half width of the ground checked
    rows: int = 4  # rows of points from the nearest to the farthest [1]


@dataclass(frozen=True)
class RiskParameters:
    """Risk gaze: the risk that a look removes, over the time that it takes."""

    look_time: Annotated[float, "s"] = 0.25  # duration of a look after the saccade
    switch_ratio: float = 1.5  # ratio of the values at which another view replaces the present [1]
    max_urgency: float = 4.0  # upper bound of the urgency [1]
    # assumed approach of obstacles: static, and undecided or moving at most, ratios to the robot's
    static_speed: Annotated[float, "m/s"] = 0.02
    unknown_speed: float = 0.70  # [1]
    mover_speed: float = 0.80  # [1]
    min_approach: float = 0.25  # of the robot itself, ratio to its speed [1]
    clearance: Annotated[float, "m"] = 0.05  # gap that counts as a collision
    min_time: Annotated[float, "s"] = 0.4  # lower bound of the time to collision
    look_ratio: float = 0.5  # fraction of the time to collision within which to look again [1]
    min_age: Annotated[float, "s"] = 0.1  # age of an object in the latest frame
    unknown_factor: float = 2.0  # ratio by which undecided obstacles age faster [1]
    fresh_factor: float = 4.0  # the same for those of few detections [1]
    fresh_hits: int = 8  # number of detections below which they are few [1]
    static_weight: float = 0.12  # weight of static obstacles [1]
    max_disc_age: Annotated[float, "s"] = 1.0  # age up to which an obstacle occludes others
    path_weight: float = 0.3  # weight of the ground ahead [1]
    beacon_weight: float = 1.6  # of all beacons in a view together [1]
    min_self_uncertainty: float = 0.2  # psi_sf from which beacons count [1]
    # time without a beacon that counts like psi_sf = 1: the covariance does not show every error
    beacon_time: Annotated[float, "s"] = 10.0
    t_heading: float = 0.06  # heading uncertainty at which psi_sf is one [rad]
    disc_edge: Annotated[float, "m"] = 0.14  # distance from an obstacle that it does not hide
    border: float = 0.05  # distance from the border of the image [rad]


@dataclass(frozen=True)
class GazeParameters:
    """Gaze map (5)-(6) and the timing of the gaze."""

    mode: Annotated[
        GazeMode,
        doc(
            "risk: most risk removed per time, the default; integrated: (1)-(6). Blind: steps: "
            "stops from side to side; triangle: pan at a constant rate; fixed: straight ahead."
        ),
    ] = "risk"
    moved_by: Annotated[
        Literal["head", "body"],
        doc("Part that turns the camera: the head, or the body of a robot with a fixed camera."),
    ] = "head"
    w_lm: Annotated[NonNegative, doc("Weight of the local map in (6) [1].")] = 0.09
    w_way: Annotated[NonNegative, doc("Weight of the waypoint in (6) [1].")] = 0.23
    w_sf: Annotated[NonNegative, doc("Weight of self-localization in (6) [1].")] = 0.23
    w_ob: Annotated[NonNegative, doc("Weight of obstacles in (6) [1].")] = 0.45
    step: Annotated[float, Ge(0.01), Le(7.0), doc("Resolution of the gaze map [rad].")] = pi / 18.0
    max_pan: Annotated[float, Ge(0.01), Le(7.0), doc("Maximum pan to either side [rad].")] = (
        pi / 2.0
    )
    min_tilt: Annotated[float, Ge(-2.0), Lt(0.0), doc("Lowest tilt [rad].")] = -pi / 3.0
    max_tilt: Annotated[float, Ge(0.0), Le(2.0), doc("Highest tilt [rad].")] = pi / 9.0
    dwell: Annotated[
        NonNegative,
        doc("Dwell: minimum time between the arrival of the head and the next gaze [s]."),
    ] = 0.1
    fixed_tilt: Annotated[float, Ge(-2.0), Le(2.0), doc("Tilt of the blind gazes [rad].")] = -0.45
    sweep_amplitude: Annotated[
        NonNegative, doc("Pan amplitude of `steps` and `triangle` [rad].")
    ] = 1.2
    sweep_period: Annotated[Positive, "s", doc("Period of `triangle` [s].")] = 4.0
    sweep_stops: Annotated[int, Interval(ge=2, le=100), doc("Number of stops of `steps` [1].")] = 4
    sweep_frames: Annotated[
        int, Interval(ge=1, le=100), doc("Number of sharp frames at each of its stops [1].")
    ] = 2

    arrival_tolerance: float = 0.06  # distance from the target at which a saccade ends [rad]
    max_saccade_time: float = 0.6  # time until the next decision if the head does not arrive [s]
    max_turn_time: float = 1.5  # the same time if the body does not arrive [s]
    risk: RiskParameters = field(default_factory=RiskParameters)
    undetected: UndetectedParameters = field(default_factory=UndetectedParameters)
    ground: GroundAheadParameters = field(default_factory=GroundAheadParameters)
