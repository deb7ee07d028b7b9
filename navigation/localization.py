"""Localization: an unscented Kalman filter of the pose with known beacons.

filterpy's filter with Julier's sigma points, the distribution-approximation filter of
Yoo & Kim. State: x, y, heading of R in W. What the measurements share is modelled once:
all bearings of a frame contain the same error of the camera's direction, so the beacons of
a frame are one measurement.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from math import cos, isfinite, sin

import numpy as np
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array
from navigation.belief_parameters import LocalizationParameters
from navigation.landmark import sighting
from navigation.observation import Frame, Observation
from navigation.relocalization import Relocalization

Array = NDArray[np.float64]
Landmarks = Sequence[tuple[float, float]]

# The state ends with an angle; of a measurement every second entry is one.
STATE = slice(2, None)
MEASUREMENT = slice(1, None, 2)
SHARED_LIMIT = 0.98
"""Largest share of a bearing's variance that may be common to the whole frame [1]."""


def _root(covariance: Array) -> Array:
    """Upper factor of Cholesky's, as scipy's but without the cost of its checks."""
    return np.asarray(np.linalg.cholesky(covariance).T, np.float64)


def _mean(angles: slice, points: Array, weights: Array) -> Array:
    mean: Array = weights @ points
    turned = points[:, angles]
    mean[angles] = np.arctan2(weights @ np.sin(turned), weights @ np.cos(turned))
    return mean


def _difference(angles: slice, a: Array, b: Array) -> Array:
    difference: Array = a - b
    difference[angles] = [wrap(v) for v in difference[angles].tolist()]
    return difference


def _moved_on(state: Array, step: Array) -> Array:
    total: Array = state + step
    total[2] = wrap(float(total[2]))
    return total


def _transform(
    points: Array,
    mean_weights: Array,
    covariance_weights: Array,
    noise: Array,
    _mean_fn: object,
    _residual_fn: object,
    *,
    angles: slice,
) -> tuple[Array, Array]:
    """Unscented transform of all points at once; filterpy's own loops over them."""
    mean = _mean(angles, points, mean_weights)
    spread = points - mean
    spread[:, angles] = wrap_array(spread[:, angles])
    return mean, (spread.T * covariance_weights) @ spread + noise


def _moved(pose: Array, _dt: float, increment: tuple[float, float, float]) -> Array:
    """Pose after an odometry increment in R, midpoint rule."""
    x, y, heading = pose.tolist()
    forward, left, turn = increment
    middle = heading + 0.5 * turn
    c, s = cos(middle), sin(middle)
    return np.array([x + c * forward - s * left, y + s * forward + c * left, heading + turn])


def _seen(pose: Array, landmarks: Landmarks) -> Array:
    x = pose.tolist()
    return np.array([v for landmark in landmarks for v in sighting(x, landmark)])


class Localizer:
    """Pose of the robot from odometry and beacons at known places.

    Args:
        parameters: noise, gates and recovery.
        beacons: position in W by name [m].
        pose: x, y, heading at the start (3,) [m, m, rad].
        covariance: of the start pose (3, 3).
    """

    def __init__(
        self,
        parameters: LocalizationParameters,
        beacons: Mapping[str, tuple[float, float]],
        pose: Array,
        covariance: Array,
    ) -> None:
        self._parameters = parameters
        self._beacons = {name: (float(x), float(y)) for name, (x, y) in beacons.items()}
        self._relocalization = Relocalization(parameters, self._beacons)
        self._filter = UnscentedKalmanFilter(
            dim_x=3,
            dim_z=2,
            dt=1.0,
            hx=_seen,
            fx=_moved,
            points=JulierSigmaPoints(3, kappa=0.0, sqrt_method=_root),
            x_mean_fn=partial(_mean, STATE),
            z_mean_fn=partial(_mean, MEASUREMENT),
            residual_x=partial(_difference, STATE),
            residual_z=partial(_difference, MEASUREMENT),
            state_add=_moved_on,
        )
        self._set(np.asarray(pose, float), np.asarray(covariance, float))
        self._previous: tuple[float, list[float]] | None = None
        self._lost = False
        self._faults = 0
        self._recoveries = 0

    @property
    def pose(self) -> Array:
        """x, y, heading of R in W (3,), a copy [m, m, rad]."""
        pose: Array = self._filter.x.copy()
        return pose

    @property
    def covariance(self) -> Array:
        """Covariance of the pose (3, 3), a copy."""
        covariance: Array = self._filter.P.copy()
        return covariance

    @property
    def lost(self) -> bool:
        """Whether the beacons have contradicted the pose for too long."""
        return self._lost

    @property
    def displaced(self) -> frozenset[str]:
        """Beacons found to stand elsewhere than they should."""
        return self._relocalization.displaced

    @property
    def faults(self) -> int:
        """How often the filter broke down numerically and was started again."""
        return self._faults

    @property
    def recoveries(self) -> int:
        """How often the pose was found again after being lost."""
        return self._recoveries

    def update(self, frame: Frame) -> None:
        """Move by the odometry since the last frame, then correct by the beacons in it.

        Raises:
            ValueError: if the frame is not younger than the one before.
        """
        if self._previous is not None:
            frame.check_after(self._previous[0])
        # One blob split in two would otherwise count as two independent sightings.
        seen = {o.label: o for o in reversed(frame.observations) if o.kind == "beacon"}
        useless = self._relocalization.displaced
        beacons = [o for n, o in seen.items() if n in self._beacons and n not in useless]
        try:
            self._predict(frame)
            for observation in beacons:
                self._relocalization.remember(observation, frame)
            if self._lost:
                self._recover(frame, beacons)
            elif beacons:
                self._judge(frame.time, beacons, self._correct(frame, beacons))
        except np.linalg.LinAlgError:
            self._restart()
        if not (np.isfinite(self._filter.x).all() and np.isfinite(self._filter.P).all()):
            self._restart()

    def _set(self, pose: Array, covariance: Array) -> None:
        pose = pose.copy()
        pose[2] = wrap(float(pose[2]))
        self._filter.x = pose
        self._filter.P = 0.5 * (covariance + covariance.T)
        self._sound = self._filter.x.copy()

    def _restart(self) -> None:
        """Start again, lost, from the last sound pose."""
        self._faults += 1
        self._set(self._sound, np.eye(3) * self._parameters.lost_sigma**2)
        self._lost = True
        self._relocalization.begin()

    def _predict(self, frame: Frame) -> None:
        odometry = frame.odometry.tolist()
        previous = self._previous
        self._previous = (frame.time, odometry)
        if previous is None:
            return
        last = previous[1]
        dx, dy = odometry[0] - last[0], odometry[1] - last[1]
        turn = odometry[2] - last[2]
        middle = last[2] + 0.5 * turn
        c, s = cos(middle), sin(middle)
        increment = (c * dx + s * dy, c * dy - s * dx, turn)
        heading = float(self._filter.x[2])
        c, s = cos(heading), sin(heading)
        to_world = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        unseen = self._parameters.drift**2 * (frame.time - previous[0])
        self._filter.Q = to_world @ frame.motion_covariance @ to_world.T + unseen * np.eye(3)
        self._filter.predict(UT=partial(_transform, angles=STATE), increment=increment)
        self._tidy()

    def _correct(self, frame: Frame, beacons: list[Observation]) -> list[str]:
        """Take in all beacons that fit, as one measurement; return their names."""
        f = self._filter
        # filterpy keeps the sigma points of the prediction; they must follow every update.
        f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)
        fit = [o for o in beacons if self._distance(o) <= self._parameters.gate]
        if not fit:
            return []
        R = np.zeros((2 * len(fit), 2 * len(fit)))
        smallest = min(float(o.covariance[1, 1]) for o in fit)
        R[1::2, 1::2] = min(frame.view.yaw_sigma**2, SHARED_LIMIT * smallest)
        for i, o in enumerate(fit):
            R[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = o.covariance
        f.update(
            np.array([v for o in fit for v in (o.distance, o.bearing)]),
            R=R,
            UT=partial(_transform, angles=MEASUREMENT),
            landmarks=[self._beacons[o.label] for o in fit],
        )
        self._tidy()
        return [o.label for o in fit]

    def _distance(self, observation: Observation) -> float:
        """Normalised innovation squared of one beacon; infinite if it is not finite."""
        f = self._filter
        landmarks = [self._beacons[observation.label]]
        points = np.array([_seen(point, landmarks) for point in f.sigmas_f])
        R = observation.covariance
        mean, S = _transform(points, f.Wm, f.Wc, R, None, None, angles=MEASUREMENT)
        u = observation.distance - float(mean[0])
        w = wrap(observation.bearing - float(mean[1]))
        (a, b), (_, d) = S.tolist()
        nis = (d * u * u - 2.0 * b * u * w + a * w * w) / (a * d - b * b)
        return nis if isfinite(nis) else float("inf")

    def _tidy(self) -> None:
        f = self._filter
        f.x[2] = wrap(float(f.x[2]))
        f.P = 0.5 * (f.P + f.P.T)
        self._sound = f.x.copy()

    def _judge(self, time: float, beacons: list[Observation], accepted: list[str]) -> None:
        rejected = [o.label for o in beacons if o.label not in accepted]
        if self._relocalization.judge(time, accepted, rejected):
            self._relocalization.begin()
            self._lost = True
            self._filter.P = np.eye(3) * self._parameters.lost_sigma**2

    def _recover(self, frame: Frame, beacons: list[Observation]) -> None:
        """Lay the beacons seen of late over the known ones."""
        pose = self._relocalization.locate(frame, self._filter.x) if beacons else None
        if pose is None:
            return
        self._lost = False
        self._recoveries += 1
        self._set(pose, np.eye(3) * self._parameters.recovery_sigma**2)
        self._correct(frame, beacons)
