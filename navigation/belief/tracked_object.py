"""One tracked obstacle: filters, detection history and motion class."""

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from navigation.belief import imm, particles
from navigation.belief.detections import given_radius, variance_inflation
from navigation.belief.mode_filter import SIZE
from navigation.belief.tracks import MOVING, STATIC, UNKNOWN, TrackRecord, deviation, measure

Array = NDArray[np.float64]
Rows = NDArray[np.record]


@record_class
class ObjectRecord:
    """State of one obstacle between frames."""

    id: int
    label: int  # index in the labels of the tracker
    weights: Annotated[Array, 3]  # of the filters, see `imm` [1]
    states: Annotated[Array, 3, SIZE]
    covariances: Annotated[Array, 3, SIZE, SIZE]
    best: Annotated[Array, 2, 2]  # covariance of the most precise detection [m²]
    radius: float  # [m]
    radius_sigma: float  # [m]
    first_time: float  # of the first detection [s]
    last_time: float  # of the latest detection [s]
    last_seen: Annotated[Array, 2]  # position of the latest detection [m]
    detection_reach: float  # radius of its confidence disc [m]
    motion: int
    hits: int  # detections
    misses: int  # successive misses
    unseen_time: float  # time in clear view since the last detection or miss [s]
    lost: bool  # whether it is lost and has particles
    existence: float  # likelihood of the missed detections, given the particles [1]


@compiled
def position_of(o: np.record) -> tuple[float, float]:
    """Return the position of an object, given its motion class [m]."""
    if o.motion == STATIC:
        return o.states[imm.STATIC, 0], o.states[imm.STATIC, 1]
    average = imm.mean(o.weights, o.states)
    return average[0], average[1]


@compiled
def search_radius(o: np.record, time: float, p: np.record) -> float:
    """Return the radius around its last detection in which a lost object is searched [m]."""
    reach = p.reach_factor * imm.speed(o.weights, o.states) * (time - o.last_time)
    return float(p.path_width + reach)


@compiled
def detection_reach(R: Array, p: np.record) -> float:
    """Return the radius of the confidence disc of a detection of covariance `R` (2, 2) [m]."""
    return float(p.reach_sigmas * deviation(R[0, 0], R[0, 1], R[1, 1]))


@compiled
def begin(o: np.record, d: np.record, on_free_floor: bool, time: float, p: np.record) -> None:
    """Set an object to a tentative track at a detection.

    Args:
        o: record of type `ObjectRecord`, whose number and colour class are set elsewhere.
        d: record of type `DetectionRecord`.
        on_free_floor: whether the floor there was seen empty before: a new obstacle has moved.
        time: time of the frame [s].
        p: parameters of tracking.
    """
    moving = p.intruder_moving_probability if on_free_floor else p.birth_moving_probability
    imm.initialize(o.weights, o.states, o.covariances, d.position, d.covariance, moving, p)
    o.best[:] = d.covariance
    o.radius, o.radius_sigma = d.radius, max(d.radius_sigma, p.min_radius_sigma)
    o.first_time = o.last_time = time
    o.last_seen[:] = d.position
    o.detection_reach = detection_reach(d.covariance, p)
    o.motion, o.hits, o.misses, o.unseen_time = UNKNOWN, 1, 0, 0.0
    o.lost, o.existence = False, 1.0


@compiled
def correct(o: np.record, d: np.record, time: float, p: np.record) -> None:
    """Update filter, motion class and radius of an object by its detection.

    Args:
        o: record of type `ObjectRecord`.
        d: record of type `DetectionRecord`.
        time: time of the frame [s].
        p: parameters of tracking.
    """
    z, raw = d.position.copy(), d.covariance.copy()
    if o.radius_sigma < d.radius_sigma:
        z, raw = given_radius(d, o.radius, o.radius_sigma)
    inflation = variance_inflation(time - o.last_time, p.correlation_time)
    if imm.nis(o.states, o.covariances, z, raw) > p.gate:
        # Assigned through the particles, outside the gate of all modes: reset the filters.
        moving = max(1.0 - o.weights[imm.STATIC], 0.5)
        imm.initialize(o.weights, o.states, o.covariances, z, raw, moving, p)
    else:
        imm.update(o.weights, o.states, o.covariances, z, raw * inflation, p.max_log_ratio)
    fuse_radius(o, d, inflation, p)
    o.hits += 1
    o.misses, o.unseen_time = 0, 0.0
    o.last_time = time
    o.last_seen[:] = z
    o.detection_reach = detection_reach(raw, p)
    if raw[0, 0] + raw[1, 1] < o.best[0, 0] + o.best[1, 1]:
        o.best[:] = raw
    o.lost, o.existence = False, 1.0
    classify(o, p)


@compiled
def fuse_radius(o: np.record, d: np.record, inflation: float, p: np.record) -> None:
    """Fuse the radius, unless a partly visible obstacle gives hardly any information."""
    if d.partial and d.radius_sigma > p.max_radius_sigma:
        return
    measured = d.radius_sigma * d.radius_sigma * inflation
    prior = o.radius_sigma * o.radius_sigma
    gain = prior / (prior + measured)
    o.radius += gain * (d.radius - o.radius)
    o.radius_sigma = max(((1.0 - gain) * prior) ** 0.5, p.min_radius_sigma)


@compiled
def classify(o: np.record, p: np.record) -> None:
    """Update the motion class after a detection."""
    moving = 1.0 - o.weights[imm.STATIC]
    if o.motion == STATIC:
        if moving > p.static_exit_probability:
            o.motion = UNKNOWN
    elif o.motion == MOVING:
        if moving < p.moving_exit_probability:
            o.motion = STATIC
        elif imm.mean_speed(o.weights, o.states) < p.min_moving_speed:
            # At zero speed all modes predict one position: detections do not decide.
            o.motion = UNKNOWN
    elif (
        moving > p.moving_probability
        and o.hits >= p.min_moving_hits
        and imm.speed(o.weights, o.states) > p.min_moving_speed
    ):
        o.motion = MOVING
    elif (
        moving < p.static_probability
        and o.hits >= p.min_static_hits
        and o.last_time - o.first_time > p.min_static_time
    ):
        o.motion = STATIC


@compiled
def set_estimate(track: np.record, o: np.record, cloud: Array, p: np.record) -> None:
    """Set position, velocity, their covariance and turn rate of a track, given its motion class.

    Args:
        track: record of type `TrackRecord`.
        o: record of type `ObjectRecord`.
        cloud: its particles (6, m), which count while it is lost.
        p: parameters of tracking.
    """
    if o.lost:
        average, spread = particles.moments(cloud)
        turn_rate = 0.0
        for k in range(cloud.shape[1]):
            turn_rate += cloud[5, k] * cloud[4, k]
    elif o.motion == STATIC:
        average, spread = o.states[imm.STATIC].copy(), o.covariances[imm.STATIC].copy()
        turn_rate, bias = average[4], p.bias_fraction * p.bias_fraction
        for a in range(2):
            for b in range(2):
                spread[a, b] += bias * o.best[a, b]
            spread[2 + a, 2 + a] = p.static_velocity_sigma * p.static_velocity_sigma
    else:
        average, spread = imm.moments(o.weights, o.states, o.covariances)
        turn_rate = average[4]
    for a in range(2):
        track.position[a], track.velocity[a] = average[a], average[2 + a]
    for a in range(4):
        for b in range(4):
            track.covariance[a, b] = spread[a, b]
    track.turn_rate = turn_rate


@compiled
def published(objects: Rows, clouds: Array, time: float, parameters: Rows) -> tuple[Rows, Array]:
    """Return the confirmed tracks, records of type `TrackRecord` (k,), and their clouds (l, 6, m).

    Args:
        objects: records of type `ObjectRecord` (n,).
        clouds: their particles (n, 6, m).
        time: time of the frame [s].
        parameters: record of the parameters of tracking (1,).
    """
    p = parameters[0]
    tracks, lost = np.empty(len(objects), TrackRecord), np.empty_like(clouds)
    count = count_lost = 0
    for i in range(len(objects)):
        o, track = objects[i], tracks[count]
        if o.hits < p.birth_hits:
            continue
        track.id, track.label, track.motion, track.hits = o.id, o.label, o.motion, o.hits
        track.radius, track.radius_sigma = o.radius, o.radius_sigma
        track.age, track.visible = time - o.last_time, o.last_time == time
        track.last_seen[0], track.last_seen[1] = o.last_seen[0], o.last_seen[1]
        # The reachable disc grows, unless the obstacle is static.
        grown = 0.0 if o.motion == STATIC else p.max_speed * track.age
        track.reach = o.detection_reach + grown
        set_estimate(track, o, clouds[i], p)
        track.cloud = -1
        if o.lost:
            track.cloud = count_lost
            lost[count_lost] = clouds[i]
            count_lost += 1
        count += 1
    measure(tracks[:count])
    return tracks[:count], lost[:count_lost].copy()
