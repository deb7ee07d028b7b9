"""Pose estimation of upright cylinders on the floor from their silhouette edges.

The unknowns are azimuth, distance and radius of the cylinder relative to the camera. The two
sides measure azimuth +- asin(radius / distance). Every rim point measures a slope
(rim height - camera height) / (horizontal distance of the rim), with the near or far half of
the rim at distance * cos(phi) -+ sqrt(radius^2 - (distance * sin(phi))^2) in the direction phi
off the axis. Gauss-Newton fuses the sides and the mean slope of each rim with their full
covariance: independent pixel errors and motion blur, and the error of the camera pose common to all
edges; the deviations of the rim's points from their mean add the shape of the rim.
"""

from collections.abc import Sequence
from math import asin, atan2, cos, hypot, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.tables import LEFT, RIGHT

Array = NDArray[np.float64]
Rows = NDArray[np.record]

# Bounds in units of length.
MIN_CLEARANCE = 0.03  # minimum height difference of camera and rim to measure distance
MIN_DISTANCE, MAX_DISTANCE = 0.10, 12.0
MIN_HALF, MAX_HALF = 1e-3, 1.2  # bounds of the initial half width [rad]
FAR_SLOPE = -0.5  # slope of the foot above which a cylinder is far
MIN_SLOPE = 1e-6
SPAN_SIGMA = 0.02  # minimum relative standard deviation of a distance from a span [1]


@compiled
def interpenetrate(a: Array, b: Array, tolerance: float, min_separation: float) -> bool:
    """Return whether two cylinders interpenetrate, so that one must be a false detection.

    Args:
        a: azimuth [rad], distance and radius [m] of one cylinder (3,).
        b: the same of another cylinder (3,).
        tolerance: of the difference of their distances [m].
        min_separation: minimum distance of the axes, relative to the sum of the radii [1].
    """
    along = max(abs(a[1] - b[1]) - tolerance, 0.0)
    across = 2.0 * min(a[1], b[1]) * sin(0.5 * (a[0] - b[0]))
    separation = min_separation * (a[2] + b[2])
    return bool(along * along + across * across < separation * separation)


def polar_in_robot(
    cylinder: Sequence[float],
    covariance: Sequence[Sequence[float]],
    camera: Sequence[float],
) -> tuple[float, float, Array, Array]:
    """Return polar coordinates of the axis of a cylinder in R.

    Args:
        cylinder: azimuth from the heading of the camera [rad], distance and radius [m].
        covariance: their covariance (3, 3).
        camera: position x, y [m] and heading [rad] in R.

    Returns:
        Distance [m] and bearing [rad], their covariance (2, 2), and their partial derivatives
        with respect to the radius (2,) [1, rad/m].
    """
    azimuth, d = cylinder[0] + camera[2], cylinder[1]
    x, y = camera[0] + d * cos(azimuth), camera[1] + d * sin(azimuth)
    distance = max(hypot(x, y), 1e-6)
    bearing = atan2(y, x)
    c, s = cos(azimuth - bearing), sin(azimuth - bearing)
    (p_aa, p_ad, p_ar), (_, p_dd, p_dr), (_, _, p_rr) = covariance
    # Rows of the Jacobian of (distance, bearing) with respect to (azimuth, distance).
    (a, b), (e, f) = (-d * s, c), (d * c / distance, s / distance)
    cross = a * e * p_aa + (a * f + b * e) * p_ad + b * f * p_dd
    polar = np.array(
        [
            [a * a * p_aa + 2.0 * a * b * p_ad + b * b * p_dd, cross],
            [cross, e * e * p_aa + 2.0 * e * f * p_ad + f * f * p_dd],
        ]
    )
    by_radius = np.array([(a * p_ar + b * p_dr) / p_rr, (e * p_ar + f * p_dr) / p_rr])
    return distance, bearing, polar, by_radius


@compiled
def _rim_distance(candidate: np.record, h: float) -> float:
    """Return the distance measured by the rims, 0 if none does [unit]."""
    rims = candidate.rims
    lowest = highest = -1
    for j in range(candidate.rim_count):
        if abs(rims[j].height - h) >= MIN_CLEARANCE:
            lowest = j if lowest < 0 else lowest
            highest = j
    if lowest < 0:
        return 0.0
    low, high = rims[lowest], rims[highest]
    if low.middle > FAR_SLOPE and high.middle > low.middle and candidate.height_sigma == 0.0:
        # Far away the difference of the slopes is more robust against a tilt error.
        return float(min((high.height - low.height) / (high.middle - low.middle), MAX_DISTANCE))
    for j in range(lowest, highest + 1):
        rim, middle = rims[j], rims[j].middle
        if abs(rim.height - h) < MIN_CLEARANCE:
            continue
        run = (rim.height - h) / (middle if middle != 0.0 else MIN_SLOPE)
        if MIN_DISTANCE < run < MAX_DISTANCE:
            return float(run + rim.half * candidate.prior[0])
    return 0.0


@compiled
def _span(candidate: np.record, h: float) -> tuple[float, float]:
    """Return the distance to the only trusted side and its standard deviation, else 0 [unit].

    The visible span of the side lies between foot and head. Of a close cylinder at the border
    of the image often neither is visible.
    """
    left, right, height = candidate.sides[LEFT], candidate.sides[RIGHT], candidate.height
    if left.trusted == right.trusted:
        return 0.0, 0.0
    side = left if left.trusted else right
    if h <= height or side.high >= -MIN_SLOPE or side.low >= side.high:
        return 0.0, 0.0
    farthest, nearest = -h / side.low, (height - h) / side.high
    middle = 0.5 * (farthest + nearest)
    own, width = SPAN_SIGMA * middle, farthest - nearest
    return middle, sqrt(own * own + width * width / 12.0)


@compiled
def guess(candidate: np.record, h: float) -> tuple[float, float]:
    """Set the first cylinder of a candidate.

    Args:
        candidate: record of type `Candidate`.
        h: height of the camera [unit].

    Returns:
        Distance to the only trusted side and its standard deviation, 0 if unknown [unit].
    """
    left, right, radius = candidate.sides[LEFT], candidate.sides[RIGHT], candidate.prior[0]
    distance, (span, span_sigma) = _rim_distance(candidate, h), _span(candidate, h)
    half = min(max(0.5 * (left.azimuth - right.azimuth), MIN_HALF), MAX_HALF)
    if distance == 0.0:
        distance = span if span != 0.0 else radius / sin(half)
    if left.trusted and right.trusted:
        radius = min(max(distance * sin(half), 0.7 * radius), 1.5 * radius)
    distance = max(distance, MIN_DISTANCE + radius)
    azimuth = 0.5 * (left.azimuth + right.azimuth)
    if left.trusted != right.trusted:
        reach = asin(min(radius / distance, 0.9))
        azimuth = left.azimuth - reach if left.trusted else right.azimuth + reach
    x = candidate.cylinder
    x[0], x[1], x[2] = azimuth, distance, radius
    return span, span_sigma
