"""State estimation: localization, tracking and local map, once per camera frame; prediction."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.belief.detections import in_world
from navigation.belief.ekf_slam import EkfSlam
from navigation.belief.local_map import LocalMap
from navigation.belief.localization import Localizer
from navigation.belief.tracker import Tracker
from navigation.belief.tracks import Tracks
from navigation.belief.visibility import Viewpoint
from navigation.observation import CameraView, Frame
from navigation.parameters.belief import BeliefParameters
from navigation.transform import propagate

Array = NDArray[np.float64]


class Estimator:
    """Estimator of the belief from camera frames.

    Args:
        parameters: parameters of localization, tracking and local map.
        beacons: position in W by name [m]; empty: EKF SLAM, in which the start pose is exact and
            defines W.
        start_pose: x, y, heading of R in W (3,) [m, m, rad].
        start_covariance: covariance of the start pose (3, 3).
        rng: source of the particles of lost tracks.
    """

    def __init__(
        self,
        parameters: BeliefParameters,
        beacons: Mapping[str, tuple[float, float]],
        start_pose: Array,
        start_covariance: Array,
        rng: np.random.Generator,
    ) -> None:
        self._parameters = parameters
        self._localizer: Localizer | EkfSlam
        if beacons:
            self._localizer = Localizer(
                parameters.localization, beacons, start_pose, start_covariance
            )
        else:
            self._localizer = EkfSlam(parameters, start_pose)
        self._tracker = Tracker(parameters.tracking, rng)
        self._map: LocalMap | None = None
        self._recoveries = 0

    def update(self, frame: Frame) -> Belief:
        """Update by one frame; later frames never change the returned belief.

        Raises:
            ValueError: if the frame is not younger than the one before.
        """
        p = self._parameters
        localizer = self._localizer
        localizer.update(frame)
        pose, covariance = localizer.pose, localizer.covariance
        centre = (float(pose[0]), float(pose[1]))
        if self._map is None or localizer.recoveries != self._recoveries:
            # The wrong pose has displaced all tracks and cells.
            self._recoveries = localizer.recoveries
            self._map = LocalMap(p.local_map, centre, frame.time)
            self._tracker.clear()
        detections = in_world(
            frame.observations, pose, covariance, max_pose_sigma=p.tracking.max_pose_sigma
        )
        looked_at = p.tracking.detection_range, p.tracking.view_margin
        viewpoint = Viewpoint.of(frame.view, pose, *looked_at)
        free = self._map.free_at(detections.positions)
        tracks = self._tracker.update(frame.time, detections, viewpoint, free)
        if isinstance(localizer, EkfSlam):
            localizer.map_landmarks(frame, tracks)
        searched = Viewpoint.of(frame.view, pose, p.local_map.range)
        self._map.update(frame.time, searched, centre, detections.positions, detections.radii)
        return Belief(
            time=frame.time,
            pose=pose,
            pose_covariance=covariance,
            tracks=tracks,
            local_map=self._map.snapshot(),
            view=frame.view,
            seen_beacons=tuple(o.label for o in frame.observations if o.kind == "beacon"),
            lost=localizer.lost,
            filter_faults=localizer.faults,
        )


def predict(belief: Belief, then: Array, now: Array, time: float, view: CameraView) -> Belief:
    """Predict a belief from the capture of its frame to the present.

    Over the latency the odometry is much more precise than the pose, so the covariance follows
    the motion and does not grow. Tracks move with constant velocity. Age, particles, turn rate
    and the local map remain those of the frame.

    Args:
        belief: belief at the capture.
        then: pose of R in the odometry frame at the capture (3,) [m, m, rad].
        now: pose of R in the odometry frame now (3,) [m, m, rad].
        time: now [s].
        view: pose and field of view of the camera now.
    """
    pose, J = propagate(belief.pose, then, now)
    pose[2] = wrap(float(pose[2]))
    dt = time - belief.time
    return replace(
        belief,
        time=time,
        pose=pose,
        pose_covariance=J @ belief.pose_covariance @ J.T,
        tracks=Tracks.of(belief.tracks).moved(dt),
        view=view,
    )
