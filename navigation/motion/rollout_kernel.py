"""Compiled part of the collision filter: where velocities lead, and when they touch a disc.

An envelope is (forward, backward, lateral, turn, turn gain): the largest speeds [m/s, rad/s]
and the turn rate per heading error [1/s].
"""

from math import atan2, ceil, cos, hypot, inf, isfinite, isnan, pi, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Envelope = tuple[float, float, float, float, float]
Velocity = tuple[float, float, float]


@njit(cache=True)
def wrapped(a: float) -> float:
    """An angle in (-pi, pi] [rad]."""
    return a - 2.0 * pi * ceil((a - pi) / (2.0 * pi))


@njit(cache=True)
def body_velocity(error: float, speed: float, turn: float, envelope: Envelope) -> Velocity:
    """Velocity of the body, scaled into the envelope so that its direction is kept.

    Args:
        error: of the direction of motion from the heading [rad].
        speed: along that direction [m/s].
        turn: to where it is to face, from the heading [rad].
        envelope: of the walking layer.

    Returns:
        forward, left, turn [m/s, m/s, rad/s].
    """
    forward, left = speed * cos(error), speed * sin(error)
    reach = envelope[0] if forward >= 0.0 else envelope[1]
    excess = max(abs(forward) / reach, abs(left) / envelope[2])
    scale = 1.0 / max(1.0, excess)
    rate = envelope[4] * wrapped(turn)
    return scale * forward, scale * left, min(max(rate, -envelope[3]), envelope[3])


@njit(cache=True)
def body_velocities(asked: Array, envelope: Envelope) -> Array:
    """`body_velocity` of course, speed, heading and facing (4, n): (n, 3)."""
    velocities = np.empty((asked.shape[1], 3))
    for i in range(asked.shape[1]):
        error, turn = asked[0, i] - asked[2, i], asked[3, i] - asked[2, i]
        velocities[i, 0], velocities[i, 1], velocities[i, 2] = body_velocity(
            error, asked[1, i], turn, envelope
        )
    return velocities


@njit(cache=True)
def roll_out(
    candidates: Array,
    heading: float,
    course: float,
    facing: float,
    aside: float,
    body_now: Array,
    envelope: Envelope,
    gait: tuple[float, float, float, float, float],
    steps: int,
) -> tuple[Array, Array]:
    """Where the body would really go, footstep by footstep, for every candidate.

    Args:
        candidates: velocities in W (n, 2) [m/s].
        heading: of the robot [rad].
        course: direction of a candidate that stands [rad].
        facing: heading to turn to; not a number for the direction of motion [rad].
        aside: angle of the body to that direction, if it turns to it [rad].
        body_now: present velocity of the body in R (3,) [m/s, m/s, rad/s].
        envelope: of the walking layer.
        gait: duration of a footstep [s], largest change from one to the next of velocity [m/s]
            and of turn rate [rad/s], heading error from which the robot turns first [rad], and
            speed up to which it need not [m/s].
        steps: footsteps rolled out before the straight path.

    Returns:
        Velocities (steps + 2, n, 2) [m/s] and durations (steps + 2, n) [s] of the pieces: the
        footsteps, the turn, and the straight path for ever.
    """
    footstep, change, turn_change, turn_first_angle, sidestep_ratio = gait
    velocity = np.zeros((steps + 2, len(candidates), 2))
    duration = np.empty((steps + 2, len(candidates)))
    for i in range(len(candidates)):
        speed = hypot(candidates[i, 0], candidates[i, 1])
        direction = course if speed < 1e-9 else atan2(candidates[i, 1], candidates[i, 0])
        to = direction + aside if isnan(facing) else facing
        forward, left, turn, now = body_now[0], body_now[1], body_now[2], heading
        for step in range(steps):
            goal = body_velocity(direction - now, speed, to - now, envelope)
            du, dw = goal[0] - forward, goal[1] - left
            share = min(1.0, change / max(hypot(du, dw), 1e-9))
            forward += share * du
            left += share * dw
            turn += min(max(goal[2] - turn, -turn_change), turn_change)
            middle = now + 0.5 * turn * footstep
            c, s = cos(middle), sin(middle)
            velocity[step, i, 0] = c * forward - s * left
            velocity[step, i, 1] = s * forward + c * left
            duration[step, i] = footstep
            now += turn * footstep
        wait = max(0.0, abs(wrapped(direction - now)) - turn_first_angle) / envelope[3]
        duration[steps, i] = wait if speed > sidestep_ratio else 0.0
        velocity[steps + 1, i, 0], velocity[steps + 1, i, 1] = candidates[i, 0], candidates[i, 1]
        duration[steps + 1, i] = inf
    return velocity, duration


@njit(cache=True)
def contact_time(rate: float, square: float, outside: float) -> float:
    """Time until two discs that approach touch, infinite if they pass, zero inside [s].

    Args:
        rate: offset times relative velocity, negative [m²/s].
        square: squared relative speed [m²/s²].
        outside: squared distance less the squared sum of radii [m²].
    """
    discriminant = rate * rate - square * outside
    if discriminant <= 0.0 and outside >= 0.0:
        return inf
    return max(0.0, (-rate - sqrt(max(discriminant, 0.0))) / max(square, 1e-12))


@njit(cache=True)
def contact_times(
    velocity: Array,
    duration: Array,
    position: Array,
    centres: Array,
    motions: Array,
    radii: Array,
) -> tuple[Array, Array]:
    """Time to first contact of every path with every disc.

    Inside a disc it is zero if closing, and nothing if leaving.

    Args:
        velocity: of the pieces of n paths (k, n, 2) [m/s].
        duration: of them (k, n) [s].
        position: where the paths start (2,) [m].
        centres: of m discs (m, 2) [m].
        motions: their velocities (m, 2) [m/s].
        radii: (m,) [m].

    Returns:
        Time to contact (n, m) [s], infinite for none; closing speed at the start (n, m), of
        discs out of reach of the first piece zero [m/s].
    """
    k, n = duration.shape
    m = len(radii)
    first, closing = np.empty((n, m)), np.zeros((n, m))
    first[:] = inf
    # The latest end of a piece, and the fastest that any path is until then.
    latest, fastest = np.zeros(k), np.zeros(k)
    start, moved = np.zeros((k + 1, n)), np.zeros((k, n, 2))
    for piece in range(k):
        fastest[piece] = fastest[max(piece - 1, 0)]
        for i in range(n):
            u, w = velocity[piece, i, 0], velocity[piece, i, 1]
            start[piece + 1, i] = start[piece, i] + duration[piece, i]
            latest[piece] = max(latest[piece], start[piece + 1, i])
            fastest[piece] = max(fastest[piece], hypot(u, w))
            if piece < k - 1:
                moved[piece + 1, i, 0] = moved[piece, i, 0] + duration[piece, i] * u
                moved[piece + 1, i, 1] = moved[piece, i, 1] + duration[piece, i] * w
    for j in range(m):
        ox, oy = centres[j, 0] - position[0], centres[j, 1] - position[1]
        mx, my, radius2 = motions[j, 0], motions[j, 1], radii[j] * radii[j]
        distance, speed = hypot(ox, oy), hypot(mx, my)
        for piece in range(k):
            # Only some discs can be touched by then.
            within = (speed + fastest[piece]) * latest[piece]
            if isfinite(latest[piece]) and distance - radii[j] > within:
                continue
            for i in range(n):
                if first[i, j] < inf:
                    continue
                begin = start[piece, i]
                u, w = mx - velocity[piece, i, 0], my - velocity[piece, i, 1]
                dx = ox + begin * mx - moved[piece, i, 0]
                dy = oy + begin * my - moved[piece, i, 1]
                rate = dx * u + dy * w
                if rate >= 0.0:
                    continue
                if piece == 0:
                    closing[i, j] = -rate / max(distance, 1e-6)
                time = contact_time(rate, u * u + w * w, dx * dx + dy * dy - radius2)
                if time <= duration[piece, i] and time < inf:
                    first[i, j] = begin + time
    return first, closing


@njit(cache=True)
def penalties(
    first: Array,
    closing: Array,
    depth: Array,
    horizon: Array,
    weight: Array,
    contact: tuple[float, float, float],
    inside: tuple[float, float, float],
) -> Array:
    """Penalty for the contacts of every path (n,).

    Args:
        first: times to contact (n, m) [s].
        closing: speeds (n, m) [m/s].
        depth: how deep the start is in each disc, a share of its radius, below 0 outside (m,).
        horizon: time to contact below which a disc counts (m,) [s].
        weight: of each disc (m,).
        contact: time below which a contact is urgent [s], penalty of urgent and of others [1].
        inside: penalty of standing in a disc, more by its depth, more by the closing speed.
    """
    n, m = first.shape
    total = np.zeros(n)
    for i in range(n):
        for j in range(m):
            time = first[i, j]
            if time < horizon[j]:
                each = contact[1] if time < contact[0] else contact[2]
                cost = (1.0 - time / horizon[j]) * each
                if depth[j] > 0.0:
                    cost += inside[0] + inside[1] * depth[j] + inside[2] * closing[i, j]
                total[i] += cost * weight[j]
    return total
