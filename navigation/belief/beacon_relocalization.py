"""Failure detection and relocalization with known beacons.

A wrong pose shows in the innovations, not in the covariance. A run of rejected detections
separates a lost robot from an outlier; a beacon that is rejected while others are accepted is
displaced.
"""

from collections.abc import Mapping
from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.observation import Frame, Observation
from navigation.parameters.belief import LocalizationParameters
from navigation.transform import points_to_robot, points_to_world, pose_from_points, to_world

Array = NDArray[np.float64]
Point = tuple[float, float]


class BeaconRelocalization:
    """Failure detector of the pose and relocalization from recent beacon detections.

    Args:
        parameters: thresholds of failure detection and relocalization.
        beacons: position in W by name [m].
    """

    def __init__(self, parameters: LocalizationParameters, beacons: Mapping[str, Point]) -> None:
        self._parameters = parameters
        self._beacons = beacons
        self._detections: dict[str, tuple[float, Point]] = {}  # time, point in the odometry frame
        self._rejections: list[tuple[float, str]] = []  # since a beacon was last accepted
        self._contradictions: dict[str, int] = {}
        self._displaced: set[str] = set()

    @property
    def displaced(self) -> frozenset[str]:
        """Beacons that are not at their known positions; their detections are ignored."""
        return frozenset(self._displaced)

    def remember(self, observation: Observation, frame: Frame) -> None:
        """Store the detection of a beacon in the odometry frame."""
        point = to_world(frame.odometry.tolist(), observation.distance, observation.bearing)
        self._detections[observation.label] = frame.time, point

    def is_lost(self, time: float, accepted: list[str], rejected: list[str]) -> bool:
        """Return whether the pose must be wrong, after the beacons of one frame.

        Args:
            time: time of the frame [s].
            accepted: beacons inside the gate.
            rejected: beacons outside the gate.
        """
        p = self._parameters
        if accepted:
            # The pose is right, so the rejected beacons are displaced or outliers; the next
            # accepted detection clears an outlier.
            suspects = {name for _, name in self._rejections} | set(rejected)
            for name in suspects - set(accepted):
                self._contradictions[name] = self._contradictions.get(name, 0) + 1
                if self._contradictions[name] >= p.displaced_rejections:
                    self._displaced.add(name)
            for name in accepted:
                self._contradictions.pop(name, None)
            self._rejections.clear()
            return False
        self._rejections += [(time, name) for name in rejected]
        if len(self._rejections) < p.lost_rejections:
            return False
        several = len({name for _, name in self._rejections}) > 1
        return several or time - self._rejections[0][0] > p.lost_time

    def begin(self) -> None:
        """Drop the detections before the failure: their odometry does not relate to the rest."""
        if self._rejections:
            start = self._rejections[0][0]
            self._detections = {n: d for n, d in self._detections.items() if d[0] >= start}
        self._rejections.clear()

    def locate(self, frame: Frame, before: Array) -> Array | None:
        """Return the pose (3,) that aligns the recent detections with the beacons, if one fits.

        If three or more beacons disagree, one of them may be displaced: it is left out if the
        others confirm the pose before.

        Args:
            frame: the present frame.
            before: previous estimate of the pose, propagated by odometry (3,) [m, m, rad].
        """
        p = self._parameters
        recent = {
            name: point
            for name, (time, point) in self._detections.items()
            if frame.time - time <= p.recovery_window and name not in self._displaced
        }
        if len(recent) < 2:
            return None
        pose, misfit = self._fit(frame, recent)
        if misfit <= p.recovery_sigma:
            return pose
        for name in recent if len(recent) > 2 else ():
            others = {n: point for n, point in recent.items() if n != name}
            pose, misfit = self._fit(frame, others)
            distance = hypot(float(pose[0] - before[0]), float(pose[1] - before[1]))
            if misfit <= p.recovery_sigma and distance <= 2.0 * p.recovery_sigma:
                self._displaced.add(name)
                return pose
        return None

    def _fit(self, frame: Frame, points: Mapping[str, Point]) -> tuple[Array, float]:
        """Return the least-squares pose (3,) and its maximum residual [m]."""
        observed = points_to_robot(frame.odometry.tolist(), np.array(list(points.values())))
        known = np.array([self._beacons[name] for name in points])
        pose = pose_from_points(observed, known)
        aligned = points_to_world(pose, observed)
        return pose, float(np.max(np.linalg.norm(aligned - known, axis=1)))
