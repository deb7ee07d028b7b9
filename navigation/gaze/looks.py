"""Looks that the risk gaze weighs: at undetected movers, tracks, the path and beacons."""

from math import atan2, cos, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.belief.tracks import MOVING, STATIC, UNKNOWN, WEIGHT, X, Y
from navigation.belief.visibility import occluded
from navigation.gaze.views import Look
from navigation.observation import shadow_at
from navigation.transform import in_robot

Array = NDArray[np.float64]
Rows = NDArray[np.record]

MAX_AGE = 1e3  # age of ground that was never seen [s]


@compiled
def set_look(
    look: np.record, point: tuple[float, float], weight: float, shadow: Array, p: np.record
) -> float:
    """Set a look of constant urgency 1 at an upright object; return its distance [m].

    Args:
        look: record of type `Look`.
        point: position in R [m].
        weight: weight of the look [1].
        shadow: distance up to which the body hides the floor, see `CameraModel` (n,) [m].
        p: parameters; `obstacle_height` is 0 for a camera below the tops of the obstacles.
    """
    distance = sqrt(point[0] * point[0] + point[1] * point[1])
    look.x, look.y, look.weight, look.urgency, look.rate = point[0], point[1], weight, 1.0, 0.0
    look.top, look.tall = p.obstacle_height, False
    look.foot_value = 1.0 if distance >= shadow_at(atan2(point[1], point[0]), shadow) else 0.0
    return distance


@compiled
def set_urgency(look: np.record, age: float, contact_time: float, p: np.record) -> None:
    """Set the urgency of a look: the age over a fraction of the time to collision.

    Args:
        look: record of type `Look`.
        age: time since the object was seen [s].
        contact_time: worst-case time to collision [s].
        p: parameters.
    """
    rate = 1.0 / (p.look_ratio * max(p.min_time, contact_time))
    look.urgency, look.rate = age * rate, rate


@compiled
def approach_speed(track: np.record, p: np.record) -> float:
    """Return the worst-case speed at which an obstacle approaches [m/s]."""
    if track.motion == STATIC:
        return float(p.static_speed)
    if track.motion == MOVING:
        return float(min(p.mover_speed * p.speed, track.speed + 0.5 * track.speed_sigma))
    return float(p.unknown_speed * p.speed)


@compiled
def visual_age(track: np.record, p: np.record) -> float:
    """Return the age of a track, faster for undecided ones and those of few detections [s]."""
    age = track.age + p.min_age
    if track.motion != UNKNOWN:
        return float(age)
    return float(age * (p.fresh_factor if track.hits < p.fresh_hits else p.unknown_factor))


@compiled
def track_looks(
    looks: Rows,
    tracks: Rows,
    clouds: Array,
    robot: tuple[Array, float],
    shadow: Array,
    p: np.record,
) -> int:
    """Write the looks at tracks, and at the particles of lost ones; return their number.

    Args:
        looks: records of type `Look`, enough for all.
        tracks: records of type `TrackRecord` (n,).
        clouds: particles of the lost tracks (k, 6, m).
        robot: x, y, heading of R in W (3,) [m, m, rad], and direction of the planned velocity in
            R [rad].
        shadow: see `set_look`.
        p: parameters.
    """
    (pose, course), count = robot, 0
    for i in range(len(tracks)):
        track = tracks[i]
        track_weight = p.static_weight if track.motion == STATIC else 1.0
        approach, age = approach_speed(track, p), visual_age(track, p)
        for k in range(1 if track.cloud < 0 else clouds.shape[2]):
            x, y, weight = track.position[0], track.position[1], track_weight
            if track.cloud >= 0:
                cloud = clouds[track.cloud]
                x, y, weight = cloud[X, k], cloud[Y, k], track_weight * cloud[WEIGHT, k]
            x, y = in_robot(pose, x, y)
            distance = sqrt(x * x + y * y)
            if distance > p.attention_range:
                continue
            # The side that faces the robot is seen first.
            near = max(0.0, 1.0 - 0.5 * track.radius / max(distance, track.radius))
            look = looks[count]
            set_look(look, (near * x, near * y), weight, shadow, p)
            ahead = max(p.min_approach, 0.5 + 0.5 * cos(atan2(y, x) - course))
            gap = distance - track.radius - p.s_robot - p.clearance
            set_urgency(look, age, gap / (approach + p.speed * ahead), p)
            count += 1
    return count


@compiled
def ground_looks(
    looks: Rows, ground: Array, ages: Array, pose: Array, shadow: Array, p: np.record
) -> int:
    """Write the looks at the ground ahead; return their number.

    The urgency is the age of the ground over the time until the robot is there.

    Args:
        looks: records of type `Look`, enough for all.
        ground: points in W (n, 2) [m].
        ages: times since they were seen, infinite if never (n,) [s].
        pose: x, y, heading of R in W (3,) [m, m, rad].
        shadow: see `set_look`.
        p: parameters.
    """
    for i in range(len(ground)):
        point = in_robot(pose, ground[i, 0], ground[i, 1])
        distance = set_look(looks[i], point, p.path_weight / len(ground), shadow, p)
        age = min(ages[i], MAX_AGE) + p.min_age
        set_urgency(looks[i], age, (distance - p.s_robot) / p.speed, p)
    return len(ground)


@compiled
def beacon_looks(looks: Rows, beacons: Array, pose: Array, value: float, p: np.record) -> int:
    """Write the looks at the beacons in reach; return their number.

    A view must show the seam of the two colours of a beacon, halfway up.

    Args:
        looks: records of type `Look`, enough for all.
        beacons: known positions in W (n, 2) [m].
        pose: x, y, heading of R in W (3,) [m, m, rad].
        value: weight of all beacons in reach together [1].
        p: parameters.
    """
    count = 0
    for i in range(len(beacons)):
        x, y = in_robot(pose, beacons[i, 0], beacons[i, 1])
        if x * x + y * y > p.beacon_range * p.beacon_range or abs(atan2(y, x)) > p.reach:
            continue
        look = looks[count]
        look.x, look.y, look.urgency, look.rate = x, y, 1.0, 0.0
        look.top, look.foot_value, look.tall = p.seam, 0.0, True
        count += 1
    for i in range(count):
        looks[i].weight = value / count
    return count


@compiled
def known_discs(tracks: Rows, pose: Array, p: np.record) -> Array:
    """Return the tracks that hide the floor behind them, in R, see `relative_discs` (m, 4)."""
    discs, count = np.empty((len(tracks), 4)), 0
    for i in range(len(tracks)):
        track = tracks[i]
        if track.cloud < 0 and (track.age < p.max_disc_age or track.motion == STATIC):
            x, y = in_robot(pose, track.position[0], track.position[1])
            discs[count, 0], discs[count, 1], discs[count, 2] = x, y, x * x + y * y
            discs[count, 3] = track.radius * track.radius
            count += 1
    return discs[:count]


@compiled
def looks_of(
    tracks: Rows,
    clouds: Array,
    cells: Array,
    ground: tuple[Array, Array],
    beacons: tuple[Array, float],
    robot: tuple[Array, float],
    shadow: Array,
    parameters: Rows,
) -> Rows:
    """Return all looks that no obstacle hides, records of type `Look`.

    Args:
        tracks: records of type `TrackRecord` (n,).
        clouds: particles of the lost tracks (k, 6, m).
        cells: position in W [m] and risk of cells with undetected obstacles (c, 3).
        ground: points of the path in W (g, 2) [m], and times since they were seen (g,) [s].
        beacons: known positions in W (b, 2) [m], and weight of all beacons together [1].
        robot: x, y, heading of R in W (3,) [m, m, rad], and direction of the planned velocity in
            R [rad].
        shadow: see `set_look`.
        parameters: record of the parameters (1,).
    """
    p, pose = parameters[0], robot[0]
    size = len(cells) + len(tracks) * max(1, clouds.shape[2]) + len(ground[0]) + len(beacons[0])
    looks, count = np.empty(size, Look), len(cells)
    for i in range(len(cells)):
        point = in_robot(pose, cells[i, 0], cells[i, 1])
        set_look(looks[i], point, cells[i, 2], shadow, p)
    count += track_looks(looks[count:], tracks, clouds, robot, shadow, p)
    count += ground_looks(looks[count:], ground[0], ground[1], pose, shadow, p)
    count += beacon_looks(looks[count:], beacons[0], pose, beacons[1], p)
    discs, shown = known_discs(tracks, pose, p), 0
    for i in range(count):
        look = looks[i]
        if look.tall or not occluded(look.x, look.y, discs, p.disc_edge):
            looks[shown] = look
            shown += 1
    return looks[:shown]
