"""Localization with known beacons: an unscented Kalman filter of the pose.

The beacons of a frame are one measurement, because their bearings share the error of the
camera's yaw.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from navigation.belief.beacon_relocalization import BeaconRelocalization
from navigation.belief.pose_filter import PoseFilter
from navigation.observation import Frame, Observation, bearing_variance
from navigation.parameters.belief import LocalizationParameters
from navigation.transform import rotate, yaw_rotation

Array = NDArray[np.float64]

MAX_SHARED = 0.98
"""Maximum fraction of a bearing's variance, for a known distance, that all bearings share [1]."""


class Localizer:
    """Unscented Kalman filter of the pose from odometry and beacons at known positions.

    Args:
        parameters: noise, gate and recovery.
        beacons: position in W by name [m].
        pose: x, y, heading at the start (3,) [m, m, rad].
        covariance: covariance of the start pose (3, 3).

    Attributes:
        lost: whether the beacons have contradicted the pose for too long.
        faults: number of re-initializations after numerical failures.
        recoveries: number of relocalizations.
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
        self._filter = PoseFilter(pose, covariance)
        self._last_valid = self.pose
        self._previous: tuple[float, list[float]] | None = None
        self.lost = False
        self.faults = 0
        self.recoveries = 0

    @property
    def pose(self) -> Array:
        """x, y, heading of R in W (3,), a copy [m, m, rad]."""
        return self._filter.pose

    @property
    def covariance(self) -> Array:
        """Covariance of the pose (3, 3), a copy."""
        return self._filter.covariance

    def update(self, frame: Frame) -> None:
        """Predict by the odometry since the last frame, then correct by the beacons of the frame.

        Raises:
            ValueError: if the frame is not younger than the one before.
        """
        if self._previous is not None:
            frame.check_after(self._previous[0])
        # A beacon reported twice is not two independent measurements.
        detected = {o.label: o for o in reversed(frame.observations) if o.kind == "beacon"}
        displaced = self._relocalization.displaced
        beacons = [o for n, o in detected.items() if n in self._beacons and n not in displaced]
        for observation in beacons:
            self._relocalization.remember(observation, frame)
        try:
            self._predict(frame)
            if self.lost:
                self._recover(frame, beacons)
            elif beacons:
                self._detect_failure(frame.time, beacons, self._correct(frame, beacons))
            valid = self._filter.is_valid()
        except np.linalg.LinAlgError:
            valid = False
        if not valid:
            self._restart()
        self._last_valid = self.pose

    def _restart(self) -> None:
        """Re-initialize, lost, at the last valid pose."""
        self.faults += 1
        self._filter.set(self._last_valid, self._parameters.lost_covariance())
        self.lost = True
        self._relocalization.begin()

    def _predict(self, frame: Frame) -> None:
        odometry = frame.odometry.tolist()
        previous = self._previous
        self._previous = (frame.time, odometry)
        if previous is None:
            return
        last = previous[1]
        turn = odometry[2] - last[2]
        middle = last[2] + 0.5 * turn
        dx, dy = rotate(-middle, (odometry[0] - last[0], odometry[1] - last[1]))
        drift = self._parameters.drift_rate() * (frame.time - previous[0])
        rotation = yaw_rotation(float(self.pose[2]))
        Q = rotation @ frame.motion_covariance @ rotation.T + drift
        self._filter.predict(np.array([dx, dy, turn]), Q)

    def _correct(self, frame: Frame, beacons: list[Observation]) -> list[str]:
        """Correct by all beacons inside the gate, as one measurement; return their names."""
        distances = self._filter.nis(*self._measurement(frame, beacons)).tolist()
        gate = self._parameters.gate
        accepted = [o for o, d in zip(beacons, distances, strict=True) if d <= gate]
        if accepted:
            self._filter.update(*self._measurement(frame, accepted))
        return [o.label for o in accepted]

    def _measurement(self, frame: Frame, beacons: list[Observation]) -> tuple[Array, Array, Array]:
        """Return measurement (2 k,), its covariance (2 k, 2 k) and the landmarks in W (k, 2)."""
        z = np.array([(o.distance, o.bearing) for o in beacons]).ravel()
        shared = MAX_SHARED * min(bearing_variance(o) for o in beacons)
        R = np.zeros((len(z), len(z)))
        R[1::2, 1::2] = min(frame.view.model.yaw_sigma**2, shared)
        for i, o in enumerate(beacons):
            R[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = o.covariance
        return z, R, np.array([self._beacons[o.label] for o in beacons])

    def _detect_failure(self, time: float, beacons: list[Observation], accepted: list[str]) -> None:
        rejected = [o.label for o in beacons if o.label not in accepted]
        if self._relocalization.is_lost(time, accepted, rejected):
            self._relocalization.begin()
            self.lost = True
            self._filter.set(self.pose, self._parameters.lost_covariance())

    def _recover(self, frame: Frame, beacons: list[Observation]) -> None:
        """Relocalize from the recent detections."""
        pose = self._relocalization.locate(frame, self.pose) if beacons else None
        if pose is None:
            return
        self.lost = False
        self.recoveries += 1
        self._filter.set(pose, self._parameters.recovery_covariance())
        self._correct(frame, beacons)
