"""The belief now, from a camera frame that arrived late."""

from dataclasses import replace
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief
from navigation.observation import CameraView

Array = NDArray[np.float64]


def predict(belief: Belief, then: Array, now: Array, time: float, view: CameraView) -> Belief:
    """Carry a belief on from the capture of its frame.

    Odometry over so short a time is far better known than the pose, so the covariance
    follows the motion and does not grow.

    Args:
        belief: at the capture.
        then: pose of R in the odometry frame at the capture (3,) [m, m, rad].
        now: the same now (3,).
        time: now [s].
        view: where the camera looks now.
    """
    dx, dy, turn = (now - then).tolist()
    x, y, heading = belief.pose.tolist()
    offset = heading - float(then[2])
    c, s = cos(offset), sin(offset)
    right, up = c * dx - s * dy, s * dx + c * dy
    J = np.array([[1.0, 0.0, -up], [0.0, 1.0, right], [0.0, 0.0, 1.0]])
    dt = time - belief.time
    return replace(
        belief,
        time=time,
        pose=np.array([x + right, y + up, wrap(heading + turn)]),
        pose_covariance=J @ belief.pose_covariance @ J.T,
        tracks=tuple(replace(t, position=t.position + dt * t.velocity) for t in belief.tracks),
        view=view,
    )
