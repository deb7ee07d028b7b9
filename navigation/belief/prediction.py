"""The belief now, from a camera frame that arrived late."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.observation import CameraView
from navigation.transform import moved_on

Array = NDArray[np.float64]


def predict(belief: Belief, then: Array, now: Array, time: float, view: CameraView) -> Belief:
    """Carry a belief on from the capture of its frame.

    Odometry over so short a time is far better known than the pose, so the covariance
    follows the motion and does not grow. Tracks move on straight along their velocities. All
    else of them stays as of the frame, age, particles and turn rate too, and so does the map.

    Args:
        belief: at the capture.
        then: pose of R in the odometry frame at the capture (3,) [m, m, rad].
        now: the same now (3,).
        time: now [s].
        view: where the camera looks now.
    """
    pose, J = moved_on(belief.pose, then, now)
    pose[2] = wrap(float(pose[2]))
    dt = time - belief.time
    return replace(
        belief,
        time=time,
        pose=pose,
        pose_covariance=J @ belief.pose_covariance @ J.T,
        tracks=tuple(replace(t, position=t.position + dt * t.velocity) for t in belief.tracks),
        view=view,
    )
