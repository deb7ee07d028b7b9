"""Upright cylinders on the floor, located from the edges seen of them.

Unknown are the azimuth, the distance and the radius of the cylinder as the camera sees
them. Both sides give azimuth +- asin(radius / distance). Every rim gives slopes
(rim height - camera height) / (horizontal distance of the rim), with the near or the
far part of the rim at distance * cos(phi) -+ sqrt(radius^2 - (distance * sin(phi))^2)
in the direction phi off the axis. All are fused by Gauss-Newton with the full
covariance of the measurements: pixels, independent, and the pose of the camera, which
shifts all edges together.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import asin, atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from vision.outline import Rim, Side, independent
from vision.view import View

Array = NDArray[np.float64]

ITERATIONS = 3
MAX_RIMS = 3  # a beacon shows three
SIDES = 2
ROWS = SIDES + MAX_RIMS + 1  # two sides, the rims, the prior of the radius
INDEX = np.arange(ROWS)
NO_INFORMATION = 1e3  # standard deviation of what was not measured
RIM_WIDTH = 0.75  # share of the half width within which points of a rim are used
OUTER = 0.92  # share of the half width where a rim is too steep to predict
HIDDEN_WIDTH = 0.08  # how far a hidden side may reach beyond what is seen [m]
MIN_DISTANCE, MAX_DISTANCE = 0.10, 12.0  # [m]
MIN_RADIUS, MAX_RADIUS = 0.01, 0.5  # bounds of the iteration [m]
FAR_SLOPE = -0.5  # a thing whose foot is seen less steeply is far
MIN_SLOPE = 1e-6
UNIFORM = 12.0**0.5  # width of a pixel [standard deviations of an edge in it]
SHARED = 0.85  # axes nearer than this share of the radii's sum: the same place
MIN_CLEARANCE = 0.03  # a plane closer to the camera's own height gives no distance [m]


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, slots=True)
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


def interpenetrate(a: Cylinder, b: Cylinder) -> bool:
    """Whether two cylinders take up the same place, so that one of them is not real."""
    gap2 = (
        a.distance**2 + b.distance**2 - 2.0 * a.distance * b.distance * cos(a.azimuth - b.azimuth)
    )
    return gap2 < (SHARED * (a.radius + b.radius)) ** 2


def polar_in_robot(cylinder: Cylinder, view: View) -> tuple[float, float, Array]:
    """Distance [m], bearing [rad] and their covariance (2, 2) from the origin of R."""
    azimuth = cylinder.azimuth + view.heading
    x = view.x + cylinder.distance * cos(azimuth)
    y = view.y + cylinder.distance * sin(azimuth)
    distance = max(hypot(x, y), 1e-6)
    bearing = atan2(y, x)
    c, s = cos(azimuth - bearing), sin(azimuth - bearing)
    d = cylinder.distance
    (p_aa, p_ad, _), (_, p_dd, _), _ = cylinder.covariance.tolist()
    # Rows of the Jacobian of (distance, bearing) with respect to (azimuth, distance).
    (a, b), (e, f) = (-d * s, c), (d * c / distance, s / distance)
    cross = a * e * p_aa + (a * f + b * e) * p_ad + b * f * p_dd
    covariance = np.array(
        [
            [a * a * p_aa + 2.0 * a * b * p_ad + b * b * p_dd, cross],
            [cross, e * e * p_aa + 2.0 * e * f * p_ad + f * f * p_dd],
        ]
    )
    return distance, bearing, covariance


def locate(
    candidates: Sequence[Candidate],
    view: View,
    roundness_sigma: float = 0.01,
    edge_correlation: float = 0.1,
    stray: float = 3.5,
) -> list[Cylinder]:
    """Cylinders that explain the edges of each candidate best.

    Args:
        candidates: edges of one cylinder each; at least one rim, or both sides trusted.
        view: camera and pose.
        roundness_sigma: standard deviation of the outline relative to the radius [1].
        edge_correlation: correlation of the errors of two points of one edge [1].
        stray: deviation from a rim that makes a point stray [standard deviations].
    """
    if not candidates:
        return []
    return _Problem(candidates, view, roundness_sigma, edge_correlation).solve(stray)


class _Problem:
    """All candidates of one image, solved together: arrays over candidates (n, ...)."""

    def __init__(
        self,
        candidates: Sequence[Candidate],
        view: View,
        roundness_sigma: float,
        edge_correlation: float,
    ) -> None:
        n = len(candidates)
        self.n = n
        self.h: float = view.height
        pose = view.pose
        self.pose_variance = np.square(
            [pose.tilt_sigma, pose.roll_sigma, pose.yaw_sigma, pose.height_sigma]
        )
        sides = [side for c in candidates for side in (c.left, c.right)]
        self.common = edge_correlation
        rows = [(s.azimuth, s.sigma, s.count, s.low, s.high, s.trusted) for s in sides]
        columns = np.array(rows).T.reshape(6, n, SIDES)
        self.side, sigma, count, self.side_low, self.side_high, trusted = columns
        self.side_sigma = sigma * self._of_mean(count)
        self.slack = 0.5 * self.side_sigma
        self.trusted = trusted != 0.0
        known = np.array([(c.radius, c.radius_sigma, c.height) for c in candidates])
        self.prior, self.prior_sigma, self.top = known.T
        self.roundness = roundness_sigma
        self.rim_height = np.zeros((n, MAX_RIMS))
        self.rim_sign = np.ones((n, MAX_RIMS))
        self.rim_sigma = np.full((n, MAX_RIMS), NO_INFORMATION)
        azimuths, slopes, owners = [], [], []
        x = np.empty((n, 3))
        for k, candidate in enumerate(candidates):
            for j, cue in enumerate(candidate.rims):
                self.rim_height[k, j] = cue.height
                self.rim_sign[k, j] = 1.0 if cue.near else -1.0
                self.rim_sigma[k, j] = cue.rim.sigma
                azimuths.append(cue.rim.azimuth)
                slopes.append(cue.rim.slope)
                owners.append((k * MAX_RIMS + j, len(cue.rim.azimuth)))
            x[k] = self._guess(candidate)
        self.x = x
        rim = np.repeat([o for o, _ in owners], [m for _, m in owners]) if owners else np.zeros(0)
        self._keep_inner(
            np.concatenate(azimuths) if azimuths else np.zeros(0),
            np.concatenate(slopes) if slopes else np.zeros(0),
            rim.astype(np.intp),
        )

    def _guess(self, candidate: Candidate) -> tuple[float, float, float]:
        """First azimuth, distance and radius."""
        left, right, radius = candidate.left, candidate.right, candidate.radius
        half = max(0.5 * (left.azimuth - right.azimuth), 1e-3)
        distance = self._guess_distance(candidate.rims, radius)
        if distance is None:
            distance = radius / sin(min(half, 1.2))
        if left.trusted and right.trusted:
            radius = distance * sin(min(half, 1.2))
            radius = min(max(radius, 0.7 * candidate.radius), 1.5 * candidate.radius)
        distance = max(distance, MIN_DISTANCE + radius)
        azimuth = 0.5 * (left.azimuth + right.azimuth)
        if left.trusted != right.trusted:
            reach = asin(min(radius / distance, 0.9))
            azimuth = left.azimuth - reach if left.trusted else right.azimuth + reach
        return azimuth, distance, radius

    def _guess_distance(self, rims: Sequence[RimCue], radius: float) -> float | None:
        """First distance from the rims; None if they tell none."""
        usable = [
            (cue, float(cue.rim.slope[cue.rim.slope.size // 2]))
            for cue in rims
            if cue.rim.slope.size and abs(cue.height - self.h) >= MIN_CLEARANCE
        ]
        usable.sort(key=lambda pair: pair[0].height)
        if not usable:
            return None
        (lowest, low), (highest, high) = usable[0], usable[-1]
        if low > FAR_SLOPE and high > low:
            # Far away an error of the tilt spoils each slope, but not their difference.
            return float(min((highest.height - lowest.height) / (high - low), MAX_DISTANCE))
        for cue, slope in usable:
            run = (cue.height - self.h) / (slope or MIN_SLOPE)
            if MIN_DISTANCE < run < MAX_DISTANCE:
                return run + (radius if cue.near else -radius)
        return None

    def _keep_inner(self, azimuth: Array, slope: Array, rim: NDArray[np.intp]) -> None:
        """Keep the points of each rim that are not near its ends."""
        theta, d, r = self.x[rim // MAX_RIMS].T
        t = np.sin(azimuth - theta) * d / r
        inner = np.abs(t) < RIM_WIDTH
        clearance = np.abs(self.rim_height.ravel()[rim] - self.h) >= MIN_CLEARANCE
        keep = inner & clearance
        self.azimuth, self.slope, self.rim = azimuth[keep], slope[keep], rim[keep]
        self.owner = self.rim // MAX_RIMS
        size = self.n * MAX_RIMS
        self.count = np.bincount(self.rim, minlength=size)
        self.share = 1.0 / np.maximum(self.count, 1)
        count = self.count.reshape(self.n, MAX_RIMS)
        self.seen = count > 0
        span = self._span(size).reshape(self.n, MAX_RIMS)
        own = independent(np.maximum(count, 1), span / (UNIFORM * self.rim_sigma))
        self.rim_mean_sigma = self.rim_sigma * self._of_mean(own)
        self.drop = self.rim_height.ravel()[self.rim] - self.h
        self.sign = self.rim_sign.ravel()[self.rim]
        self.level = np.maximum(0.5 * (self.side_low + self.side_high), -3.0)
        self.G = np.zeros((self.n, ROWS, 4))
        self.G[:, :SIDES, 2] = 1.0

    def _span(self, size: int) -> Array:
        """Difference of the greatest and the smallest slope of each rim (3 n,)."""
        low, high = np.full(size, np.inf), np.full(size, -np.inf)
        np.minimum.at(low, self.rim, self.slope)
        np.maximum.at(high, self.rim, self.slope)
        span: Array = np.maximum(high - low, 0.0)
        return span

    def _of_mean(self, count: Array) -> Array:
        """Standard deviation of the mean of so many points, relative to that of one."""
        sigma: Array = np.sqrt(self.common + (1.0 - self.common) / count)
        return sigma

    def _mean(self, values: Array) -> Array:
        """Mean over the points of each rim (n, 3), 0 where there are none."""
        total = np.bincount(self.rim, weights=values, minlength=len(self.share))
        return (total * self.share).reshape(self.n, MAX_RIMS)

    def solve(self, stray: float) -> list[Cylinder]:
        """Cylinders of all candidates; `stray` as for `locate`."""
        H = np.zeros((self.n, ROWS, 3))
        H[:, 0, 0] = H[:, 1, 0] = H[:, 5, 2] = 1.0
        residual = np.empty((self.n, ROWS))
        before = None
        for _ in range(ITERATIONS):
            point_residual = self._linearise(H, residual)
            if self._check_sides() or before is None or self._moved(before):
                weight = np.linalg.inv(self._measurement_covariance())
                before = self.x
            HtW = H.swapaxes(1, 2) @ weight
            covariance = np.linalg.inv(HtW @ H)
            self.x = self._bounded(self.x + (covariance @ (HtW @ residual[:, :, None]))[:, :, 0])
        misfit = ((residual[:, None, :] @ weight)[:, 0] * residual).sum(axis=1).tolist()
        astray = self._astray(point_residual, residual[:, SIDES:5], stray).tolist()
        return [
            Cylinder(azimuth, distance, radius, covariance[k], misfit[k], astray[k])
            for k, (azimuth, distance, radius) in enumerate(self.x.tolist())
        ]

    @staticmethod
    def _bounded(x: Array) -> Array:
        radius = np.minimum(np.maximum(x[:, 2], MIN_RADIUS), MAX_RADIUS)
        nearest = np.maximum(1.1 * radius, MIN_DISTANCE)
        x[:, 1] = np.minimum(np.maximum(x[:, 1], nearest), MAX_DISTANCE)
        x[:, 2] = radius
        return x

    def _moved(self, before: Array) -> bool:
        """Whether distances changed so much that the covariance must follow."""
        change: Array = np.abs(self.x[:, 1] - before[:, 1])
        return bool((change > 0.1 * self.x[:, 1]).any())

    def _check_sides(self) -> bool:
        """Distrust sides not seen between foot and head; tell whether there are any new."""
        d, r = self.x[:, 1], self.x[:, 2]
        reach = np.sqrt(d * d - r * r)
        foot, head = (-self.h / reach)[:, None], ((self.top - self.h) / reach)[:, None]
        slack = self.slack
        seen = (self.side_high >= foot - slack) & (self.side_low <= head + slack)
        lost = bool((self.trusted & ~seen).any())
        self.trusted &= seen
        return lost

    def _linearise(self, H: Array, residual: Array) -> Array:
        """Fill the Jacobian and the residuals; return the residual of every rim point."""
        theta, d, r = self.x.T
        reach = np.sqrt(d * d - r * r)
        half = np.arcsin(r / d)
        residual[:, 0] = self.side[:, 0] - theta - half
        residual[:, 1] = self.side[:, 1] - theta + half
        H[:, 0, 1] = -r / (d * reach)
        H[:, 0, 2] = 1.0 / reach
        H[:, 1, 1:] = -H[:, 0, 1:]
        residual[:, 5] = self.prior - r
        return self._rims(H, residual)

    def _rims(self, H: Array, residual: Array) -> Array:
        """Fill the rows of the rims; return the residual of every point."""
        theta, d, r = self.x.T.take(self.owner, axis=1)
        phi = self.azimuth - theta
        sine, cosine = np.sin(phi), np.cos(phi)
        t = np.minimum(np.maximum(d * sine / r, -OUTER), OUTER)
        c = np.sqrt(1.0 - t * t)
        lean = self.sign * t / c
        run = np.maximum(d * cosine - self.sign * r * c, 0.02)
        slope = self.drop / run
        point_residual: Array = self.slope - slope
        gain = -slope / run  # d slope / d run
        residual[:, SIDES:5] = self._mean(point_residual)
        H[:, SIDES:5, 0] = self._mean(gain * d * (sine - lean * cosine))
        H[:, SIDES:5, 1] = self._mean(gain * (cosine + lean * sine))
        H[:, SIDES:5, 2] = self._mean(-gain * self.sign / c)
        return point_residual

    def _measurement_covariance(self) -> Array:
        """Covariance of the rows (n, 6, 6): pixels, roundness and pose of the camera."""
        n = self.n
        theta, d, r = self.x.T
        hidden = (HIDDEN_WIDTH / d)[:, None]
        sigma = np.full((n, ROWS), NO_INFORMATION)
        round_sigma = (self.roundness * r / d)[:, None]
        sigma[:, :SIDES] = np.where(self.trusted, np.hypot(self.side_sigma, round_sigma), hidden)
        slope = (self.rim_height - self.h) / d[:, None]
        sigma[:, SIDES:5] = np.where(
            self.seen, np.hypot(self.rim_mean_sigma, slope * round_sigma), NO_INFORMATION
        )
        sigma[:, 5] = self.prior_sigma
        # Small rotations of the camera: tilt about its left, roll about its heading,
        # yaw; and an error of its height.
        G, level = self.G, self.level
        s, c = np.sin(theta)[:, None], np.cos(theta)[:, None]
        G[:, :SIDES, 0] = -level * s
        G[:, :SIDES, 1] = -level * c
        lift = 1.0 + slope * slope
        G[:, SIDES:5, 0] = -lift * c
        G[:, SIDES:5, 1] = lift * s
        G[:, SIDES:5, 3] = -1.0 / d[:, None]
        R: Array = (G * self.pose_variance) @ G.swapaxes(1, 2)
        R[:, INDEX, INDEX] += sigma * sigma
        return R

    def _astray(self, residual: Array, mean: Array, stray: float) -> Array:
        """Share of rim points of each candidate off their rim."""
        limit = stray * self.rim_sigma.ravel()[self.rim]
        far = np.abs(residual - mean.ravel()[self.rim]) > limit
        strays = np.bincount(self.owner, weights=far, minlength=self.n)
        total = np.bincount(self.owner, minlength=self.n)
        share: Array = strays / np.maximum(total, 1)
        return share
