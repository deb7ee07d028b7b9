"""Gauss-Newton steps of the pose estimation of cylinders."""

from math import asin, cos, inf, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.outline import independent

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Table = NDArray[np.int64]
Edges = tuple[Array, Table, Array, Array]  # rims, points, azimuth and slope, see `fit`

ITERATIONS = 4
MAX_RIMS = 3  # a beacon shows three
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
    x: Array,
    edges: Edges,
    h: float,
    options: Array,
) -> int:
    """Select the rim points away from the ends of their rim; return their number.

    Writes which points to `keep`; for each rim the standard deviation of the mean slope to
    `mean_sigma` (3,) [1], and the variance of a point's deviation from this mean to
    `point_variance` (3,) [1], larger by the number of points per independent one.
    """
    theta, d, r = x[0], x[1], x[2]
    rims, points, azimuth, slope = edges
    roundness, common, clearance = options[0], options[1], options[3]
    used = 0
    mean_sigma[:] = NO_INFORMATION
    for j in range(len(rims)):
        count, low, high = 0, inf, -inf
        clear = abs(rims[j, 0] - h) >= clearance
        for i in range(points[j], points[j + 1]):
            keep[i] = clear and abs(sin(azimuth[i] - theta) * d / r) < RIM_WIDTH
            if keep[i]:
                count += 1
                low, high = min(low, slope[i]), max(high, slope[i])
        if count:
            own = independent(float(count), (high - low) / (UNIFORM * rims[j, 2]))
            mean_sigma[j] = rims[j, 2] * _of_mean(own, common)
            rough = (rims[j, 0] - h) / d * roundness * r / d
            point_variance[j] = count * (rims[j, 2] * rims[j, 2] / own + rough * rough / PARTS)
            used += count
    return used


@compiled
def _linearise(
    H: Array,
    residual: Array,
    point_residual: Array,
    shape: Array,
    x: Array,
    sides: Array,
    prior: float,
    keep: Bools,
    edges: Edges,
    h: float,
    span: float,
    point_variance: Array,
) -> None:
    """Write Jacobian (7, 3) and residuals (7,) of a candidate at x, and residuals of its points.

    Writes the normal equations of the shape of the rims, matrix and right side, to `shape` (3, 4):
    the points measure their deviations from the mean of their rim. Of a cylinder whose side is
    cut by the border of the image, only the shape measures azimuth and radius well.
    """
    theta, d, r = x[0], x[1], x[2]
    rims, points, azimuth, slope = edges
    H[:] = 0.0
    residual[:] = 0.0
    shape[:] = 0.0
    row, total, products = np.empty(4), np.empty(4), np.empty((3, 4))
    reach, half = sqrt(d * d - r * r), asin(r / d)
    residual[0] = sides[0, 0] - theta - half
    residual[1] = sides[1, 0] - theta + half
    H[0, 0] = H[1, 0] = H[PRIOR, 2] = 1.0
    H[0, 1], H[0, 2] = -r / (d * reach), 1.0 / reach
    H[1, 1], H[1, 2] = r / (d * reach), -1.0 / reach
    residual[PRIOR] = prior - r
    if span > 0.0:
        residual[SPAN] = span - reach
        H[SPAN, 1], H[SPAN, 2] = d / reach, -r / reach
    for j in range(len(rims)):
        sign, drop = rims[j, 1], rims[j, 0] - h
        count = 0
        total[:] = 0.0
        products[:] = 0.0
        for i in range(points[j], points[j + 1]):
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
            row[3] = point_residual[i]
            count += 1
            for a in range(4):
                total[a] += row[a]
                for b in range(3):
                    products[b, a] += row[b] * row[a]
        if count:
            for a in range(4):
                for b in range(3):
                    deviation = products[b, a] - total[b] * total[a] / count
                    shape[b, a] += deviation / point_variance[j]
            k = SIDES + j
            H[k, 0], H[k, 1], H[k, 2] = total[0] / count, total[1] / count, total[2] / count
            residual[k] = total[3] / count


@compiled
def _covariance(
    R: Array,
    G: Array,
    x: Array,
    sides: Array,
    side_sigma: Array,
    trusted: Bools,
    known: Array,
    rims: Array,
    mean_sigma: Array,
    pose: Array,
    roundness: float,
    span_sigma: float,
) -> None:
    """Write the measurement covariance (7, 7): pixels, motion blur, roundness, camera pose."""
    theta, d, r = x[0], x[1], x[2]
    s, c = sin(theta), cos(theta)
    h, pose_variance, smear = pose[0], pose[1:5], pose[5:]
    R[:] = 0.0
    G[:] = 0.0  # Jacobian by tilt, roll, yaw and height of the camera
    for j in range(SIDES):
        level = max(0.5 * (sides[j, 3] + sides[j, 4]), MIN_SLOPE_OF_SIDE)
        G[j, 0], G[j, 1], G[j, 2] = -level * s, -level * c, 1.0
        sigma, rough = HIDDEN_WIDTH / d, 0.0
        if trusted[j]:
            sigma, rough = side_sigma[j], roundness * r / d
        R[j, j] = sigma * sigma + rough * rough + smear[0]
    for j in range(MAX_RIMS):
        k = SIDES + j
        R[k, k] = NO_INFORMATION * NO_INFORMATION
        if j >= len(rims) or mean_sigma[j] == NO_INFORMATION:
            continue
        slope = (rims[j, 0] - h) / d
        lift = 1.0 + slope * slope
        G[k, 0], G[k, 1], G[k, 3] = -lift * c, lift * s, -1.0 / d
        rough = slope * roundness * r / d
        R[k, k] = mean_sigma[j] * mean_sigma[j] + rough * rough + lift * lift * smear[1]
    R[PRIOR, PRIOR] = known[1] * known[1]
    R[SPAN, SPAN] = span_sigma * span_sigma if span_sigma > 0.0 else 1.0
    for i in range(PRIOR):
        for j in range(i + 1):
            for k in range(4):
                R[i, j] += G[i, k] * pose_variance[k] * G[j, k]


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
def _step(x: Array, P: Array, H: Array, residual: Array, shape: Array, options: Array) -> None:
    """Take a Gauss-Newton step of x from whitened rows and shape; write its covariance P (3, 3)."""
    min_distance, max_distance = options[4], options[5]
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
    x[1] = min(max(x[1], 1.1 * x[2], min_distance), max_distance)


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
    residual: Array, means: Array, keep: Bools, rims: Array, points: Table, threshold: float
) -> float:
    """Return the fraction of outliers among the used points of a candidate; see `fit`."""
    total = outliers = 0
    for j in range(len(rims)):
        for i in range(points[j], points[j + 1]):
            if keep[i]:
                total += 1
                outliers += abs(residual[i] - means[j]) > threshold * rims[j, 2]
    return outliers / max(total, 1)


@compiled
def fit(
    sides: Array,
    known: Array,
    rims: Array,
    first_rims: Table,
    points: Table,
    azimuth: Array,
    slope: Array,
    pose: Array,
    options: Array,
    start: Array,
    spans: Array,
) -> tuple[Array, Array]:
    """Return the least-squares cylinder of each candidate.

    Args:
        sides: azimuth [rad], its standard deviation for one point [rad], number of independent
            points, minimum and maximum slope, and whether it is trusted, of the left and the
            right side of each candidate (n, 2, 6).
        known: radius, its standard deviation and height of each candidate (n, 3) [m].
        rims: height [m], 1 for the near half of the circle and -1 for the far one, and standard
            deviation of one slope, of all rims, from low to high for each candidate (m, 3).
        first_rims: first rim of each candidate, and m (n + 1,).
        points: first point of each rim, and their number (m + 1,).
        azimuth: azimuths of the points of the rims [rad].
        slope: slopes of the points of the rims [1].
        pose: height of the camera [m]; variances of its tilt, roll, yaw [rad²], height [m²], and
            of the motion blur by pan and tilt [rad²] (7,).
        options: roundness, edge correlation and outlier threshold as for
            `vision.cylinder.locate`, and its `LIMITS` (6,).
        start: first azimuth [rad], distance [m] and radius [m] (n, 3).
        spans: distance to the only trusted side and its standard deviation, or 0 (n, 2) [m].

    Returns:
        Azimuth [rad], distance [m], radius [m], misfit and outlier fraction (n, 5); covariance
        of the first three (n, 3, 3).
    """
    n = len(sides)
    result, covariances = np.empty((n, 5)), np.empty((n, 3, 3))
    keep, point_residual = np.empty(len(slope), np.bool_), np.empty(len(slope))
    H, residual = np.empty((ROWS, 3)), np.empty(ROWS)
    R, G = np.empty((ROWS, ROWS)), np.empty((ROWS, 4))
    mean_sigma, means, point_variance = np.empty(MAX_RIMS), np.empty(MAX_RIMS), np.empty(MAX_RIMS)
    shape = np.empty((3, 4))
    sigma, trusted = np.empty(SIDES), np.empty(SIDES, np.bool_)
    h, roundness, common, threshold = pose[0], options[0], options[1], options[2]
    for k in range(n):
        side, size, x = sides[k], known[k], result[k, :3]
        first, last = first_rims[k], first_rims[k + 1]
        rim, ends = rims[first:last], points[first : last + 1]
        edges = (rim, ends, azimuth, slope)
        x[:] = start[k]
        for j in range(SIDES):
            sigma[j] = side[j, 1] * _of_mean(side[j, 2], common)
            trusted[j] = side[j, 5] != 0.0
        for _ in range(ITERATIONS):
            used = _keep_inner(keep, mean_sigma, point_variance, x, edges, h, options)
            span, span_sigma = (0.0, 0.0) if used else (spans[k, 0], spans[k, 1])
            _linearise(
                H,
                residual,
                point_residual,
                shape,
                x,
                side,
                size[0],
                keep,
                edges,
                h,
                span,
                point_variance,
            )
            means[:] = residual[SIDES:PRIOR]
            # A side visible beyond foot or head is not an edge of the cylinder.
            reach = sqrt(x[1] * x[1] - x[2] * x[2])
            for j in range(SIDES):
                slack = 0.5 * sigma[j]
                trusted[j] = (
                    trusted[j]
                    and side[j, 4] >= -h / reach - slack
                    and side[j, 3] <= (size[2] - h) / reach + slack
                )
            _covariance(
                R, G, x, side, sigma, trusted, size, rim, mean_sigma, pose, roundness, span_sigma
            )
            _whiten(R, H, residual)
            _step(x, covariances[k], H, residual, shape, options)
        if not _positive(covariances[k]):
            # The iteration diverges if the edges are not those of one cylinder.
            covariances[k] = NO_INFORMATION * NO_INFORMATION * np.eye(3)
        misfit = 0.0
        for i in range(ROWS):
            misfit += residual[i] * residual[i]
        result[k, 3] = misfit
        result[k, 4] = _outlier_fraction(point_residual, means, keep, rim, ends, threshold)
    return result, covariances
