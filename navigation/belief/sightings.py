"""Detections of obstacles, converted from the robot frame to W with their covariance."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.observation import Observation
from navigation.value import value

Array = NDArray[np.float64]


@value
class Sightings:
    """The obstacles of one frame in W.

    Attributes:
        observations: what was seen in R (m).
        positions: in W (m, 2) [m].
        covariances: of the positions, with the pose's uncertainty (m, 2, 2) [m²].
        radii: (m,) [m].
        radius_sigmas: standard deviations of the radii (m,) [m].
        by_radius: displacement were the radius known to be greater (m, 2) [1].
    """

    observations: tuple[Observation, ...]
    positions: Array
    covariances: Array
    radii: Array
    radius_sigmas: Array
    by_radius: Array

    def of_radius(self, index: int, radius: float, sigma: float) -> tuple[Array, Array]:
        """Position (2,) [m] and covariance (2, 2) [m²] of one whose radius is known otherwise.

        Args:
            index: of the sighting.
            radius: what it is known to be [m].
            sigma: standard deviation of that [m].
        """
        slope = self.by_radius[index]
        surplus = sigma * sigma - float(self.radius_sigmas[index]) ** 2
        moved = self.positions[index] + (radius - float(self.radii[index])) * slope
        return moved, self.covariances[index] + surplus * (slope[:, None] * slope)


def in_world(
    observations: Sequence[Observation],
    pose: Array,
    pose_covariance: Array,
    *,
    max_pose_sigma: float,
) -> Sightings:
    """Convert the obstacles among `observations` to W.

    R = J R_polar J' + H P_pose H' with H = [1 0 -d sin a; 0 1 d cos a], a the direction in W.

    Args:
        observations: of one frame.
        pose: x, y, heading of R in W (3,) [m, m, rad].
        pose_covariance: (3, 3); scaled down as a whole to `max_pose_sigma`.
        max_pose_sigma: [m].
    """
    seen = tuple(o for o in observations if o.kind == "obstacle")
    x, y, heading = pose.tolist()
    largest = max(float(pose_covariance[0, 0]), float(pose_covariance[1, 1]), 1e-12)
    P = (pose_covariance * min(1.0, max_pose_sigma**2 / largest)).tolist()
    positions, covariances, by_radius = [], [], []
    for o in seen:
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
        outwards, sideways = o.by_radius.tolist()
        by_radius.append((c * outwards - s * d * sideways, s * outwards + c * d * sideways))
    count = len(seen)
    return Sightings(
        seen,
        np.array(positions, float).reshape(count, 2),
        np.array(covariances, float).reshape(count, 2, 2),
        np.array([o.radius for o in seen], float),
        np.array([o.radius_sigma for o in seen], float),
        np.array(by_radius, float).reshape(count, 2),
    )
