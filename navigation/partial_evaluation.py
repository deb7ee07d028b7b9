"""Partial evaluations of the gaze in [0, 1], Yoo & Kim, eqs. (1)-(4), and their set O."""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value
from navigation.belief.tracks import Tracks, max_deviation
from navigation.parameters.gaze import EvaluationParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.record]


@value
class SamplePoints:
    """The sampling region R_s of eq. (1): polar points fixed in R.

    Attributes:
        distance: (n,) [m].
        bearing: (n,) [rad].
        points: points in R (n, 2) [m].
    """

    distance: Array
    bearing: Array
    points: Array

    @classmethod
    def polar(cls, parameters: EvaluationParameters, max_pan: float) -> "SamplePoints":
        """Return rings from `d_nm` to `d_fm` and rays up to `max_pan` [rad] to either side."""
        p = parameters
        rings = np.arange(p.d_nm, p.d_fm + 1e-9, p.ring_step)
        count = int(max_pan / p.ray_step + 1e-9)
        return cls.of(rings, p.ray_step * np.arange(-count, count + 1, dtype=np.float64))

    @classmethod
    def of(cls, rings: Array, rays: Array) -> "SamplePoints":
        """Return points at every distance (m,) [m] on every ray (l,) [rad], m l of them."""
        distance, bearing = (a.ravel() for a in np.meshgrid(rings, rays, indexing="ij"))
        points = distance[:, None] * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
        return cls(distance, bearing, points)


@value
class MapEvaluation:
    """Result of eq. (1).

    Attributes:
        psi: psi_lm in [0, 1].
        counted: sample points outside the gaze region (n,).
        under_confident: counted points with C < lambda_cf (n,).
    """

    psi: float
    counted: Mask
    under_confident: Mask


def psi_local_map(
    confidence: Array, in_gaze: Mask, parameters: EvaluationParameters
) -> MapEvaluation:
    """Return psi_lm, the ratio of under-confident ground (Yoo & Kim, eq. (1)).

    Args:
        confidence: C of the sample points (n,).
        in_gaze: whether a point lies in the gaze region R_g (n,).
        parameters: `lambda_cf`.
    """
    counted = ~in_gaze
    under = counted & (confidence < parameters.lambda_cf)
    n_lp = int(np.count_nonzero(under))
    n_cp = int(np.count_nonzero(counted)) - n_lp
    return MapEvaluation(min(1.0, n_lp / max(1, n_cp)), counted, under)


def psi_self(pose_covariance: Array, parameters: EvaluationParameters) -> float:
    """Return psi_sf, the self-localization uncertainty (Yoo & Kim, eq. (2)).

    Args:
        pose_covariance: covariance of x, y, heading (3, 3).
        parameters: thresholds; `t_heading` = 0 ignores the heading.
    """
    psi = max_deviation(pose_covariance[:2, :2]) / parameters.t_sf
    if parameters.t_heading > 0.0:
        psi = max(psi, float(np.sqrt(max(pose_covariance[2, 2], 0.0))) / parameters.t_heading)
    return min(1.0, psi)


def psi_obstacle(
    tracks: Tracks, position: Array, velocity: Array, parameters: EvaluationParameters
) -> Array:
    """Return psi_ob of every obstacle: uncertain, closing and near (Yoo & Kim, eq. (3)).

    Args:
        tracks: n obstacles in W.
        position: position of the robot in W (2,) [m].
        velocity: velocity of the robot in W (2,) [m/s].
        parameters: `omega_o`, `gamma_o` and `min_distance`.

    Returns:
        (n,), each in [0, 1].
    """
    p = parameters
    return _psi_ob(tracks.rows, position, velocity, p.omega_o, p.gamma_o, p.min_distance)


@compiled
def _psi_ob(
    tracks: Rows, position: Array, velocity: Array, omega: float, gamma: float, nearest: float
) -> Array:
    """Return psi_ob of records of type `TrackRecord`; see `psi_obstacle`."""
    psi = np.empty(len(tracks))
    for i in range(len(tracks)):
        track = tracks[i]
        dx, dy = track.position[0] - position[0], track.position[1] - position[1]
        u, w = track.velocity[0] - velocity[0], track.velocity[1] - velocity[1]
        distance = max(sqrt(dx * dx + dy * dy), nearest)
        alpha = omega * track.sigma * sqrt(u * u + w * w) / distance
        psi[i] = min(1.0, alpha / gamma)
    return psi


def psi_way(free_distance: float, parameters: EvaluationParameters) -> float:
    """Return psi_way, the ratio of obstacle-free distance to d_nThres (Yoo & Kim, eq. (4))."""
    return min(1.0, max(0.0, free_distance) / parameters.d_n_thres)


@compiled
def obstacle_free_distance(position: Array, centres: Array, radii: Array, limit: float) -> float:
    """Return d_of of eq. (4), the distance to the nearest extended shape up to `limit` [m].

    Args:
        position: position of the robot (2,) [m].
        centres: centres of the extended shapes (n, 2) [m].
        radii: their radii (n,) [m].
        limit: d_nThres [m].
    """
    nearest = limit
    for i in range(len(radii)):
        dx, dy = centres[i, 0] - position[0], centres[i, 1] - position[1]
        nearest = min(nearest, sqrt(dx * dx + dy * dy) - radii[i])
    return max(0.0, nearest)


@compiled
def attended(tracks: Rows, pose: Array, velocity: Array, reach: float) -> Mask:
    """Return the set O of eqs. (2)-(6): obstacles ahead, or approaching from behind.

    Args:
        tracks: records of type `TrackRecord` (n,).
        pose: pose of the robot (3,) [m, m, rad].
        velocity: velocity of the robot in W (2,) [m/s].
        reach: maximum distance [m].
    """
    members = np.empty(len(tracks), np.bool_)
    for i in range(len(tracks)):
        track = tracks[i]
        dx, dy = track.position[0] - pose[0], track.position[1] - pose[1]
        u, w = track.velocity[0] - velocity[0], track.velocity[1] - velocity[1]
        ahead = dx * cos(pose[2]) + dy * sin(pose[2]) > 0.0
        near = dx * dx + dy * dy <= reach * reach
        members[i] = near and (ahead or u * dx + w * dy < 0.0)
    return members
