"""Being lost, and finding back: what the beacons say of the pose as a whole.

Whether the pose is wrong shows in the innovations, never in the covariance, which stays
small when it is wrong. A run of sightings that do not fit tells a lost robot from an
outlier; one beacon that does not fit while the others do stands in the wrong place.
"""

from collections.abc import Iterator, Mapping
from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.observation import Frame, Observation
from navigation.parameters.belief import LocalizationParameters
from navigation.transform import points_from, points_to_world, pose_from_points, to_world
from navigation.value import value

Array = NDArray[np.float64]


@value
class _Sighting:
    """A beacon as the odometry frame remembers it."""

    time: float
    point: tuple[float, float]


class BeaconRelocalization:
    """Judges the pose by the beacons, and finds it again from them.

    Args:
        parameters: when the robot is lost, and what makes a fit.
        beacons: position in W by name [m].
    """

    def __init__(
        self, parameters: LocalizationParameters, beacons: Mapping[str, tuple[float, float]]
    ) -> None:
        self._parameters = parameters
        self._beacons = beacons
        self._sightings: dict[str, _Sighting] = {}
        self._run: list[tuple[float, str]] = []
        self._contradictions: dict[str, int] = {}
        self._displaced: set[str] = set()

    @property
    def displaced(self) -> frozenset[str]:
        """Beacons found to stand elsewhere; their sightings are of no use."""
        return frozenset(self._displaced)

    def remember(self, observation: Observation, frame: Frame) -> None:
        """Keep the sighting of a beacon in the odometry frame."""
        point = to_world(frame.odometry.tolist(), observation.distance, observation.bearing)
        self._sightings[observation.label] = _Sighting(frame.time, point)

    def judge(self, time: float, accepted: list[str], rejected: list[str]) -> bool:
        """Whether the pose must be wrong, after the verdicts on the beacons of one frame.

        Args:
            time: of the frame [s].
            accepted: beacons whose sightings fit the pose.
            rejected: those whose sightings did not.
        """
        p = self._parameters
        if accepted:
            # The others contradict this one while the pose fits: it has been moved. An
            # accidental outlier is forgiven by the next sighting that fits.
            blamed = {name for _, name in self._run} | set(rejected)
            for name in blamed - set(accepted):
                self._contradictions[name] = self._contradictions.get(name, 0) + 1
                if self._contradictions[name] >= p.displaced_rejections:
                    self._displaced.add(name)
            for name in accepted:
                self._contradictions.pop(name, None)
            self._run.clear()
            return False
        self._run += [(time, name) for name in rejected]
        if len(self._run) < p.lost_rejections:
            return False
        several = len({name for _, name in self._run}) > 1
        return several or time - self._run[0][0] > p.lost_time

    def begin(self) -> None:
        """Drop older sightings.

        A robot that was carried is not where its odometry relates them to.
        """
        if self._run:
            start = self._run[0][0]
            self._sightings = {n: s for n, s in self._sightings.items() if s.time >= start}
        self._run.clear()

    def locate(self, frame: Frame, before: Array) -> Array | None:
        """Pose that lays the beacons seen of late over the known ones, if one fits.

        Three or more beacons may disagree because one of them stands elsewhere: it is left
        out if the rest then put the robot where it believed to be.

        Args:
            frame: the present one.
            before: pose believed before, moved on by the odometry (3,) [m, m, rad].
        """
        p = self._parameters
        recent = {
            name: s.point
            for name, s in self._sightings.items()
            if frame.time - s.time <= p.recovery_window and name not in self._displaced
        }
        if len(recent) < 2:
            return None
        pose, misfit = self._fit(frame, recent)
        if misfit <= p.recovery_sigma:
            return pose
        for name, others in _without_one(recent):
            pose, misfit = self._fit(frame, others)
            away = hypot(float(pose[0] - before[0]), float(pose[1] - before[1]))
            if misfit <= p.recovery_sigma and away <= 2.0 * p.recovery_sigma:
                self._displaced.add(name)
                return pose
        return None

    def _fit(self, frame: Frame, points: Mapping[str, tuple[float, float]]) -> tuple[Array, float]:
        """Pose from remembered points, and the largest distance of one from its beacon [m]."""
        seen = points_from(frame.odometry.tolist(), np.array(list(points.values())))
        known = np.array([self._beacons[name] for name in points])
        pose = pose_from_points(seen, known)
        fit = points_to_world(pose, seen)
        return pose, float(np.max(np.linalg.norm(fit - known, axis=1)))


def _without_one(
    points: dict[str, tuple[float, float]],
) -> Iterator[tuple[str, dict[str, tuple[float, float]]]]:
    """Three or more points, each left out in turn."""
    if len(points) > 2:
        for name in points:
            yield name, {n: p for n, p in points.items() if n != name}
