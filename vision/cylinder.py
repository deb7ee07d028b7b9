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
from compilation.value import value
from vision.cylinder_fit import fit
from vision.outline import Rim, Side
from vision.view import View

Array = NDArray[np.float64]

MIN_CLEARANCE = 0.03  # minimum height difference of camera and rim to measure distance [m]
LIMITS = np.array([MIN_CLEARANCE, 0.10, 12.0])  # and minimum and maximum distance [m]

Table = NDArray[np.int64]
MIN_HALF, MAX_HALF = 1e-3, 1.2  # bounds of the initial half width [rad]
FAR_SLOPE = -0.5  # slope of the foot above which a cylinder is far
MIN_SLOPE = 1e-6
SPAN_SIGMA = 0.02  # minimum relative standard deviation of a distance from a span [1]


@value
class RimCue:
    """Rim edge of a cylinder.

    Attributes:
        rim: points.
        height: height of the rim above the floor [m].
        near: near half of the circle, else the far half.
    """

    rim: Rim
    height: float
    near: bool


@value
class Candidate:
    """Edges of one cylinder hypothesis.

    Attributes:
        left, right: sides of larger and smaller azimuth.
        rims: rim edges, at most three.
        height: height of the cylinder [m].
        radius: known or typical radius [m].
        radius_sigma: its standard deviation [m].
    """

    left: Side
    right: Side
    rims: tuple[RimCue, ...]
    height: float
    radius: float
    radius_sigma: float


@value
class Cylinder:
    """Located cylinder relative to the camera.

    Attributes:
        azimuth: azimuth of the axis from the heading of the camera [rad].
        distance: horizontal, from the camera to the axis [m].
        radius: [m].
        covariance: covariance of (azimuth, distance, radius) (3, 3).
        misfit: sum of squared normalized residuals of the edges [1].
        outlier_fraction: fraction of outliers among the rim points [1].
    """

    azimuth: float
    distance: float
    radius: float
    covariance: Array
    misfit: float
    outlier_fraction: float


def interpenetrate(a: Cylinder, b: Cylinder, min_separation: float) -> bool:
    """Return whether two cylinders interpenetrate, so that one must be a false detection.

    Args:
        a: one cylinder.
        b: another cylinder.
        min_separation: minimum distance of the axes, relative to the sum of the radii [1].
    """
    gap2 = (
        a.distance**2 + b.distance**2 - 2.0 * a.distance * b.distance * cos(a.azimuth - b.azimuth)
    )
    return gap2 < (min_separation * (a.radius + b.radius)) ** 2


def polar_in_robot(cylinder: Cylinder, view: View) -> tuple[float, float, Array, Array]:
    """Return polar coordinates of the axis in R.

    Returns:
        Distance [m] and bearing [rad], their covariance (2, 2), and their partial derivatives
        with respect to the radius (2,) [1, rad/m].
    """
    azimuth = cylinder.azimuth + view.heading
    x = view.x + cylinder.distance * cos(azimuth)
    y = view.y + cylinder.distance * sin(azimuth)
    distance = max(hypot(x, y), 1e-6)
    bearing = atan2(y, x)
    c, s = cos(azimuth - bearing), sin(azimuth - bearing)
    d = cylinder.distance
    (p_aa, p_ad, p_ar), (_, p_dd, p_dr), (_, _, p_rr) = cylinder.covariance.tolist()
    # Rows of the Jacobian of (distance, bearing) with respect to (azimuth, distance).
    (a, b), (e, f) = (-d * s, c), (d * c / distance, s / distance)
    cross = a * e * p_aa + (a * f + b * e) * p_ad + b * f * p_dd
    covariance = np.array(
        [
            [a * a * p_aa + 2.0 * a * b * p_ad + b * b * p_dd, cross],
            [cross, e * e * p_aa + 2.0 * e * f * p_ad + f * f * p_dd],
        ]
    )
    by_radius = np.array([a * p_ar + b * p_dr, e * p_ar + f * p_dr]) / p_rr
    return distance, bearing, covariance, by_radius


def locate(
    candidates: Sequence[Candidate],
    view: View,
    roundness_sigma: float,
    edge_correlation: float,
    outlier_threshold: float,
    *,
    unit: float = 1.0,
) -> list[Cylinder]:
    """Return the cylinder that fits the edges of each candidate best (least squares).

    Args:
        candidates: edges of one cylinder each; at least one rim or one trusted side.
        view: camera and pose.
        roundness_sigma: standard deviation of the outline relative to the radius [1].
        edge_correlation: correlation of the errors of two points of one edge [1].
        outlier_threshold: deviation of an outlier from its rim [standard deviations].
        unit: unit of length, in which the bounds of the kernel are given [m].
    """
    if not candidates:
        return []
    sides: list[float] = []
    known: list[float] = []
    rims: list[float] = []
    azimuths, slopes = [], []
    first_rims, points = [0], [0]
    for candidate in candidates:
        for side in (candidate.left, candidate.right):
            sides += side.azimuth, side.sigma, side.count, side.low, side.high, side.trusted
        known += candidate.radius, candidate.radius_sigma, candidate.height
        for cue in sorted(candidate.rims, key=lambda cue: cue.height):
            rim = cue.rim
            rims += cue.height, 1.0 if cue.near else -1.0, rim.sigma
            azimuths.append(rim.azimuth)
            slopes.append(rim.slope)
            points.append(points[-1] + len(rim.slope))
        first_rims.append(len(slopes))
    height = view.height / unit
    tilt, roll, yaw, lift, pan_smear, tilt_smear = view.errors
    edges = (
        np.array(sides).reshape(-1, 2, 6),
        np.array(known).reshape(-1, 3) / unit,
        np.array(rims, float).reshape(-1, 3) / (unit, 1.0, 1.0),
        np.array(first_rims),
        np.array(points),
    )
    slope = np.concatenate(slopes) if slopes else np.empty(0)
    first = guess(*edges, slope, height, LIMITS)
    result, covariances = fit(
        *edges,
        np.concatenate(azimuths) if azimuths else np.empty(0),
        slope,
        np.array(
            [
                height,
                tilt**2,
                roll**2,
                yaw**2,
                (lift / unit) ** 2,
                # Motion blur: the error of an edge is uniform over the smear.
                pan_smear**2 / 12.0,
                tilt_smear**2 / 12.0,
            ]
        ),
        np.array([roundness_sigma, edge_correlation, outlier_threshold, *LIMITS]),
        *first,
    )
    return [
        Cylinder(azimuth, distance, radius, covariance, misfit, outlier_fraction)
        for (azimuth, distance, radius, misfit, outlier_fraction), covariance in zip(
            (result * (1.0, unit, unit, 1.0, 1.0)).tolist(),
            covariances * np.outer((1.0, unit, unit), (1.0, unit, unit)),
            strict=True,
        )
    ]


@compiled
def _rim_distance(
    rims: Array, points: Table, slope: Array, h: float, radius: float, limits: Array
) -> float:
    """Return the distance measured by the rims, 0 if none does; see `guess` [m]."""
    clearance, min_distance, max_distance = limits[0], limits[1], limits[2]
    lowest = highest = -1
    for j in range(len(rims)):
        if points[j] < points[j + 1] and abs(rims[j, 0] - h) >= clearance:
            lowest = j if lowest < 0 else lowest
            highest = j
    if lowest < 0:
        return 0.0
    low = slope[(points[lowest] + points[lowest + 1]) // 2]
    high = slope[(points[highest] + points[highest + 1]) // 2]
    if low > FAR_SLOPE and high > low:
        # Far away the difference of the slopes is more robust against a tilt error.
        return float(min((rims[highest, 0] - rims[lowest, 0]) / (high - low), max_distance))
    for j in range(lowest, highest + 1):
        if points[j] == points[j + 1] or abs(rims[j, 0] - h) < clearance:
            continue
        middle = slope[(points[j] + points[j + 1]) // 2]
        run = (rims[j, 0] - h) / (middle if middle != 0.0 else MIN_SLOPE)
        if min_distance < run < max_distance:
            return float(run + rims[j, 1] * radius)
    return 0.0


@compiled
def _span(sides: Array, height: float, h: float) -> tuple[float, float]:
    """Return the distance to the only trusted side and its standard deviation, 0, 0 if none [m].

    The visible span of the side lies between foot and head. Of a close cylinder at the border
    of the image often neither is visible.
    """
    if (sides[0, 5] != 0.0) == (sides[1, 5] != 0.0):
        return 0.0, 0.0
    low, high = sides[0, 3], sides[0, 4]
    if sides[1, 5] != 0.0:
        low, high = sides[1, 3], sides[1, 4]
    if h <= height or high >= -MIN_SLOPE or low >= high:
        return 0.0, 0.0
    farthest, nearest = -h / low, (height - h) / high
    middle = 0.5 * (farthest + nearest)
    own, width = SPAN_SIGMA * middle, farthest - nearest
    return middle, sqrt(own * own + width * width / 12.0)


@compiled
def _cylinder(x: Array, sides: Array, radius: float, distance: float, min_distance: float) -> None:
    """Write azimuth, distance and radius x (3,); `distance` 0 if unknown [m]."""
    typical, left, right = radius, sides[0, 0], sides[1, 0]
    left_trusted, right_trusted = sides[0, 5] != 0.0, sides[1, 5] != 0.0
    half = min(max(0.5 * (left - right), MIN_HALF), MAX_HALF)
    if distance == 0.0:
        distance = radius / sin(half)
    if left_trusted and right_trusted:
        radius = min(max(distance * sin(half), 0.7 * typical), 1.5 * typical)
    distance = max(distance, min_distance + radius)
    azimuth = 0.5 * (left + right)
    if left_trusted != right_trusted:
        reach = asin(min(radius / distance, 0.9))
        azimuth = left - reach if left_trusted else right + reach
    x[0], x[1], x[2] = azimuth, distance, radius


@compiled
def guess(
    sides: Array,
    known: Array,
    rims: Array,
    first_rims: Table,
    points: Table,
    slope: Array,
    h: float,
    limits: Array,
) -> tuple[Array, Array]:
    """Return a first cylinder for each candidate; arguments as for `cylinder_fit.fit`.

    Returns:
        Azimuth [rad], distance [m] and radius [m] (n, 3); distance to the only trusted side and
        its standard deviation, 0 if unknown (n, 2) [m].
    """
    n = len(sides)
    cylinders, spans = np.empty((n, 3)), np.empty((n, 2))
    for k in range(n):
        first, last = first_rims[k], first_rims[k + 1]
        ends, radius = points[first : last + 1], known[k, 0]
        distance = _rim_distance(rims[first:last], ends, slope, h, radius, limits)
        spans[k, 0], spans[k, 1] = _span(sides[k], known[k, 2], h)
        distance = spans[k, 0] if distance == 0.0 else distance
        _cylinder(cylinders[k], sides[k], radius, distance, limits[1])
    return cylinders, spans
