"""Collision hypotheses of the safety filter: tracks, particles of lost movers, reversals."""

from math import cos, sin, sqrt
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from navigation.belief.tracks import MOVING, STATIC, TURN_RATE, VX, VY, WEIGHT, X, Y

Array = NDArray[np.float64]
Rows = NDArray[np.record]


@record_class
class Disc:
    """Disc at constant velocity."""

    position: Annotated[Array, 2]  # in W [m]
    velocity: Annotated[Array, 2]  # [m/s]
    radius: float  # distance of the robot's centre that counts as a collision [m]
    horizon: float  # maximum time to collision [s]
    weight: float  # of the penalty [1]


@compiled
def chord_velocity(vx: float, vy: float, turn_rate: float, time: float) -> tuple[float, float]:
    """Return the mean velocity of a mover that turns at a constant rate, along its chord [m/s].

    Args:
        vx: velocity at the start [m/s].
        vy: velocity at the start [m/s].
        turn_rate: turn rate of the velocity, left positive [rad/s].
        time: duration [s].
    """
    half = 0.5 * time * turn_rate
    ratio = sin(half) / half if half != 0.0 else 1.0
    c, s = ratio * cos(half), ratio * sin(half)
    return c * vx - s * vy, s * vx + c * vy


@compiled
def set_disc(
    disc: np.record,
    position: tuple[float, float],
    velocity: tuple[float, float],
    radius: float,
    horizon: float,
    weight: float,
) -> None:
    """Set position [m], velocity [m/s], radius [m], horizon [s] and weight [1] of a disc."""
    disc.position[0], disc.position[1] = position
    disc.velocity[0], disc.velocity[1] = velocity
    disc.radius, disc.horizon, disc.weight = radius, horizon, weight


@compiled
def collision_discs(tracks: Rows, clouds: Array, s_robot: float, parameters: Rows) -> Rows:
    """Return the hypotheses of all tracks, records of type `Disc`.

    A lost mover counts as its particles; a visible one also as its reversal. A turning mover
    follows the chord of its arc over `bend_time`.

    Args:
        tracks: records of type `TrackRecord` (n,).
        clouds: particles of the lost tracks (k, 6, m).
        s_robot: radius of the robot [m].
        parameters: record of the parameters of the safety filter (1,).
    """
    p = parameters[0]
    discs, count = np.empty(2 * len(tracks) + clouds.shape[0] * clouds.shape[2], Disc), 0
    for reversed_ in (False, True):
        for i in range(len(tracks)):
            track = tracks[i]
            if track.cloud >= 0:
                continue
            if reversed_ and (track.motion != MOVING or p.reversal_weight <= 0.0):
                continue
            static, turn_rate = track.motion == STATIC, track.turn_rate
            radius = s_robot + track.radius + track.radius_sigma + p.margin
            if not static:
                radius += min(p.max_sigma, track.sigma)
            position = track.position[0], track.position[1]
            vx, vy = track.velocity[0], track.velocity[1]
            velocity = chord_velocity(vx, vy, turn_rate, p.bend_time)
            horizon, weight = p.static_horizon if static else p.moving_horizon, 1.0
            if reversed_:
                u, v = chord_velocity(vx, vy, -turn_rate, p.bend_time)
                velocity, horizon, weight = (-u, -v), p.reversal_horizon, p.reversal_weight
            set_disc(discs[count], position, velocity, radius, horizon, weight)
            count += 1
    for i in range(len(tracks)):
        track = tracks[i]
        if track.cloud < 0:
            continue
        cloud, radius = clouds[track.cloud], s_robot + track.radius + track.radius_sigma + p.margin
        for k in range(cloud.shape[1]):
            velocity = chord_velocity(cloud[VX, k], cloud[VY, k], cloud[TURN_RATE, k], p.bend_time)
            position, weight = (cloud[X, k], cloud[Y, k]), p.particle_weight * cloud[WEIGHT, k]
            set_disc(discs[count], position, velocity, radius, p.moving_horizon, weight)
            count += 1
    return discs[:count]


@compiled
def within_reach(discs: Rows, position: Array, speed: float) -> Rows:
    """Return the discs that a robot can reach in time, in a new array.

    Args:
        discs: records of type `Disc` (m,).
        position: position of the robot (2,) [m].
        speed: maximum speed of the robot [m/s].
    """
    near, count = discs.copy(), 0
    for disc in discs:
        dx, dy = disc.position[0] - position[0], disc.position[1] - position[1]
        vx, vy = disc.velocity[0], disc.velocity[1]
        gap = sqrt(dx * dx + dy * dy) - disc.radius
        if gap < (sqrt(vx * vx + vy * vy) + speed) * disc.horizon:
            near[count] = disc
            count += 1
    return near[:count]
