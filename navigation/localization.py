"""Where the robot is: an unscented Kalman filter over odometry and beacons.

The filter is filterpy's with Julier's sigma points, the distribution-approximation
filter of Yoo & Kim. State: x, y, heading of R in W. Being lost is noticed by the
innovations, never by the covariance, which stays small when it is wrong.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, inf, isfinite, sin

import numpy as np
from filterpy.kalman import JulierSigmaPoints, UnscentedKalmanFilter
from numpy.typing import NDArray

from navigation.angles import wrap, wrap_array
from navigation.belief_parameters import LocalizationParameters
from navigation.correlated_noise import variance_inflation
from navigation.landmark import pose_from_points, sighting
from navigation.observation import Frame, Observation

Array = NDArray[np.float64]

# State and measurement both end with an angle, so they share mean, residual and sum.


def _mean(points: Array, weights: Array) -> Array:
    mean: Array = weights @ points
    angles = points[:, -1]
    mean[-1] = atan2(float(weights @ np.sin(angles)), float(weights @ np.cos(angles)))
    return mean


def _residual(a: Array, b: Array) -> Array:
    difference = a - b
    difference[-1] = wrap(float(difference[-1]))
    return difference


def _sum(a: Array, b: Array) -> Array:
    total = a + b
    total[-1] = wrap(float(total[-1]))
    return total


def _transform(
    points: Array,
    mean_weights: Array,
    covariance_weights: Array,
    noise: Array,
    _mean_fn: object,
    _residual_fn: object,
) -> tuple[Array, Array]:
    """Unscented transform of all points at once; filterpy's own loops over them."""
    mean = _mean(points, mean_weights)
    spread = points - mean
    spread[:, -1] = wrap_array(spread[:, -1])
    return mean, (spread.T * covariance_weights) @ spread + noise


def _moved(pose: Array, _dt: float, increment: tuple[float, float, float]) -> Array:
    """Pose after an odometry increment in R, midpoint rule."""
    x, y, heading = pose.tolist()
    forward, left, turn = increment
    middle = heading + 0.5 * turn
    c, s = cos(middle), sin(middle)
    return np.array([x + c * forward - s * left, y + s * forward + c * left, heading + turn])


def _seen(pose: Array, landmark: tuple[float, float]) -> Array:
    return np.array(sighting(pose.tolist(), landmark))


@dataclass(frozen=True, slots=True)
class _Sighting:
    """A beacon as the odometry frame remembers it."""

    time: float
    point: tuple[float, float]


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
        self._filter = UnscentedKalmanFilter(
            dim_x=3,
            dim_z=2,
            dt=1.0,
            hx=_seen,
            fx=_moved,
            points=JulierSigmaPoints(3, kappa=0.0),
            x_mean_fn=_mean,
            z_mean_fn=_mean,
            residual_x=_residual,
            residual_z=_residual,
            state_add=_sum,
        )
        self._set(np.asarray(pose, float), np.asarray(covariance, float))
        self._previous: tuple[float, list[float]] | None = None
        self._sightings: dict[str, _Sighting] = {}
        self._rejected: list[tuple[float, str]] = []
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
        if self._previous is not None and frame.time <= self._previous[0]:
            raise ValueError(
                f"frames must come in the order of their capture: {frame.time:.3f} s came after "
                f"{self._previous[0]:.3f} s"
            )
        # One blob split in two would otherwise count as two independent sightings.
        seen = {o.label: o for o in reversed(frame.observations) if o.kind == "beacon"}
        beacons = [o for name, o in seen.items() if name in self._beacons]
        try:
            self._predict(frame)
            intervals = [self._remember(o, frame) for o in beacons]
            if self._lost:
                self._recover(frame, beacons)
            else:
                for observation, interval in zip(beacons, intervals, strict=True):
                    self._correct(observation, interval, frame.time)
                self._judge(frame.time)
        except np.linalg.LinAlgError:
            self._faults += 1
            self._restart()
        if not (np.isfinite(self._filter.x).all() and np.isfinite(self._filter.P).all()):
            self._faults += 1
            self._restart()

    def _set(self, pose: Array, covariance: Array) -> None:
        pose = pose.copy()
        pose[2] = wrap(float(pose[2]))
        self._filter.x = pose
        self._filter.P = 0.5 * (covariance + covariance.T)
        self._sound = self._filter.x.copy()

    def _restart(self) -> None:
        """Start again, lost, from the last sound pose."""
        self._set(self._sound, np.eye(3) * self._parameters.lost_sigma**2)
        self._lost = True
        self._rejected.clear()

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
        self._filter.Q = self._process_noise(increment, frame.time - previous[0], frame.walking)
        self._filter.predict(UT=_transform, increment=increment)
        self._tidy()

    def _process_noise(
        self, increment: tuple[float, float, float], dt: float, walking: bool
    ) -> Array:
        p = self._parameters
        if not walking:
            return np.eye(3) * (p.standing_drift**2 * dt)
        # An error that lasts one footstep adds up over its frames; a white one of equal
        # effect over many footsteps is larger per frame by the number of frames in one.
        frames = max(1.0, p.footstep / dt)
        forward, left, turn = increment
        step = (p.drift * dt) ** 2
        slip = p.slip**2
        vf = frames * (slip * forward * forward + step)
        vl = frames * (slip * left * left + step)
        vt = frames * (slip * turn * turn + (p.turn_drift * dt) ** 2)
        heading = float(self._filter.x[2])
        c, s = cos(heading), sin(heading)
        cross = c * s * (vf - vl)
        return np.array(
            [
                [c * c * vf + s * s * vl, cross, 0.0],
                [cross, s * s * vf + c * c * vl, 0.0],
                [0.0, 0.0, vt],
            ]
        )

    def _remember(self, observation: Observation, frame: Frame) -> float:
        """Keep the sighting in the odometry frame; return the time since the last one [s]."""
        x, y, yaw = frame.odometry.tolist()
        direction = yaw + observation.bearing
        point = (
            x + observation.distance * cos(direction),
            y + observation.distance * sin(direction),
        )
        before = self._sightings.get(observation.label)
        self._sightings[observation.label] = _Sighting(frame.time, point)
        return inf if before is None else frame.time - before.time

    def _correct(self, observation: Observation, interval: float, time: float) -> None:
        f = self._filter
        x, P = f.x, f.P
        # filterpy keeps the sigma points of the prediction; they must follow every update.
        f.sigmas_f = f.points_fn.sigma_points(f.x, f.P)
        inflation = variance_inflation(interval, self._parameters.correlation_time)
        z = np.array([observation.distance, observation.bearing])
        f.update(
            z,
            R=observation.covariance * inflation,
            UT=_transform,
            landmark=self._beacons[observation.label],
        )
        nis = float(f.y @ f.SI @ f.y)
        if nis > self._parameters.gate or not isfinite(nis):
            f.x, f.P = x, P
            self._rejected.append((time, observation.label))
        else:
            self._rejected.clear()
            self._tidy()

    def _tidy(self) -> None:
        f = self._filter
        f.x[2] = wrap(float(f.x[2]))
        f.P = 0.5 * (f.P + f.P.T)
        self._sound = f.x.copy()

    def _judge(self, time: float) -> None:
        """Decide by the run of rejected sightings whether the pose is wrong."""
        p = self._parameters
        run = self._rejected
        if len(run) < p.lost_run:
            return
        several = len({name for _, name in run}) > 1
        if several or time - run[0][0] > p.lost_time:
            # What was seen before the run began belongs to another odometry frame.
            self._sightings = {n: s for n, s in self._sightings.items() if s.time >= run[0][0]}
            run.clear()
            self._lost = True
            self._filter.P = np.eye(3) * p.lost_sigma**2

    def _recover(self, frame: Frame, beacons: list[Observation]) -> None:
        """Lay the beacons seen of late over the known ones."""
        p = self._parameters
        recent = {
            n: s for n, s in self._sightings.items() if frame.time - s.time <= p.recovery_window
        }
        if len(recent) < 2 or not beacons:
            return
        x, y, yaw = frame.odometry.tolist()
        c, s = cos(yaw), sin(yaw)
        points = np.array([seen.point for seen in recent.values()]) - (x, y)
        seen_R = points @ np.array([[c, -s], [s, c]])
        known = np.array([self._beacons[name] for name in recent])
        pose = pose_from_points(seen_R, known)
        c, s = cos(pose[2]), sin(pose[2])
        fit = seen_R @ np.array([[c, s], [-s, c]]) + pose[:2]
        # A beacon out of place, or one of the wrong name, does not fit the others.
        if float(np.max(np.linalg.norm(fit - known, axis=1))) > p.recovery_sigma:
            return
        self._lost = False
        self._recoveries += 1
        self._set(pose, np.eye(3) * p.recovery_sigma**2)
        for observation in beacons:
            self._correct(observation, inf, frame.time)
