"""Prediction of the belief over the latency of the camera."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.observation import CameraView
from navigation.transform import propagate

Array = NDArray[np.float64]


def predict(belief: Belief, then: Array, now: Array, time: float, view: CameraView) -> Belief:
    """Predict a belief from the capture of its frame to the present.

    Over the latency the odometry is much more precise than the pose, so the covariance follows
    the motion and does not grow. Tracks move with constant velocity. Age, particles, turn rate
    and the local map remain those of the frame.

    Args:
        belief: at the capture.
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
