"""EKF SLAM: localization without beacons, by static obstacles mapped as landmarks.

An extended Kalman filter of the pose and all landmarks together (Smith, Self & Cheeseman). The
error of the pose at which a landmark was mapped is also an error of the landmark; the
correlation of the two determines the gain of later detections. The start pose defines W.

Several missing landmarks mean that the pose is wrong, unless other landmarks of the same age
are detected. The map is then frozen until its constellation is matched again.
"""

from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Motion, Track
from navigation.belief.detections import in_world, variance_inflation
from navigation.belief.localization import MAX_SHARED
from navigation.belief.map_relocalization import MapRelocalization
from navigation.belief.visibility import Viewpoint, clear_points
from navigation.observation import Frame, Observation, bearing_variance
from navigation.parameters.belief import BeliefParameters
from navigation.transform import propagate, yaw_rotation

Array = NDArray[np.float64]

START_VARIANCE = 1e-10
"""Variance of the start pose [m², rad²]."""


class EkfSlam:
    """Extended Kalman filter of the pose and the mapped landmarks.

    Args:
        parameters: parameters of the belief.
        pose: x, y, heading at the start (3,) [m, m, rad].

    Attributes:
        lost: whether landmarks have been missing in clear view.
        faults: number of re-initializations after numerical failures.
        recoveries: number of relocalizations.
    """

    def __init__(self, parameters: BeliefParameters, pose: Array) -> None:
        self._localization = parameters.localization
        self._mapping = parameters.mapping
        self._tracking = parameters.tracking
        self._x = np.array(pose, float)
        self._P = START_VARIANCE * np.eye(3)
        # Of each landmark: its track, or a negative number without one; colour; times.
        self._ids: list[int] = []
        self._labels: list[str] = []
        self._seen_at: list[float] = []
        self._mapped_at: list[float] = []
        self._previous: tuple[float, Array] | None = None
        self._relocalization = MapRelocalization(
            parameters.relocalization, self._localization.recovery_window
        )
        # Missed detections by landmark: time of its last detection, count.
        self._missing: dict[int, tuple[float, int]] = {}
        self.lost = False
        self.faults = 0
        self.recoveries = 0

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

    def update(self, frame: Frame) -> None:
        """Predict by the odometry since the last frame, then correct by the landmarks in it.

        Raises:
            ValueError: if the frame is not younger than the one before.
        """
        if self._previous is not None:
            frame.check_after(self._previous[0])
        self._predict(frame)
        valid = self._x[:3].copy(), self._P[:3, :3].copy()
        try:
            if self.lost:
                self._recover(frame)
            else:
                self._detect_failure(frame, self._correct(frame))
        except np.linalg.LinAlgError:
            self._P[0, 0] = np.nan
        if not (np.isfinite(self._x).all() and np.isfinite(self._P).all()):
            self.faults += 1
            self._x, self._P = valid
            self._ids, self._labels, self._seen_at, self._mapped_at = [], [], [], []
            self._missing.clear()
            self.lost = False

    def map_landmarks(self, frame: Frame, tracks: Sequence[Track]) -> None:
        """Add static tracks as landmarks and delete those no longer static.

        The map does not change while lost, because the tracks are displaced by the wrong pose.

        Args:
            frame: frame of the last update.
            tracks: tracks after that frame.
        """
        if self.lost:
            return
        static = {t.id: t for t in tracks if t.motion is Motion.STATIC}
        for i in reversed([i for i, k in enumerate(self._ids) if k >= 0 and k not in static]):
            self._delete(i)
        candidates = [o for o in frame.observations if _usable(o)]
        for k, track in static.items():
            if k in self._ids or not track.visible or self._reassigned(k, track):
                continue
            matches = self._detections_at(track.position, track.label, candidates)
            if len(matches) == 1:
                self._add(k, matches[0], frame.time)

    def _predict(self, frame: Frame) -> None:
        previous = self._previous
        self._previous = (frame.time, frame.odometry.copy())
        if previous is None:
            return
        x, P = self._x, self._P
        rotation = yaw_rotation(float(x[2]))
        x[:3], F = propagate(x[:3], previous[1], frame.odometry)
        P[:3] = F @ P[:3]
        P[:, :3] = P[:, :3] @ F.T
        drift = self._localization.drift_rate() * (frame.time - previous[0])
        P[:3, :3] += rotation @ frame.motion_covariance @ rotation.T + drift
        self._P = 0.5 * (P + P.T)

    def _correct(self, frame: Frame) -> list[int]:
        """Correct by all landmarks of a frame; return their indices."""
        matched = self._associate(frame)
        if not matched:
            return []
        n = len(self._x)
        H = np.zeros((2 * len(matched), n))
        R = np.zeros((2 * len(matched), 2 * len(matched)))
        y = np.zeros(2 * len(matched))
        smallest = min(bearing_variance(o) for o in matched.values())
        R[1::2, 1::2] = min(frame.view.model.yaw_sigma**2, MAX_SHARED * smallest)
        for row, (i, o) in enumerate(matched.items()):
            a, b = 2 * row, 2 * row + 2
            y[a:b], H[a:b][:, _entries(i)] = self._innovation(i, o)
            age = frame.time - self._seen_at[i]
            R[a:b, a:b] = o.covariance * variance_inflation(age, self._tracking.correlation_time)
            self._seen_at[i] = frame.time
        PH = self._P @ H.T
        K = np.linalg.solve(H @ PH + R, PH.T).T
        self._x = self._x + K @ y
        joseph = np.eye(n) - K @ H
        P = joseph @ self._P @ joseph.T + K @ R @ K.T
        self._P = 0.5 * (P + P.T)
        return list(matched)

    def _detect_failure(self, frame: Frame, matched: list[int]) -> None:
        """Detect that the pose is wrong.

        A match with a landmark mapped before another was last seen shows that the other one
        has disappeared. Landmarks mapped after the missing ones were last seen may have been
        mapped from a wrong pose and are deleted.
        """
        for k, (seen_at, _) in list(self._missing.items()):
            if any(self._mapped_at[i] <= seen_at for i in matched):
                del self._missing[k]
        if not frame.observations or not self._ids:
            return  # the camera may have failed
        p = self._tracking
        pose, covariance = self.pose, self.covariance
        detections = in_world(frame.observations, pose, covariance, max_pose_sigma=p.max_pose_sigma)
        viewpoint = Viewpoint.of(frame.view, pose, p.detection_range, p.view_margin)
        landmarks, discs = self._x[3:].reshape(-1, 2), (detections.positions, detections.radii)
        expected = clear_points(landmarks, *viewpoint, *discs, p.occlusion_margin)
        for i in np.flatnonzero(expected).tolist():
            # A cut or occluded detection is too inexact to correct the pose, but shows that it is
            # right.
            present = self._detections_at(landmarks[i], self._labels[i], frame.observations)
            if i not in matched and not present:
                _, count = self._missing.get(self._ids[i], (0.0, 0))
                self._missing[self._ids[i]] = self._seen_at[i], count + 1
        misses = sum(count for _, count in self._missing.values())
        if len(self._missing) > 1 and misses >= self._localization.lost_rejections:
            valid_until = max(seen_at for seen_at, _ in self._missing.values())
            for i in reversed([i for i, t in enumerate(self._mapped_at) if t > valid_until]):
                self._delete(i)
            self._missing.clear()
            self._relocalization.begin()
            self.lost = True
            self._reset_covariance(self._localization.lost_covariance())

    def _recover(self, frame: Frame) -> None:
        """Relocalize from the recent detections."""
        self._relocalization.remember([o for o in frame.observations if _usable(o)], frame)
        pose = self._relocalization.locate(frame, self._labels, self._x[3:].reshape(-1, 2))
        if pose is None:
            return
        self.lost = False
        self.recoveries += 1
        self._x[:3] = pose
        self._reset_covariance(self._localization.recovery_covariance())
        # The tracks of the landmarks end with the wrong pose; new tracks are assigned to them.
        self._ids = [-1 - i for i in range(len(self._ids))]
        self._correct(frame)

    def _reset_covariance(self, covariance: Array) -> None:
        """Set the covariance of a pose independent of all landmarks."""
        self._P[:3, :] = 0.0
        self._P[:, :3] = 0.0
        self._P[:3, :3] = covariance

    def _reassigned(self, k: int, track: Track) -> bool:
        """Assign a new track to the landmark without one at its position, if there is one."""
        for i, number in enumerate(self._ids):
            if number >= 0 or self._labels[i] != track.label:
                continue
            offset = self._x[3 + 2 * i : 5 + 2 * i] - track.position
            if hypot(*offset.tolist()) < self._mapping.match_distance:
                self._ids[i] = k
                return True
        return False

    def _associate(self, frame: Frame) -> dict[int, Observation]:
        """Return the unambiguous detection of each landmark, by the landmark's index."""
        matched: dict[int, tuple[float, Observation]] = {}
        for o in frame.observations:
            if not _usable(o):
                continue
            gated = []
            for i, label in enumerate(self._labels):
                if label != o.label:
                    continue
                landmark = self._x[3 + 2 * i : 5 + 2 * i]
                if self._distance(o, landmark) < self._mapping.search_distance:
                    y, H = self._innovation(i, o)
                    entries = _entries(i)
                    S = H @ self._P[np.ix_(entries, entries)] @ H.T + o.covariance
                    nis = float(y @ np.linalg.solve(S, y))
                    if nis < self._localization.gate:
                        gated.append((nis, i))
            if len(gated) == 1 and gated[0][0] < matched.get(gated[0][1], (inf,))[0]:
                matched[gated[0][1]] = (gated[0][0], o)
        return {i: o for i, (_, o) in matched.items()}

    def _detections_at(
        self, position: Array, label: str, observations: Sequence[Observation]
    ) -> list[Observation]:
        """Return the detections of an obstacle of a colour at a position in W (2,) [m]."""
        return [
            o
            for o in observations
            if o.kind == "obstacle"
            and o.label == label
            and self._distance(o, position) < self._mapping.match_distance
        ]

    def _innovation(self, i: int, o: Observation) -> tuple[Array, Array]:
        """Return the innovation (2,) and its Jacobian by the pose and landmark `i` (2, 5)."""
        x, y, heading = self._x[:3].tolist()
        px, py = self._x[3 + 2 * i : 5 + 2 * i].tolist()
        dx, dy = px - x, py - y
        d = max(hypot(dx, dy), 1e-6)
        u, v = dx / d, dy / d
        innovation = np.array([o.distance - d, wrap(o.bearing - atan2(dy, dx) + heading)])
        jacobian = np.array([[-u, -v, 0.0, u, v], [v / d, -u / d, -1.0, -v / d, u / d]])
        return innovation, jacobian

    def _distance(self, o: Observation, position: Array) -> float:
        """Return the distance between a detection and a position in W (2,) [m]."""
        direction = float(self._x[2]) + o.bearing
        x = float(self._x[0] - position[0]) + o.distance * cos(direction)
        y = float(self._x[1] - position[1]) + o.distance * sin(direction)
        return hypot(x, y)

    def _add(self, k: int, o: Observation, time: float) -> None:
        """Add a landmark at a detection, with all correlations."""
        direction = float(self._x[2]) + o.bearing
        c, s, d = cos(direction), sin(direction), o.distance
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

    def _delete(self, i: int) -> None:
        entries = [3 + 2 * i, 4 + 2 * i]
        self._x = np.delete(self._x, entries)
        self._P = np.delete(np.delete(self._P, entries, axis=0), entries, axis=1)
        for values in (self._ids, self._labels, self._seen_at, self._mapped_at):
            del values[i]


def _entries(i: int) -> list[int]:
    """Indices of the pose and of landmark `i` in the state (5)."""
    return [0, 1, 2, 3 + 2 * i, 4 + 2 * i]


def _usable(o: Observation) -> bool:
    """Return whether an obstacle is detected as a whole."""
    return o.kind == "obstacle" and not o.cut and not o.occluded
