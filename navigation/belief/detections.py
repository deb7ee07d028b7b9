"""Obstacle detections of one frame, transformed from R to W with their covariance."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.observation import Observation
from navigation.value import value

Array = NDArray[np.float64]


@value
class Detections:
    """Obstacle detections of one frame in W.

    Attributes:
        observations: in R (m).
        positions: in W (m, 2) [m].
        covariances: of the positions, including the pose uncertainty (m, 2, 2) [m²].
        radii: (m,) [m].
        radius_sigmas: standard deviations of the radii (m,) [m].
        by_radius: partial derivatives of the positions with respect to the radius (m, 2) [1].
    """

    observations: tuple[Observation, ...]
    positions: Array
    covariances: Array
    radii: Array
    radius_sigmas: Array
    by_radius: Array

    def given_radius(self, index: int, radius: float, sigma: float) -> tuple[Array, Array]:
        """Return position (2,) [m] and covariance (2, 2) [m²] of a detection, given its radius.

        Args:
            index: of the detection.
            radius: [m].
            sigma: standard deviation of `radius` [m].
        """
        slope = self.by_radius[index]
        added = sigma * sigma - float(self.radius_sigmas[index]) ** 2
        position = self.positions[index] + (radius - float(self.radii[index])) * slope
        return position, self.covariances[index] + added * (slope[:, None] * slope)


def in_world(
    observations: Sequence[Observation],
    pose: Array,
    pose_covariance: Array,
    *,
    max_pose_sigma: float,
) -> Detections:
    """Transform the obstacles among `observations` to W.

    R = J R_polar J' + H P_pose H' with H = [1 0 -d sin a; 0 1 d cos a], a the direction in W.

    Args:
        observations: of one frame.
        pose: x, y, heading of R in W (3,) [m, m, rad].
        pose_covariance: (3, 3); scaled down as a whole to `max_pose_sigma`.
        max_pose_sigma: [m].
    """
    obstacles = tuple(o for o in observations if o.kind == "obstacle")
    x, y, heading = pose.tolist()
    variance = max(float(pose_covariance[0, 0]), float(pose_covariance[1, 1]), 1e-12)
    P = (pose_covariance * min(1.0, max_pose_sigma**2 / variance)).tolist()
    positions, covariances, by_radius = [], [], []
    for o in obstacles:
        direction = heading + o.bearing
        c, s, d = cos(direction), sin(direction), o.distance
        (rr, rb), (_, bb) = o.covariance.tolist()
        rb, bb = rb * d, bb * d * d
        hx, hy = -d * s, d * c
        xx = c * c * rr - 2.0 * c * s * rb + s * s * bb
        yy = s * s * rr + 2.0 * c * s * rb + c * c * bb
        xy = c * s * (rr - bb) + (c * c - s * s) * rb
        xx += P[0][0] + 2.0 * hx * P[0][2] + hx * hx * P[2][2]
        yy += P[1][1] + 2.0 * hy * P[1][2] + hy * hy * P[2][2]
        xy += P[0][1] + hy * P[0][2] + hx * P[1][2] + hx * hy * P[2][2]
        positions.append((x + d * c, y + d * s))
        covariances.append(((xx, xy), (xy, yy)))
        radial, angular = o.by_radius.tolist()
        by_radius.append((c * radial - s * d * angular, s * radial + c * d * angular))
    count = len(obstacles)
    return Detections(
        obstacles,
        np.array(positions, float).reshape(count, 2),
        np.array(covariances, float).reshape(count, 2, 2),
        np.array([o.radius for o in obstacles], float),
        np.array([o.radius_sigma for o in obstacles], float),
        np.array(by_radius, float).reshape(count, 2),
    )
