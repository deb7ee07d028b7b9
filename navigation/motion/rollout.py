"""Compiled rollout of the safety filter: paths of candidate velocities, times to collision.

An envelope is (vx, vx_backward, vy, wz, turn gain): the maximum speeds [m/s, rad/s] and the
turn rate per heading error [1/s].
"""

from math import atan2, cos, inf, isfinite, isnan, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.angles import wrap

Array = NDArray[np.float64]
Rows = NDArray[np.record]
Envelope = tuple[float, float, float, float, float]
Velocity = tuple[float, float, float]


@compiled
def body_velocity(error: float, speed: float, turn: float, envelope: Envelope) -> Velocity:
    """Return the velocity of the body, scaled into the envelope without a change of direction.

    Args:
        error: direction of motion relative to the heading [rad].
        speed: speed along that direction [m/s].
        turn: target heading relative to the heading [rad].
        envelope: speed envelope of the walking layer.

    Returns:
        vx, vy, wz [m/s, m/s, rad/s].
    """
    vx, vy = speed * cos(error), speed * sin(error)
    v_max = envelope[0] if vx >= 0.0 else envelope[1]
    excess = max(abs(vx) / v_max, abs(vy) / envelope[2])
    scale = 1.0 / max(1.0, excess)
    rate = envelope[4] * wrap(turn)
    return scale * vx, scale * vy, min(max(rate, -envelope[3]), envelope[3])


@compiled
def rollout(
    candidates: Array,
    heading: float,
    course: float,
    facing: float,
    body_now: Array,
    envelope: Envelope,
    gait: tuple[float, float, float, float, float],
    steps: int,
) -> tuple[Array, Array]:
    """Roll out every candidate velocity footstep by footstep.

    Args:
        candidates: velocities in W (n, 2) [m/s].
        heading: heading of the robot [rad].
        course: direction of a candidate that stands [rad].
        facing: target heading; NaN for the direction of motion [rad].
        body_now: present velocity of the body in R (3,) [m/s, m/s, rad/s].
        envelope: speed envelope of the walking layer.
        gait: duration of a footstep [s], maximum change between footsteps of velocity [m/s]
            and of turn rate [rad/s], heading error above which a fast path starts with a turn
            [rad], and the speed of a fast path [m/s].
        steps: number of footsteps before the straight path.

    Returns:
        Velocities (steps + 2, n, 2) [m/s] and durations (steps + 2, n) [s] of the segments: the
        footsteps, the turn, and the infinite straight path.
    """
    footstep, change, turn_change, turn_first_angle, fast = gait
    velocity = np.zeros((steps + 2, len(candidates), 2))
    duration = np.empty((steps + 2, len(candidates)))
    for i in range(len(candidates)):
        u, w = candidates[i, 0], candidates[i, 1]
        speed = sqrt(u * u + w * w)
        direction = course if speed < 1e-9 else atan2(w, u)
        target = direction if isnan(facing) else facing
        vx, vy, wz, now = body_now[0], body_now[1], body_now[2], heading
        for step in range(steps):
            goal = body_velocity(direction - now, speed, target - now, envelope)
            dx, dy = goal[0] - vx, goal[1] - vy
            scale = min(1.0, change / max(sqrt(dx * dx + dy * dy), 1e-9))
            vx += scale * dx
            vy += scale * dy
            wz += min(max(goal[2] - wz, -turn_change), turn_change)
            middle = now + 0.5 * wz * footstep
            c, s = cos(middle), sin(middle)
            velocity[step, i, 0] = c * vx - s * vy
            velocity[step, i, 1] = s * vx + c * vy
            duration[step, i] = footstep
            now += wz * footstep
        wait = max(0.0, abs(wrap(direction - now)) - turn_first_angle) / envelope[3]
        duration[steps, i] = wait if speed > fast else 0.0
        velocity[steps + 1, i, 0], velocity[steps + 1, i, 1] = u, w
        duration[steps + 1, i] = inf
    return velocity, duration


@compiled
def contact_time(rate: float, square: float, outside: float) -> float:
    """Return the time to collision of two closing discs, inf if they pass, 0 inside [s].

    Args:
        rate: offset times relative velocity, negative [m²/s].
        square: squared relative speed [m²/s²].
        outside: squared distance less the squared sum of radii [m²].
    """
    discriminant = rate * rate - square * outside
    if discriminant <= 0.0 and outside >= 0.0:
        return inf
    return max(0.0, (-rate - sqrt(max(discriminant, 0.0))) / max(square, 1e-12))


@compiled
def contact_times(
    velocity: Array, duration: Array, position: Array, discs: Rows
) -> tuple[Array, Array]:
    """Return time to collision and closing speed of every path with every disc.

    Inside a disc the time is zero if closing, and infinite if leaving.

    Args:
        velocity: velocities of the segments of n paths (k, n, 2) [m/s].
        duration: durations of the segments (k, n) [s].
        position: start of the paths (2,) [m].
        discs: records of type `DISC` (m,).

    Returns:
        Time to collision (n, m) [s], infinite for none; closing speed at the start (n, m), zero
        for discs out of reach of the first segment [m/s].
    """
    k, n = duration.shape
    m = len(discs)
    first, closing = np.empty((n, m)), np.zeros((n, m))
    first[:] = inf
    # Latest end of each segment, and maximum speed of all paths until then.
    latest, fastest = np.zeros(k), np.zeros(k)
    start, moved = np.zeros((k + 1, n)), np.zeros((k, n, 2))
    for segment in range(k):
        fastest[segment] = fastest[max(segment - 1, 0)]
        for i in range(n):
            u, w = velocity[segment, i, 0], velocity[segment, i, 1]
            start[segment + 1, i] = start[segment, i] + duration[segment, i]
            latest[segment] = max(latest[segment], start[segment + 1, i])
            fastest[segment] = max(fastest[segment], sqrt(u * u + w * w))
            if segment < k - 1:
                moved[segment + 1, i, 0] = moved[segment, i, 0] + duration[segment, i] * u
                moved[segment + 1, i, 1] = moved[segment, i, 1] + duration[segment, i] * w
    for j in range(m):
        disc = discs[j]
        ox, oy = disc.position[0] - position[0], disc.position[1] - position[1]
        mx, my, radius2 = disc.velocity[0], disc.velocity[1], disc.radius * disc.radius
        distance, speed = sqrt(ox * ox + oy * oy), sqrt(mx * mx + my * my)
        for segment in range(k):
            # Skip discs out of reach.
            within = (speed + fastest[segment]) * latest[segment]
            if isfinite(latest[segment]) and distance - disc.radius > within:
                continue
            for i in range(n):
                if first[i, j] < inf:
                    continue
                begin = start[segment, i]
                u, w = mx - velocity[segment, i, 0], my - velocity[segment, i, 1]
                dx = ox + begin * mx - moved[segment, i, 0]
                dy = oy + begin * my - moved[segment, i, 1]
                rate = dx * u + dy * w
                if rate >= 0.0:
                    continue
                if segment == 0:
                    closing[i, j] = -rate / max(distance, 1e-6)
                time = contact_time(rate, u * u + w * w, dx * dx + dy * dy - radius2)
                if time <= duration[segment, i] and time < inf:
                    first[i, j] = begin + time
    return first, closing


@compiled
def penalties(
    first: Array, closing: Array, position: Array, discs: Rows, parameters: Rows
) -> Array:
    """Return the collision penalty of every path (n,).

    Args:
        first: times to collision (n, m) [s].
        closing: speeds (n, m) [m/s].
        position: start of the paths (2,) [m].
        discs: records of type `DISC` (m,).
        parameters: record of the parameters of the safety filter (1,).
    """
    p = parameters[0]
    n, m = first.shape
    total = np.zeros(n)
    for j in range(m):
        disc = discs[j]
        dx, dy = disc.position[0] - position[0], disc.position[1] - position[1]
        depth = 1.0 - sqrt(dx * dx + dy * dy) / disc.radius  # as a fraction of the radius
        for i in range(n):
            time = first[i, j]
            if time < disc.horizon:
                each = p.urgent_weight if time < p.urgent_time else p.weight
                cost = (1.0 - time / disc.horizon) * each
                if depth > 0.0:
                    cost += p.inside_weight + p.inside_depth * depth
                    cost += p.inside_closing * closing[i, j]
                total[i] += cost * disc.weight
    return total
