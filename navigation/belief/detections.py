"""Obstacle detections of one frame, transformed from R to W with their covariance."""

from collections.abc import Sequence
from math import cos, inf, sin, tanh
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from navigation.observation import Observation

Array = NDArray[np.float64]
Rows = NDArray[np.record]


@record_class
class DetectionRecord:
    """Detection in W."""

    position: Annotated[Array, 2]  # [m]
    covariance: Annotated[Array, 2, 2]  # of the position, pose uncertainty included [m²]
    radius: float  # [m]
    radius_sigma: float  # standard deviation of the radius [m]
    by_radius: Annotated[Array, 2]  # partial derivatives of the position by the radius [1]
    distance: float  # from the robot [m]
    partial: bool  # whether the obstacle is visible in part only


class Detections(NamedTuple):
    """Obstacle detections of one frame in W.

    Attributes:
        rows: records of type `DetectionRecord` (m,).
        labels: colour classes (m).
    """

    rows: Rows
    labels: tuple[str, ...]

    @property
    def positions(self) -> Array:
        """Positions in W (m, 2) [m]."""
        return np.ascontiguousarray(self.rows["position"])

    @property
    def radii(self) -> Array:
        """Radii (m,) [m]."""
        return np.ascontiguousarray(self.rows["radius"])


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
        observations: observations of one frame.
        pose: x, y, heading of R in W (3,) [m, m, rad].
        pose_covariance: (3, 3); scaled down as a whole to `max_pose_sigma`.
        max_pose_sigma: maximum standard deviation of the position [m].
    """
    obstacles = [o for o in observations if o.kind == "obstacle"]
    x, y, heading = pose.tolist()
    variance = max(float(pose_covariance[0, 0]), float(pose_covariance[1, 1]), 1e-12)
    P = (pose_covariance * min(1.0, max_pose_sigma**2 / variance)).tolist()
    rows = []
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
        radial, angular = o.by_radius.tolist()
        slope = (c * radial - s * d * angular, s * radial + c * d * angular)
        position, covariance = (x + d * c, y + d * s), ((xx, xy), (xy, yy))
        partial = o.cut or o.occluded
        rows.append((position, covariance, o.radius, o.radius_sigma, slope, d, partial))
    return Detections(np.array(rows, DetectionRecord), tuple(o.label for o in obstacles))


@compiled
def given_radius(d: np.record, radius: float, sigma: float) -> tuple[Array, Array]:
    """Return position (2,) [m] and covariance (2, 2) [m²] of a detection, given its radius.

    Args:
        d: record of type `DetectionRecord`.
        radius: known radius [m].
        sigma: standard deviation of `radius` [m].
    """
    position, covariance, slope = np.empty(2), np.empty((2, 2)), d.by_radius
    added = sigma * sigma - d.radius_sigma * d.radius_sigma
    for a in range(2):
        position[a] = d.position[a] + (radius - d.radius) * slope[a]
        for b in range(2):
            covariance[a, b] = d.covariance[a, b] + added * (slope[a] * slope[b])
    return position, covariance


@compiled
def variance_inflation(dt: float, correlation_time: float) -> float:
    """Return the inflation (1 + a)/(1 - a) = coth(dt/(2 tau)) of a measurement's variance, >= 1.

    Consecutive camera frames share the error of the camera's pitch. For an error with
    autocorrelation a = exp(-dt/tau) the variance of a mean decays (1 + a)/(1 - a) times slower
    than for white noise; a filter whose measurement variances are inflated by this factor
    remains consistent.

    Args:
        dt: time since the previous measurement of the same object, > 0, may be infinite [s].
        correlation_time: tau [s].
    """
    if correlation_time <= 0.0 or dt == inf:
        return 1.0
    return 1.0 / tanh(0.5 * dt / correlation_time)
