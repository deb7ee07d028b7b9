"""Upright cylinders on the floor, located from the edges seen of them.

Unknown are the azimuth, the distance and the radius of the cylinder as the camera sees
them. Both sides give azimuth +- asin(radius / distance). Every rim gives slopes
(rim height - camera height) / (horizontal distance of the rim), with the near or the
far part of the rim at distance * cos(phi) -+ sqrt(radius^2 - (distance * sin(phi))^2)
in the direction phi off the axis. All are fused by Gauss-Newton with the full
covariance of the measurements: pixels and what smears an edge, independent, and the pose
of the camera, which shifts all edges together.
"""

from collections.abc import Sequence
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from vision import cylinder_kernel
from vision.outline import Rim, Side
from vision.value import value
from vision.view import View

Array = NDArray[np.float64]


@value
class RimCue:
    """A rim taken for an edge of the cylinder.

    Attributes:
        rim: the points.
        height: of the rim above the floor [m].
        near: it is the near half of the circle and not the far one.
    """

    rim: Rim
    height: float
    near: bool


@value
class Candidate:
    """Edges that belong to one cylinder.

    Attributes:
        left, right: sides of greater and smaller azimuth.
        rims: at most three.
        height: of the cylinder [m].
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
    """A located cylinder, seen from the camera.

    Attributes:
        azimuth: of the axis from the heading of the camera [rad].
        distance: horizontal, from the camera to the axis [m].
        radius: [m].
        covariance: of (azimuth, distance, radius) (3, 3).
        misfit: sum of squared normalised residuals of the edges [1].
        astray: share of rim points that do not follow the rim of one cylinder [1].
    """

    azimuth: float
    distance: float
    radius: float
    covariance: Array
    misfit: float
    astray: float


def interpenetrate(a: Cylinder, b: Cylinder, shared: float) -> bool:
    """Whether two cylinders take up the same place, so that one of them is not real.

    Args:
        a: one cylinder.
        b: another.
        shared: axes nearer than this share of the sum of the radii are in the same place.
    """
    gap2 = (
        a.distance**2 + b.distance**2 - 2.0 * a.distance * b.distance * cos(a.azimuth - b.azimuth)
    )
    return gap2 < (shared * (a.radius + b.radius)) ** 2


def polar_in_robot(cylinder: Cylinder, view: View) -> tuple[float, float, Array, Array]:
    """The axis from the origin of R.

    Returns:
        Distance [m] and bearing [rad], their covariance (2, 2), and by how much they would be
        greater were the radius known to be greater (2,) [1, rad/m].
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
    stray: float,
) -> list[Cylinder]:
    """Cylinders that explain the edges of each candidate best.

    Args:
        candidates: edges of one cylinder each; at least one rim or one side trusted.
        view: camera and pose.
        roundness_sigma: standard deviation of the outline relative to the radius [1].
        edge_correlation: correlation of the errors of two points of one edge [1].
        stray: deviation from a rim that makes a point stray [standard deviations].
    """
    if not candidates:
        return []
    sides: list[float] = []
    known: list[float] = []
    rims: list[float] = []
    azimuths, slopes = [], []
    owned, points = [0], [0]
    for candidate in candidates:
        for side in (candidate.left, candidate.right):
            sides += side.azimuth, side.sigma, side.count, side.low, side.high, side.trusted
        known += candidate.radius, candidate.radius_sigma, candidate.height
        for cue in sorted(candidate.rims, key=_height):
            rim = cue.rim
            rims += cue.height, 1.0 if cue.near else -1.0, rim.sigma
            azimuths.append(rim.azimuth)
            slopes.append(rim.slope)
            points.append(points[-1] + len(rim.slope))
        owned.append(len(slopes))
    pose = view.pose
    result, covariances = cylinder_kernel.locate(
        np.array(sides).reshape(-1, 2, 6),
        np.array(known).reshape(-1, 3),
        np.array(rims, float).reshape(-1, 3),
        np.array(owned),
        np.array(points),
        np.concatenate(azimuths) if azimuths else np.empty(0),
        np.concatenate(slopes) if slopes else np.empty(0),
        np.array(
            [
                view.height,
                pose.tilt_sigma**2,
                pose.roll_sigma**2,
                pose.yaw_sigma**2,
                pose.height_sigma**2,
                # An edge lies anywhere within what it is smeared over.
                pose.pan_smear**2 / 12.0,
                pose.tilt_smear**2 / 12.0,
            ]
        ),
        np.array([roundness_sigma, edge_correlation, stray]),
    )
    return [
        Cylinder(azimuth, distance, radius, covariance, misfit, astray)
        for (azimuth, distance, radius, misfit, astray), covariance in zip(
            result.tolist(), covariances, strict=True
        )
    ]


def _height(cue: RimCue) -> float:
    return cue.height
