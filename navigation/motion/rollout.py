"""Compiled rollout of footsteps, and the collisions of the rolled-out paths.

An envelope is (vx, vx_backward, vy, wz, turn gain): the maximum speeds [m/s, rad/s] and the
turn rate per heading error [1/s].
"""

from math import atan2, cos, inf, isnan, sin, sqrt

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
def followed(
    candidates: Array,
    heading: float,
    course: float,
    facing: float,
    body_now: Array,
    envelope: Envelope,
    gait: Velocity,
    steps: int,
) -> Array:
    """Return the body velocities with which a robot follows candidate velocities.

    Args:
        candidates: velocities in W (n, 2) [m/s].
        heading: heading of the robot [rad].
        course: direction of a candidate that stands [rad].
        facing: target heading; NaN for the direction of motion [rad].
        body_now: present velocity of the body in R (3,) [m/s, m/s, rad/s].
        envelope: speed envelope of the walking layer.
        gait: duration of a footstep [s], maximum change between footsteps of velocity [m/s]
            and of turn rate [rad/s].
        steps: number of footsteps.

    Returns:
        vx, vy, wz in R of every footstep (n, steps, 3) [m/s, m/s, rad/s].
    """
    footstep, change, turn_change = gait
    body = np.empty((len(candidates), steps, 3))
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
            body[i, step, 0], body[i, step, 1], body[i, step, 2] = vx, vy, wz
            now += wz * footstep
    return body


@compiled
def walked(body: Array, heading: float, footstep: float) -> tuple[Array, Array]:
    """Return velocities in W (n, steps, 2) [m/s] and final headings of footsteps (n, steps) [rad].

    Args:
        body: vx, vy, wz in R of n sequences of footsteps (n, steps, 3) [m/s, m/s, rad/s].
        heading: heading at the start [rad].
        footstep: duration of a footstep [s].
    """
    n, steps, _ = body.shape
    velocity, headings = np.empty((n, steps, 2)), np.empty((n, steps))
    for i in range(n):
        now = heading
        for step in range(steps):
            vx, vy, wz = body[i, step, 0], body[i, step, 1], body[i, step, 2]
            middle = now + 0.5 * wz * footstep
            c, s = cos(middle), sin(middle)
            velocity[i, step, 0], velocity[i, step, 1] = c * vx - s * vy, s * vx + c * vy
            now += wz * footstep
            headings[i, step] = now
    return velocity, headings


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
    velocity: Array, footstep: float, position: Array, discs: Rows
) -> tuple[Array, Array, Array]:
    """Return time to collision, minimum gap and closing speed of every path with every disc.

    Inside a disc the time is zero if closing, and infinite if leaving.

    Args:
        velocity: velocities of the footsteps of n paths (n, steps, 2) [m/s].
        footstep: duration of a footstep [s].
        position: start of the paths (2,) [m].
        discs: records of type `Disc` (m,).

    Returns:
        Time to collision (n, m) [s], infinite for none; minimum distance of the centre from the
        disc until then (n, m) [m]; closing speed at the start, zero if leaving (n, m) [m/s].
    """
    n, steps, _ = velocity.shape
    m = len(discs)
    first, gap, closing = np.full((n, m), inf), np.empty((n, m)), np.zeros((n, m))
    for j in range(m):
        disc = discs[j]
        mx, my, radius2 = disc.velocity[0], disc.velocity[1], disc.radius * disc.radius
        for i in range(n):
            dx, dy = disc.position[0] - position[0], disc.position[1] - position[1]
            nearest = dx * dx + dy * dy
            for step in range(steps):
                u, w = mx - velocity[i, step, 0], my - velocity[i, step, 1]
                rate, square = dx * u + dy * w, u * u + w * w
                if rate < 0.0:
                    if step == 0:
                        closing[i, j] = -rate / max(sqrt(dx * dx + dy * dy), 1e-6)
                    time = contact_time(rate, square, dx * dx + dy * dy - radius2)
                    if time <= footstep:
                        first[i, j], nearest = step * footstep + time, radius2
                        break
                    passed = min(footstep, -rate / max(square, 1e-12))
                    x, y = dx + passed * u, dy + passed * w
                    nearest = min(nearest, x * x + y * y)
                dx += footstep * u
                dy += footstep * w
            gap[i, j] = sqrt(nearest) - disc.radius
    return first, gap, closing


@compiled
def losses(
    contacts: tuple[Array, Array, Array],
    position: Array,
    discs: Rows,
    speed: float,
    parameters: Rows,
) -> Array:
    """Return the losses of every path by collisions and close passages (n,) [s].

    Args:
        contacts: result of `contact_times` for n paths and m discs.
        position: start of the paths (2,) [m].
        discs: records of type `Disc` (m,).
        speed: maximum speed of the robot [m/s].
        parameters: record of the parameters of the safety filter (1,).
    """
    p = parameters[0]
    first, gap, closing = contacts
    n, m = first.shape
    total = np.zeros(n)
    for j in range(m):
        disc = discs[j]
        dx, dy = disc.position[0] - position[0], disc.position[1] - position[1]
        depth = 1.0 - sqrt(dx * dx + dy * dy) / disc.radius  # as a fraction of the radius
        for i in range(n):
            time, loss = first[i, j], 0.0
            if time < disc.horizon:
                each = p.urgent_loss if time < p.urgent_time else p.collision_loss
                loss = (1.0 - time / disc.horizon) * each
                if depth > 0.0:
                    loss += p.inside_loss + p.depth_loss * depth
                    loss += p.closing_loss * closing[i, j] / speed
            elif gap[i, j] < p.comfort:
                loss = p.close_loss * (1.0 - max(0.0, gap[i, j]) / p.comfort)
            total[i] += loss * disc.weight
    return total
