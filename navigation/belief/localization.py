"""Localization: an unscented Kalman filter of the pose with known beacons.

What the measurements share is modelled once: all bearings of a frame contain the same error
of the camera's direction, so the beacons of a frame are one measurement.
"""

from collections.abc import Mapping
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief import pose_kernel
from navigation.belief.beacon_relocalization import BeaconRelocalization
from navigation.belief.pose_filter import PoseFilter
from navigation.observation import Frame, Observation
from navigation.parameters.belief import LocalizationParameters

Array = NDArray[np.float64]

SHARED_LIMIT = 0.98
"""Largest share of a bearing's variance that may be common to the whole frame [1]."""


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
        self._relocalization = BeaconRelocalization(parameters, self._beacons)
        self._filter = PoseFilter()
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
        increment = np.array([c * dx + s * dy, c * dy - s * dx, turn])
        unseen = self._parameters.drift**2 * (frame.time - previous[0])
        self._filter.move(increment, frame.motion_covariance, unseen)
        self._sound = self._filter.x.copy()

    def _correct(self, frame: Frame, beacons: list[Observation]) -> list[str]:
        """Take in all beacons that fit, as one measurement; return their names."""
        f = self._filter
        f.spread()
        z = np.array([(o.distance, o.bearing) for o in beacons])
        noise = np.array([o.covariance for o in beacons])
        places = np.array([self._beacons[o.label] for o in beacons])
        # A distance that is not a number does not fit either.
        fit = np.flatnonzero(f.nis(z, noise, places) <= self._parameters.gate)
        if len(fit) == 0:
            return []
        R = pose_kernel.together(noise[fit], frame.view.yaw_sigma**2, SHARED_LIMIT)
        f.correct(z[fit], R, places[fit])
        self._sound = f.x.copy()
        return [beacons[k].label for k in fit.tolist()]

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
