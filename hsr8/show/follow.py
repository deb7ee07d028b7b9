"""Free camera that follows the robot from behind, with smooth motion."""

from math import atan2, ceil, degrees

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.rotation import heading

Array = NDArray[np.float64]

# Lengths are those for the default robot; they grow with the height of the robot.
DISTANCE = 1.75  # from the robot [m]
ELEVATION = -22.0  # looking down [deg]
SIDE_ANGLE = 35.0  # of the camera to the right of straight behind [deg]
HEIGHT = 0.22  # of the point looked at [m]
POSITION_TIME = 0.6  # time constant of the position, in video time [s]
MAX_POSITION_TIME = 1.2  # in simulated time, so that the robot stays in fast videos [s]
DIRECTION_TIME = 2.5  # time constant of the direction, in video time [s]
LOOKAHEAD = 2.0  # time constants after which other frames have no influence [1]


class FollowCamera:
    """Camera poses for a whole video.

    Args:
        qpos: configurations of the robot at each frame of the video (n, nq).
        fps: frames per second of the video.
        speed: simulated seconds per second of video.
        size: height of the robot relative to the default robot [1].
    """

    def __init__(self, qpos: Array, fps: float, speed: float, size: float = 1.0) -> None:
        self._ratio = size
        yaw = np.unwrap([heading(row[3:7]) for row in qpos])
        self._target = _smooth(qpos[:, :2], min(POSITION_TIME, MAX_POSITION_TIME / speed) * fps)
        direction = _smooth(np.column_stack([np.cos(yaw), np.sin(yaw)]), DIRECTION_TIME * fps)
        self._yaw = np.unwrap([atan2(y, x) for x, y in direction.tolist()])

    def at(self, index: int) -> mujoco.MjvCamera:
        """Return the camera of one frame."""
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = (*self._target[index], HEIGHT * self._ratio)
        camera.distance = DISTANCE * self._ratio
        camera.elevation = ELEVATION
        camera.azimuth = degrees(self._yaw[index]) + SIDE_ANGLE
        return camera


def _smooth(values: Array, frames: float) -> Array:
    """Filter exponentially backwards and forwards, without lag (n, m).

    Each frame depends on the frames within `LOOKAHEAD` time constants.
    """
    keep, ahead = np.exp(-1.0 / max(frames, 1e-6)), ceil(LOOKAHEAD * frames)
    weights = keep ** np.arange(ahead + 1)
    weights /= weights.sum()
    smooth = values.astype(np.float64)
    for _ in range(2):  # over the previous frames, then over the next ones
        smooth = smooth[::-1]
        padded = np.concatenate([smooth, np.repeat(smooth[-1:], ahead, axis=0)])
        parts = (w * padded[k : k + len(smooth)] for k, w in enumerate(weights))
        smooth = np.sum(list(parts), axis=0)
    return smooth
