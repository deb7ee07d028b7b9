"""Parameters of the risk gaze."""

from dataclasses import dataclass
from typing import Annotated


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
    beacon_height: Annotated[float, "m"] = 0.60  # of a beacon, whole in a view
    disc_edge: Annotated[float, "m"] = 0.14  # distance from an obstacle that it does not hide
    border: float = 0.05  # distance from the border of the image [rad]
