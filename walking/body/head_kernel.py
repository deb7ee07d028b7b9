"""Head motion and pose of the head camera, compiled."""

from math import cos, sin, sqrt

from numba import njit

from walking.arrays import Array, Point


@njit(cache=True)
def advance(position: Array, velocity: Array, target: Point, limits: Array, motion: Array) -> Point:
    """Run one tick: time-optimal approach to the target on each axis, without overshoot.

    Args:
        position: pan and tilt, updated (2,) [rad].
        velocity: their rates, updated (2,) [rad/s].
        target: pan and tilt [rad].
        limits: lower and upper joint limit of each (2, 2) [rad].
        motion: maximum rate [rad/s] and acceleration [rad/s²], period of control [s] (3,).

    Returns:
        pan and tilt [rad].
    """
    rate, acceleration, period = motion[0], motion[1], motion[2]
    step = acceleration * period
    for axis in range(2):
        low, high = limits[axis, 0], limits[axis, 1]
        error = min(high, max(low, target[axis])) - position[axis]
        # Maximum speed from which whole ticks of braking end at the target.
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * period)) - 0.5)
        wanted = min(rate, reach, abs(error) / period)
        wanted = wanted if error >= 0.0 else -wanted
        velocity[axis] += min(step, max(-step, wanted - velocity[axis]))
        position[axis] += velocity[axis] * period
    return position[0], position[1]


@njit(cache=True)
def camera_pose(
    pan: float, tilt: float, origins: Array, mounted: Array, rotation: Array, position: Array
) -> None:
    """Set the pose of the head camera in the base frame.

    Args:
        pan: left positive [rad].
        tilt: up positive [rad].
        origins: positions of the pan joint in the base, of the tilt joint on the neck, of the
            camera on the head (3, 3) [m].
        mounted: rotation of the camera on the head (3, 3).
        rotation: R_BC, set (3, 3).
        position: p_BC, set (3,) [m].
    """
    ca, sa, cb, sb = cos(pan), sin(pan), cos(tilt), sin(tilt)
    rows = ((ca * cb, -sa, -ca * sb), (sa * cb, ca, -sa * sb), (sb, 0.0, cb))
    neck, head, camera = origins[0], origins[1], origins[2]
    for k in range(3):
        x, y, z = rows[k]
        for axis in range(3):
            rotation[k, axis] = x * mounted[0, axis] + y * mounted[1, axis] + z * mounted[2, axis]
    position[0] = neck[0] + (ca * head[0] - sa * head[1])
    position[1] = neck[1] + (sa * head[0] + ca * head[1])
    position[2] = neck[2] + head[2]
    for k in range(3):
        x, y, z = rows[k]
        position[k] += x * camera[0] + y * camera[1] + z * camera[2]
