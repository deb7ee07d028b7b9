"""Finding back without beacons: the arrangement of landmarks that was seen of late.

Colours repeat, so no landmark by itself tells where the robot is; the distances between
several do. Every pair of sightings is laid over every pair of landmarks of the same colours
and the same distance. The pose under which most sightings fall on landmarks is right, unless
another one explains as many.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.landmark import points_from, points_to_world, pose_from_points, to_world
from navigation.observation import Frame, Observation

Array = NDArray[np.float64]

LEAST = 3
"""Sightings that must fall on landmarks [1]."""
SHARE = 0.5
"""Share of the sightings, or of the landmarks if they are fewer, that must meet [1]."""
TOLERANCE = 0.06
"""Distance up to which a sighting falls on a landmark [m]."""
COARSE = 0.02
"""Standard deviation of a distance from which on a sighting is of no use [m]."""
APART = 0.4
"""Distance of two sightings without which they tell no heading [m]."""
SAME_POSE = 0.3
"""Difference up to which two poses are one [m, rad]."""
SAME_THING = 0.15
"""Distance up to which two sightings of one colour are of one thing [m]."""


@dataclass(frozen=True, slots=True)
class _Sighting:
    """What was seen, as the odometry frame remembers it."""

    time: float
    label: str
    point: tuple[float, float]


class PlaceRecognition:
    """Remembers what was seen of late and finds it among the landmarks.

    Args:
        window: age up to which sightings serve [s].
    """

    def __init__(self, window: float) -> None:
        self._window = window
        self._sightings: list[_Sighting] = []

    def begin(self) -> None:
        """Forget what was seen before the pose went wrong."""
        self._sightings.clear()

    def remember(self, observations: Sequence[Observation], frame: Frame) -> None:
        """Keep sightings of a frame in the odometry frame."""
        kept = [s for s in self._sightings if frame.time - s.time <= self._window]
        for o in observations:
            if float(o.covariance[0, 0]) > COARSE * COARSE:
                continue
            point = to_world(frame.odometry.tolist(), o.distance, o.bearing)
            kept = [s for s in kept if s.label != o.label or _apart(s.point, point) > SAME_THING]
            kept.append(_Sighting(frame.time, o.label, point))
        self._sightings = kept

    def locate(self, frame: Frame, labels: Sequence[str], places: Array) -> Array | None:
        """Pose that lays the sightings over the landmarks, if there is one and no other.

        Args:
            frame: the present one.
            labels: colour classes of the landmarks (n).
            places: of the landmarks in W (n, 2) [m].

        Returns:
            x, y, heading of R in W (3,) [m, m, rad], or None.
        """
        seen = self._sightings
        wanted = max(LEAST, SHARE * min(len(seen), len(labels)))
        if len(labels) < LEAST or len(seen) < LEAST:
            return None
        points = points_from(frame.odometry.tolist(), np.array([s.point for s in seen]))
        same = np.array([[a.label == b for b in labels] for a in seen])
        found: list[tuple[int, Array]] = []
        for (i, j), (k, m) in self._pairs(points, places, same):
            pose = pose_from_points(points[[i, j]], places[[k, m]])
            rows, columns = _matched(points, places, same, pose)
            if len(rows) >= wanted:
                found.append((len(rows), pose_from_points(points[rows], places[columns])))
        if not found:
            return None
        most, best = max(found, key=lambda f: f[0])
        rivals = (p for n, p in found if n == most and not _alike(p, best))
        return best if next(rivals, None) is None else None

    @staticmethod
    def _pairs(
        points: Array, places: Array, same: NDArray[np.bool_]
    ) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
        """Two sightings and two landmarks that may be the same two things."""
        between = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        for i in range(len(points)):
            for j in range(i):
                length = hypot(*(points[i] - points[j]).tolist())
                if length < APART:
                    continue
                fits = same[i][:, None] & same[j] & (np.abs(between - length) < TOLERANCE)
                for k, m in np.argwhere(fits).tolist():
                    yield (i, j), (k, m)


def _matched(
    points: Array, places: Array, same: NDArray[np.bool_], pose: Array
) -> tuple[list[int], list[int]]:
    """Sightings that fall on landmarks under a pose, and these landmarks, each once."""
    laid = points_to_world(pose, points)
    away = np.hypot(*(laid[:, None] - places[None]).transpose(2, 0, 1))
    away = np.where(same, away, np.inf)
    nearest = away.argmin(axis=1).tolist()
    pairs: dict[int, int] = {}
    for row in np.argsort(away.min(axis=1), kind="stable").tolist():
        if away[row, nearest[row]] < TOLERANCE:
            pairs.setdefault(nearest[row], row)
    return list(pairs.values()), list(pairs)


def _alike(a: Array, b: Array) -> bool:
    dx, dy, turn = (a - b).tolist()
    return hypot(dx, dy) < SAME_POSE and abs(wrap(turn)) < SAME_POSE


def _apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])
