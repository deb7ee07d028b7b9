"""Relocalization with mapped landmarks, by matching their constellation.

Colours repeat, so no single landmark identifies a place, but the distances between several do.
Every pair of detections is matched with every pair of landmarks of the same colours and
distance. The pose hypothesis with most inliers is accepted if it is unique.
"""

from collections.abc import Iterator, Sequence
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.observation import Frame, Observation
from navigation.parameters.belief import RelocalizationParameters
from navigation.transform import points_to_robot, points_to_world, pose_from_points, to_world

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class _Detection(NamedTuple):
    """Detection in the odometry frame."""

    time: float
    label: str
    point: tuple[float, float]


class MapRelocalization:
    """Relocalization from recent detections of mapped landmarks.

    Args:
        parameters: thresholds of matching.
        window: maximum age of a detection [s].
    """

    def __init__(self, parameters: RelocalizationParameters, window: float) -> None:
        self._parameters = parameters
        self._window = window
        self._detections: list[_Detection] = []

    def begin(self) -> None:
        """Drop all detections: they precede the failure."""
        self._detections.clear()

    def remember(self, observations: Sequence[Observation], frame: Frame) -> None:
        """Store the precise detections of a frame in the odometry frame."""
        p = self._parameters
        kept = [d for d in self._detections if frame.time - d.time <= self._window]
        for o in observations:
            if float(o.covariance[0, 0]) > p.max_range_sigma * p.max_range_sigma:
                continue
            x, y = to_world(frame.odometry.tolist(), o.distance, o.bearing)
            kept = [
                d
                for d in kept
                if d.label != o.label or hypot(d.point[0] - x, d.point[1] - y) > p.merge_distance
            ]
            kept.append(_Detection(frame.time, o.label, (x, y)))
        self._detections = kept

    def locate(self, frame: Frame, labels: Sequence[str], landmarks: Array) -> Array | None:
        """Return the pose that aligns the detections with the landmarks, if it is unique.

        Args:
            frame: the present frame.
            labels: colour classes of the landmarks (n).
            landmarks: positions in W (n, 2) [m].

        Returns:
            x, y, heading of R in W (3,) [m, m, rad], or None.
        """
        p, detections = self._parameters, self._detections
        required = max(p.min_matches, p.min_match_fraction * min(len(detections), len(labels)))
        if len(labels) < p.min_matches or len(detections) < p.min_matches:
            return None
        points = points_to_robot(frame.odometry.tolist(), np.array([d.point for d in detections]))
        same = np.array([[d.label == label for label in labels] for d in detections])
        hypotheses: list[tuple[int, Array]] = []
        for (i, j), (k, m) in self._pairs(points, landmarks, same):
            pose = pose_from_points(points[[i, j]], landmarks[[k, m]])
            rows, columns = _inliers(points, landmarks, same, pose, p.match_distance)
            if len(rows) >= required:
                pose = pose_from_points(points[rows], landmarks[columns])
                hypotheses.append((len(rows), pose))
        if not hypotheses:
            return None
        most, best = max(hypotheses, key=lambda h: h[0])
        unique = all(n < most or _equal(h, best, p) for n, h in hypotheses)
        return best if unique else None

    def _pairs(
        self, points: Array, landmarks: Array, same: Mask
    ) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
        """Yield pairs of detections with pairs of landmarks of the same colours and distance."""
        p = self._parameters
        between = np.hypot(*(landmarks[:, None] - landmarks[None]).transpose(2, 0, 1))
        for i in range(len(points)):
            for j in range(i):
                baseline = hypot(*(points[i] - points[j]).tolist())
                if baseline < p.min_baseline:
                    continue
                equal = np.abs(between - baseline) < p.match_distance
                for k, m in np.argwhere(same[i][:, None] & same[j] & equal).tolist():
                    yield (i, j), (k, m)


def _inliers(
    points: Array, landmarks: Array, same: Mask, pose: Array, tolerance: float
) -> tuple[list[int], list[int]]:
    """Return the detections that match a landmark under a pose, and these landmarks."""
    aligned = points_to_world(pose, points)
    distance = np.hypot(*(aligned[:, None] - landmarks[None]).transpose(2, 0, 1))
    distance = np.where(same, distance, np.inf)
    nearest = distance.argmin(axis=1).tolist()
    pairs: dict[int, int] = {}
    for row in np.argsort(distance.min(axis=1), kind="stable").tolist():
        if distance[row, nearest[row]] < tolerance:
            pairs.setdefault(nearest[row], row)
    return list(pairs.values()), list(pairs)


def _equal(a: Array, b: Array, p: RelocalizationParameters) -> bool:
    dx, dy, turn = (a - b).tolist()
    return hypot(dx, dy) < p.position_tolerance and abs(wrap(turn)) < p.heading_tolerance
