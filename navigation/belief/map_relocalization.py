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
from navigation.observation import Frame, Observation
from navigation.parameters.belief import RelocalizationParameters
from navigation.transform import points_from, points_to_world, pose_from_points, to_world

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Sighting:
    """What was seen, as the odometry frame remembers it."""

    time: float
    label: str
    point: tuple[float, float]


class MapRelocalization:
    """Remembers what was seen of late and finds it among the landmarks.

    Args:
        parameters: what makes a fit.
        window: age up to which sightings serve [s].
    """

    def __init__(self, parameters: RelocalizationParameters, window: float) -> None:
        self._parameters = parameters
        self._window = window
        self._sightings: list[_Sighting] = []

    def begin(self) -> None:
        """Forget what was seen before the pose went wrong."""
        self._sightings.clear()

    def remember(self, observations: Sequence[Observation], frame: Frame) -> None:
        """Keep sightings of a frame in the odometry frame."""
        p = self._parameters
        kept = [s for s in self._sightings if frame.time - s.time <= self._window]
        for o in observations:
            if float(o.covariance[0, 0]) > p.max_range_sigma * p.max_range_sigma:
                continue
            point = to_world(frame.odometry.tolist(), o.distance, o.bearing)
            kept = [
                s for s in kept if s.label != o.label or _apart(s.point, point) > p.merge_distance
            ]
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
        p, seen = self._parameters, self._sightings
        wanted = max(p.min_matches, p.min_match_fraction * min(len(seen), len(labels)))
        if len(labels) < p.min_matches or len(seen) < p.min_matches:
            return None
        points = points_from(frame.odometry.tolist(), np.array([s.point for s in seen]))
        same = np.array([[a.label == b for b in labels] for a in seen])
        found: list[tuple[int, Array]] = []
        for (i, j), (k, m) in self._pairs(points, places, same):
            pose = pose_from_points(points[[i, j]], places[[k, m]])
            rows, columns = _matched(points, places, same, pose, p.match_distance)
            if len(rows) >= wanted:
                found.append((len(rows), pose_from_points(points[rows], places[columns])))
        if not found:
            return None
        most, best = max(found, key=lambda f: f[0])
        rivals = (q for n, q in found if n == most and not _alike(q, best, p.pose_tolerance))
        return best if next(rivals, None) is None else None

    def _pairs(
        self, points: Array, places: Array, same: NDArray[np.bool_]
    ) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
        """Two sightings and two landmarks that may be the same two things."""
        p = self._parameters
        between = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        for i in range(len(points)):
            for j in range(i):
                length = hypot(*(points[i] - points[j]).tolist())
                if length < p.min_baseline:
                    continue
                fits = same[i][:, None] & same[j] & (np.abs(between - length) < p.match_distance)
                for k, m in np.argwhere(fits).tolist():
                    yield (i, j), (k, m)


def _matched(
    points: Array, places: Array, same: NDArray[np.bool_], pose: Array, tolerance: float
) -> tuple[list[int], list[int]]:
    """Sightings that fall on landmarks under a pose, and these landmarks, each once."""
    laid = points_to_world(pose, points)
    away = np.hypot(*(laid[:, None] - places[None]).transpose(2, 0, 1))
    away = np.where(same, away, np.inf)
    nearest = away.argmin(axis=1).tolist()
    pairs: dict[int, int] = {}
    for row in np.argsort(away.min(axis=1), kind="stable").tolist():
        if away[row, nearest[row]] < tolerance:
            pairs.setdefault(nearest[row], row)
    return list(pairs.values()), list(pairs)


def _alike(a: Array, b: Array, limit: float) -> bool:
    dx, dy, turn = (a - b).tolist()
    return hypot(dx, dy) < limit and abs(wrap(turn)) < limit


def _apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])
