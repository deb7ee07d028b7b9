"""Gauss-Newton steps of the pose estimation of cylinders."""

from math import asin, cos, inf, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.cylinder import MAX_DISTANCE, MIN_CLEARANCE, MIN_DISTANCE, guess
from vision.outline import independent
from vision.tables import ANY, MAX_RIMS, Points, mean_height

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Rows = NDArray[np.record]

ITERATIONS = 4
SIDES = 2
UNIFORM = sqrt(12.0)  # width of a pixel [standard deviations of an edge in it]
PRIOR = SIDES + MAX_RIMS  # row of the prior of the radius
SPAN = PRIOR + 1  # row of the span of a side
ROWS = SPAN + 1
NO_INFORMATION = 1e3  # standard deviation of a missing measurement
RIM_WIDTH = 0.75  # fraction of the half width within which points of a rim are used
OUTER = 0.92  # fraction of the half width beyond which a rim is too steep to predict
HIDDEN_WIDTH = 0.08  # standard deviation of an occluded side [m]
MIN_RADIUS, MAX_RADIUS = 0.01, 0.5  # bounds of the iteration [m]
MIN_RUN = 0.02  # [m]
MIN_SLOPE_OF_SIDE = -3.0  # minimum slope of the middle of a side
PARTS = 4.0  # of a rim with independent errors by the roundness of the cylinder


@compiled
def _of_mean(count: float, common: float) -> float:
    """Return the standard deviation of the mean of `count` points, relative to that of one."""
    return sqrt(common + (1.0 - common) / count)


@compiled
def _keep_inner(
    keep: Bools,
    mean_sigma: Array,
    point_variance: Array,
    candidate: np.record,
    points: Points,
    h: float,
    p: np.record,
) -> int:
    """Select the rim points away from the ends of their rim; return their number.

    Writes which points to `keep`; for each rim the standard deviation of the mean slope to
    `mean_sigma` (3,) [1], and the variance of a point's deviation from this mean to
    `point_variance` (3,) [1], larger by the number of points per independent one.
    """
    theta, d, r = candidate.cylinder
    azimuth, slope, outer = points
    used = 0
    mean_sigma[:] = NO_INFORMATION
    for j in range(candidate.rim_count):
        rim = candidate.rims[j]
        count, low, high = 0, inf, -inf
        clear = abs(rim.height - h) >= MIN_CLEARANCE
        for i in range(rim.first, rim.last):
            keep[i] = (
                clear
                and (rim.outer == ANY or outer[i] == rim.outer)
                and abs(sin(azimuth[i] - theta) * d / r) < RIM_WIDTH
            )
            if keep[i]:
                count += 1
                low, high = min(low, slope[i]), max(high, slope[i])
        if count:
            own = independent(float(count), (high - low) / (UNIFORM * rim.sigma))
            mean_sigma[j] = rim.sigma * _of_mean(own, p.edge_correlation)
            rough = (rim.height - h) / d * p.roundness_sigma * r / d
            point_variance[j] = count * (rim.sigma * rim.sigma / own + rough * rough / PARTS)
            used += count
    return used


@compiled
def _unknown(candidate: np.record, j: int) -> bool:
    """Return whether a rim is the head of an obstacle of unknown height."""
    return bool(candidate.height_sigma > 0.0 and candidate.rims[j].height > 0.0)


@compiled
def _add_shape(
    shape: Array, products: Array, total: Array, count: int, variance: float, unknown: bool
) -> None:
    """Add the deviations of the points of a rim from their mean to the normal equations.

    An unknown height scales all slopes of a head, whose shape then measures nothing along its own
    slopes.

    Args:
        shape: matrix and right side (3, 4).
        products: sums of products of azimuth, distance, radius, slope and residual (4, 5).
        total: sums (5,).
        count: number of points.
        variance: variance of the deviation of a point.
        unknown: whether the height is unknown.
    """
    for a in range(5):
        for b in range(4):
            products[b, a] -= total[b] * total[a] / count
    unknown = unknown and products[3, 3] > 0.0
    for b in range(3):
        for a in range(4):
            column = a if a < 3 else 4
            deviation = products[b, column]
            if unknown:
                deviation -= products[3, b] * products[3, column] / products[3, 3]
            shape[b, a] += deviation / variance


@compiled
def _linearise(
    H: Array,
    residual: Array,
    point_residual: Array,
    shape: Array,
    candidate: np.record,
    keep: Bools,
    points: Points,
    h: float,
    span: float,
    point_variance: Array,
) -> None:
    """Write Jacobian (7, 3) and residuals (7,) of a candidate, and residuals of its points.

    Writes the normal equations of the shape of the rims, matrix and right side, to `shape` (3, 4):
    the points measure their deviations from the mean of their rim. Of a cylinder whose side is
    cut by the border of the image, only the shape measures azimuth and radius well.
    """
    theta, d, r = candidate.cylinder
    azimuth, slope, _ = points
    H[:] = 0.0
    residual[:] = 0.0
    shape[:] = 0.0
    row, total, products = np.empty(5), np.empty(5), np.empty((4, 5))
    reach, half = sqrt(d * d - r * r), asin(r / d)
    residual[0] = candidate.sides[0].azimuth - theta - half
    residual[1] = candidate.sides[1].azimuth - theta + half
    H[0, 0] = H[1, 0] = H[PRIOR, 2] = 1.0
    H[0, 1], H[0, 2] = -r / (d * reach), 1.0 / reach
    H[1, 1], H[1, 2] = r / (d * reach), -1.0 / reach
    residual[PRIOR] = candidate.prior[0] - r
    if span > 0.0:
        residual[SPAN] = span - reach
        H[SPAN, 1], H[SPAN, 2] = d / reach, -r / reach
    for j in range(candidate.rim_count):
        rim = candidate.rims[j]
        sign, drop = rim.half, rim.height - h
        count = 0
        total[:] = 0.0
        products[:] = 0.0
        for i in range(rim.first, rim.last):
            if not keep[i]:
                continue
            phi = azimuth[i] - theta
            sine, cosine = sin(phi), cos(phi)
            t = min(max(d * sine / r, -OUTER), OUTER)
            c = sqrt(1.0 - t * t)
            lean = sign * t / c
            run = max(d * cosine - sign * r * c, MIN_RUN)
            predicted = drop / run
            gain = -predicted / run  # d slope / d run
            point_residual[i] = slope[i] - predicted
            row[0] = gain * d * (sine - lean * cosine)
            row[1] = gain * (cosine + lean * sine)
            row[2] = -gain * sign / c
            row[3], row[4] = predicted, point_residual[i]
            count += 1
            for a in range(5):
                total[a] += row[a]
                for b in range(4):
                    products[b, a] += row[b] * row[a]
        if count:
            _add_shape(shape, products, total, count, point_variance[j], _unknown(candidate, j))
            k = SIDES + j
            H[k, 0], H[k, 1], H[k, 2] = total[0] / count, total[1] / count, total[2] / count
            residual[k] = total[4] / count


@compiled
def _raise_head(candidate: np.record, residual: Array) -> None:
    """Move a head of unknown height to its rim; its mean residual becomes that of the prior.

    The height of the head scales the shape of the rim. Its mean slope measures the distance by the
    prior of the height alone.
    """
    run, high = candidate.cylinder[1] + candidate.cylinder[2], candidate.height
    for j in range(candidate.rim_count):
        if _unknown(candidate, j):
            rim, mean = candidate.rims[j], mean_height(candidate)
            residual[SIDES + j] += (rim.height - mean) / run
            rim.height = min(max(mean + residual[SIDES + j] * run, 2.0 * mean - high), high)


@compiled
def _covariance(
    R: Array,
    G: Array,
    candidate: np.record,
    side_sigma: Array,
    trusted: Bools,
    mean_sigma: Array,
    view: np.record,
    roundness: float,
    span_sigma: float,
) -> None:
    """Write the measurement covariance (7, 7): pixels, motion blur, roundness, camera pose."""
    theta, d, r = candidate.cylinder
    s, c = sin(theta), cos(theta)
    h, variance, smear = view.clearance, view.variance, view.smear
    R[:] = 0.0
    G[:] = 0.0  # Jacobian by tilt, roll, yaw and height of the camera
    for j in range(SIDES):
        side = candidate.sides[j]
        level = max(0.5 * (side.low + side.high), MIN_SLOPE_OF_SIDE)
        G[j, 0], G[j, 1], G[j, 2] = -level * s, -level * c, 1.0
        sigma, rough = HIDDEN_WIDTH / d, 0.0
        if trusted[j]:
            sigma, rough = side_sigma[j], roundness * r / d
        R[j, j] = sigma * sigma + rough * rough + smear[0]
    for j in range(MAX_RIMS):
        k = SIDES + j
        R[k, k] = NO_INFORMATION * NO_INFORMATION
        if j >= candidate.rim_count or mean_sigma[j] == NO_INFORMATION:
            continue
        slope = (candidate.rims[j].height - h) / d
        lift = 1.0 + slope * slope
        G[k, 0], G[k, 1], G[k, 3] = -lift * c, lift * s, -1.0 / d
        rough = slope * roundness * r / d
        R[k, k] = mean_sigma[j] * mean_sigma[j] + rough * rough + lift * lift * smear[1]
        if _unknown(candidate, j):
            unsure = candidate.height_sigma / (d + r)
            R[k, k] += unsure * unsure
    R[PRIOR, PRIOR] = candidate.prior[1] * candidate.prior[1]
    R[SPAN, SPAN] = span_sigma * span_sigma if span_sigma > 0.0 else 1.0
    for i in range(PRIOR):
        for j in range(i + 1):
            for k in range(4):
                R[i, j] += G[i, k] * variance[k] * G[j, k]


@compiled
def _whiten(R: Array, H: Array, residual: Array) -> None:
    """Whiten H and the residual by the Cholesky factor of R, which replaces R's lower half."""
    for i in range(ROWS):
        for j in range(i + 1):
            total = R[i, j]
            for k in range(j):
                total -= R[i, k] * R[j, k]
            R[i, j] = sqrt(total) if i == j else total / R[j, j]
        for j in range(3):
            total = H[i, j]
            for k in range(i):
                total -= R[i, k] * H[k, j]
            H[i, j] = total / R[i, i]
        total = residual[i]
        for k in range(i):
            total -= R[i, k] * residual[k]
        residual[i] = total / R[i, i]


@compiled
def _step(x: Array, P: Array, H: Array, residual: Array, shape: Array) -> None:
    """Take a Gauss-Newton step of x from whitened rows and shape; write its covariance P (3, 3)."""
    N, g = shape[:, :3].copy(), shape[:, 3].copy()
    for i in range(ROWS):
        for j in range(3):
            g[j] += H[i, j] * residual[i]
            for k in range(3):
                N[j, k] += H[i, j] * H[i, k]
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            c, e = (j + 1) % 3, (j + 2) % 3
            P[j, i] = N[a, c] * N[b, e] - N[a, e] * N[b, c]
    determinant = N[0, 0] * P[0, 0] + N[0, 1] * P[1, 0] + N[0, 2] * P[2, 0]
    for i in range(3):
        for j in range(3):
            P[i, j] /= determinant
    for i in range(3):
        x[i] += P[i, 0] * g[0] + P[i, 1] * g[1] + P[i, 2] * g[2]
    x[2] = min(max(x[2], MIN_RADIUS), MAX_RADIUS)
    x[1] = min(max(x[1], 1.1 * x[2], MIN_DISTANCE), MAX_DISTANCE)


@compiled
def _positive(P: Array) -> bool:
    """Return whether P (3, 3) is positive definite."""
    minor = P[0, 0] * P[1, 1] - P[0, 1] * P[1, 0]
    determinant = (
        P[2, 2] * minor
        - P[2, 1] * (P[0, 0] * P[1, 2] - P[0, 2] * P[1, 0])
        + P[2, 0] * (P[0, 1] * P[1, 2] - P[0, 2] * P[1, 1])
    )
    return bool(P[0, 0] > 0.0 and minor > 0.0 and determinant > 0.0)


@compiled
def _outlier_fraction(
    candidate: np.record, residual: Array, means: Array, keep: Bools, threshold: float
) -> float:
    """Return the fraction of outliers among the used points of a candidate."""
    total = outliers = 0
    for j in range(candidate.rim_count):
        rim = candidate.rims[j]
        for i in range(rim.first, rim.last):
            if keep[i]:
                total += 1
                outliers += abs(residual[i] - means[j]) > threshold * rim.sigma
    return outliers / max(total, 1)


@compiled
def fit(candidates: Rows, points: Points, view: np.record, p: np.record) -> None:
    """Set the least-squares cylinder of each candidate.

    Args:
        candidates: records of type `Candidate` with at least one rim or one trusted side.
        points: points of their rims.
        view: record of type `View`.
        p: parameters.
    """
    n = len(points[0])
    keep, point_residual = np.empty(n, np.bool_), np.empty(n)
    H, residual = np.empty((ROWS, 3)), np.empty(ROWS)
    R, G = np.empty((ROWS, ROWS)), np.empty((ROWS, 4))
    mean_sigma, means, point_variance = np.empty(MAX_RIMS), np.empty(MAX_RIMS), np.empty(MAX_RIMS)
    shape = np.empty((3, 4))
    sigma, trusted = np.empty(SIDES), np.empty(SIDES, np.bool_)
    h, threshold = view.clearance, 0.5 * p.outline_step / p.edge_sigma
    for k in range(len(candidates)):
        candidate = candidates[k]
        x, covariance = candidate.cylinder, candidate.covariance
        distance, distance_sigma = guess(candidate, h)
        for j in range(SIDES):
            side = candidate.sides[j]
            sigma[j] = side.sigma * _of_mean(side.points, p.edge_correlation)
            trusted[j] = side.trusted
        for _ in range(ITERATIONS):
            used = _keep_inner(keep, mean_sigma, point_variance, candidate, points, h, p)
            span, span_sigma = (0.0, 0.0) if used else (distance, distance_sigma)
            _linearise(
                H, residual, point_residual, shape, candidate, keep, points, h, span, point_variance
            )
            for j in range(MAX_RIMS):
                means[j] = residual[SIDES + j]
            _raise_head(candidate, residual)
            # A side visible beyond foot or head is not an edge of the cylinder.
            reach = sqrt(x[1] * x[1] - x[2] * x[2])
            for j in range(SIDES):
                side, slack = candidate.sides[j], 0.5 * sigma[j]
                trusted[j] = (
                    trusted[j]
                    and side.high >= -h / reach - slack
                    and side.low <= (candidate.height - h) / reach + slack
                )
            _covariance(
                R, G, candidate, sigma, trusted, mean_sigma, view, p.roundness_sigma, span_sigma
            )
            _whiten(R, H, residual)
            _step(x, covariance, H, residual, shape)
        if not _positive(covariance):
            # The iteration diverges if the edges are not those of one cylinder.
            covariance[:] = 0.0
            for i in range(3):
                covariance[i, i] = NO_INFORMATION * NO_INFORMATION
        misfit = 0.0
        for i in range(ROWS):
            misfit += residual[i] * residual[i]
        candidate.misfit = misfit
        candidate.outlier_fraction = _outlier_fraction(
            candidate, point_residual, means, keep, threshold
        )
        for i in range(3):
            length = 1.0 if i == 0 else p.unit
            x[i] *= length
            for j in range(3):
                covariance[i, j] *= length * (1.0 if j == 0 else p.unit)
