"""Localization without beacons: what stands still becomes a landmark while it is mapped.

An extended Kalman filter of the pose and of every landmark together (Smith, Self &
Cheeseman): the error of the pose at which a landmark was mapped is an error of the landmark
too, and only their correlation tells how much seeing it again says about the pose. The pose
at the start defines the frame.

Several landmarks missing where they should be seen mean that the pose is wrong, unless others
of their age are in their places. The map is then left alone until its arrangement is
recognised.
"""

from math import atan2, cos, hypot, inf, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Motion, Track
from navigation.belief.correlated_noise import variance_inflation
from navigation.belief.localization import SHARED_LIMIT
from navigation.belief.map_relocalization import MapRelocalization
from navigation.belief.sightings import in_world
from navigation.belief.visibility import Viewpoint
from navigation.observation import Frame, Observation
from navigation.parameters.belief import BeliefParameters
from navigation.transform import moved_on

Array = NDArray[np.float64]

START_VARIANCE = 1e-10
"""Of the pose that defines the frame [m², rad²]."""


class EkfSlam:
    """Pose of the robot from odometry and the static obstacles it has met.

    Args:
        parameters: of the belief.
        pose: x, y, heading at the start (3,) [m, m, rad].
    """

    def __init__(self, parameters: BeliefParameters, pose: Array) -> None:
        self._localization = parameters.localization
        self._mapping = parameters.mapping
        self._tracking = parameters.tracking
        self._x = np.array(pose, float)
        self._P = START_VARIANCE * np.eye(3)
        self._ids: list[int] = []
        self._labels: list[str] = []
        self._seen_at: list[float] = []
        self._previous: tuple[float, Array] | None = None
        self._relocalization = MapRelocalization(
            parameters.relocalization, self._localization.recovery_window
        )
        self._mapped_at: list[float] = []
        self._missing: dict[int, tuple[float, int]] = {}
        self._lost = False
        self._faults = 0
        self._recoveries = 0

    @property
    def pose(self) -> Array:
        """x, y, heading of R in W (3,), a copy [m, m, rad]."""
        pose = self._x[:3].copy()
        pose[2] = wrap(float(pose[2]))
        return pose

    @property
    def covariance(self) -> Array:
        """Covariance of the pose (3, 3), a copy."""
        return self._P[:3, :3].copy()

    @property
    def lost(self) -> bool:
        """Whether what is mapped has been missing where it should be seen."""
        return self._lost

    @property
    def faults(self) -> int:
        """How often the filter broke down numerically and forgot its landmarks."""
        return self._faults

    @property
    def recoveries(self) -> int:
        """How often the pose was found again after being lost."""
        return self._recoveries

    def update(self, frame: Frame) -> None:
        """Move by the odometry since the last frame, then correct by the landmarks in it.

        Raises:
            ValueError: if the frame is not younger than the one before.
        """
        if self._previous is not None:
            frame.check_after(self._previous[0])
        self._predict(frame)
        sound = self._x[:3].copy(), self._P[:3, :3].copy()
        try:
            if self._lost:
                self._recover(frame)
            else:
                self._judge(frame, self._correct(frame))
        except np.linalg.LinAlgError:
            self._P[0, 0] = np.nan
        if not (np.isfinite(self._x).all() and np.isfinite(self._P).all()):
            self._faults += 1
            self._x, self._P = sound
            self._ids, self._labels, self._seen_at, self._mapped_at = [], [], [], []
            # Without landmarks none is missing, and no arrangement of them can be recognised.
            self._missing.clear()
            self._lost = False

    def learn(self, frame: Frame, tracks: tuple[Track, ...]) -> None:
        """Map the static tracks seen in the frame, and forget what no longer stands still.

        Nothing is learnt while lost, for the tracks stand where the wrong pose puts them.

        Args:
            frame: the one of the last update.
            tracks: after that frame.
        """
        if self._lost:
            return
        standing = {t.id: t for t in tracks if t.motion is Motion.STATIC}
        for i in reversed([i for i, k in enumerate(self._ids) if k >= 0 and k not in standing]):
            self._forget(i)
        clear = [o for o in frame.observations if _clear(o)]
        for k, track in standing.items():
            if k in self._ids or not track.visible or self._adopted(k, track):
                continue
            mine = [
                o
                for o in clear
                if o.label == track.label
                and self._away(o, track.position) < self._mapping.match_distance
            ]
            if len(mine) == 1:
                self._map(k, mine[0], frame.time)

    def _predict(self, frame: Frame) -> None:
        previous = self._previous
        self._previous = (frame.time, frame.odometry.copy())
        if previous is None:
            return
        x, P = self._x, self._P
        heading = float(x[2])
        x[:3], F = moved_on(x[:3], previous[1], frame.odometry)
        P[:3] = F @ P[:3]
        P[:, :3] = P[:, :3] @ F.T
        c, s = cos(heading), sin(heading)
        to_world = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        unseen = self._localization.drift**2 * (frame.time - previous[0])
        P[:3, :3] += to_world @ frame.motion_covariance @ to_world.T + unseen * np.eye(3)
        self._P = 0.5 * (P + P.T)

    def _correct(self, frame: Frame) -> list[int]:
        """Take in all landmarks of a frame; return their indices."""
        found = self._associate(frame)
        if not found:
            return []
        n = len(self._x)
        H = np.zeros((2 * len(found), n))
        R = np.zeros((2 * len(found), 2 * len(found)))
        y = np.zeros(2 * len(found))
        smallest = min(float(o.covariance[1, 1]) for o in found.values())
        R[1::2, 1::2] = min(frame.view.yaw_sigma**2, SHARED_LIMIT * smallest)
        for row, (i, o) in enumerate(found.items()):
            a, b = 2 * row, 2 * row + 2
            y[a:b], H[a:b][:, self._entries(i)] = self._residual(i, o)
            age = frame.time - self._seen_at[i]
            R[a:b, a:b] = o.covariance * variance_inflation(age, self._tracking.correlation_time)
            self._seen_at[i] = frame.time
        PH = self._P @ H.T
        K = np.linalg.solve(H @ PH + R, PH.T).T
        self._x = self._x + K @ y
        keep = np.eye(n) - K @ H
        P = keep @ self._P @ keep.T + K @ R @ K.T
        self._P = 0.5 * (P + P.T)
        return list(found)

    def _judge(self, frame: Frame, found: list[int]) -> None:
        """Notice that the pose must be wrong.

        A landmark that was mapped before another was seen last, and is found where it should
        be, tells that the other one alone is gone. What was mapped after that may have been
        mapped from a wrong pose, and is forgotten then.
        """
        for k, (seen_at, _) in list(self._missing.items()):
            if any(self._mapped_at[i] <= seen_at for i in found):
                del self._missing[k]
        if not frame.observations or not self._ids:
            return  # a camera that shows nothing at all says nothing
        p = self._tracking
        pose, covariance = self.pose, self.covariance
        seen = in_world(frame.observations, pose, covariance, max_pose_sigma=p.max_pose_sigma)
        expected = Viewpoint.of(frame.view, pose, p.detection_range).expects(
            self._x[3:].reshape(-1, 2),
            seen.positions,
            seen.radii,
            margin=p.view_margin,
            slack=p.occlusion_margin,
        )
        for i in np.flatnonzero(expected).tolist():
            if i not in found:
                _, count = self._missing.get(self._ids[i], (0.0, 0))
                self._missing[self._ids[i]] = self._seen_at[i], count + 1
        misses = sum(count for _, count in self._missing.values())
        if len(self._missing) > 1 and misses >= self._localization.lost_rejections:
            sound_until = max(seen_at for seen_at, _ in self._missing.values())
            for i in reversed([i for i, t in enumerate(self._mapped_at) if t > sound_until]):
                self._forget(i)
            self._missing.clear()
            self._relocalization.begin()
            self._lost = True
            self._doubt_pose(self._localization.lost_sigma)

    def _recover(self, frame: Frame) -> None:
        """Recognise the arrangement of the landmarks in what was seen of late."""
        self._relocalization.remember([o for o in frame.observations if _clear(o)], frame)
        pose = self._relocalization.locate(frame, self._labels, self._x[3:].reshape(-1, 2))
        if pose is None:
            return
        self._lost = False
        self._recoveries += 1
        self._x[:3] = pose
        self._doubt_pose(self._localization.recovery_sigma)
        # The tracks of the landmarks end with the wrong pose; new ones will adopt them.
        self._ids = [-1 - i for i in range(len(self._ids))]
        self._correct(frame)

    def _doubt_pose(self, sigma: float) -> None:
        """State a pose that has nothing to do with what was believed."""
        self._P[:3, :] = 0.0
        self._P[:, :3] = 0.0
        self._P[:3, :3] = sigma * sigma * np.eye(3)

    def _adopted(self, k: int, track: Track) -> bool:
        """Give a landmark without a track to the new track that stands in its place."""
        for i, number in enumerate(self._ids):
            if number >= 0 or self._labels[i] != track.label:
                continue
            away = self._x[3 + 2 * i : 5 + 2 * i] - track.position
            if hypot(*away.tolist()) < self._mapping.match_distance:
                self._ids[i] = k
                return True
        return False

    def _associate(self, frame: Frame) -> dict[int, Observation]:
        """The detection of each landmark that has one beyond doubt, by the landmark's index."""
        found: dict[int, tuple[float, Observation]] = {}
        for o in frame.observations:
            if not _clear(o):
                continue
            fits = []
            for i, label in enumerate(self._labels):
                if label != o.label:
                    continue
                away = self._away(o, self._x[3 + 2 * i : 5 + 2 * i])
                if away < self._mapping.search_distance:
                    y, H = self._residual(i, o)
                    entries = self._entries(i)
                    S = H @ self._P[np.ix_(entries, entries)] @ H.T + o.covariance
                    distance = float(y @ np.linalg.solve(S, y))
                    if distance < self._localization.gate:
                        fits.append((distance, i))
            if len(fits) == 1 and fits[0][0] < found.get(fits[0][1], (inf,))[0]:
                found[fits[0][1]] = (fits[0][0], o)
        return {i: o for i, (_, o) in found.items()}

    def _entries(self, i: int) -> list[int]:
        """Places in the state of the pose and of landmark `i` (5)."""
        return [0, 1, 2, 3 + 2 * i, 4 + 2 * i]

    def _residual(self, i: int, o: Observation) -> tuple[Array, Array]:
        """Innovation (2,) and its derivative by the pose and landmark `i` (2, 5)."""
        x, y, heading = self._x[:3].tolist()
        px, py = self._x[3 + 2 * i : 5 + 2 * i].tolist()
        dx, dy = px - x, py - y
        d = max(hypot(dx, dy), 1e-6)
        u, v = dx / d, dy / d
        residual = np.array([o.distance - d, wrap(o.bearing - atan2(dy, dx) + heading)])
        derivative = np.array([[-u, -v, 0.0, u, v], [v / d, -u / d, -1.0, -v / d, u / d]])
        return residual, derivative

    def _away(self, o: Observation, place: Array) -> float:
        """Distance between a detection and a place in W (2,) [m]."""
        way = float(self._x[2]) + o.bearing
        x = float(self._x[0] - place[0]) + o.distance * cos(way)
        y = float(self._x[1] - place[1]) + o.distance * sin(way)
        return hypot(x, y)

    def _map(self, k: int, o: Observation, time: float) -> None:
        """Add a landmark where a detection puts it, with all correlations."""
        way = float(self._x[2]) + o.bearing
        c, s, d = cos(way), sin(way), o.distance
        n = len(self._x)
        J = np.zeros((2, n))
        J[:, :3] = [[1.0, 0.0, -d * s], [0.0, 1.0, d * c]]
        polar = np.array([[c, -d * s], [s, d * c]])
        P = np.empty((n + 2, n + 2))
        P[:n, :n] = self._P
        P[n:, :n] = J @ self._P
        P[:n, n:] = P[n:, :n].T
        P[n:, n:] = J @ self._P @ J.T + polar @ o.covariance @ polar.T
        self._P = 0.5 * (P + P.T)
        self._x = np.append(self._x, self._x[:2] + d * np.array([c, s]))
        self._ids.append(k)
        self._labels.append(o.label)
        self._seen_at.append(time)
        self._mapped_at.append(time)

    def _forget(self, i: int) -> None:
        gone = [3 + 2 * i, 4 + 2 * i]
        self._x = np.delete(self._x, gone)
        self._P = np.delete(np.delete(self._P, gone, axis=0), gone, axis=1)
        for kept in (self._ids, self._labels, self._seen_at, self._mapped_at):
            del kept[i]


def _clear(o: Observation) -> bool:
    """Whether a detection is good enough for a landmark."""
    return o.kind == "obstacle" and not o.cut and not o.occluded
