"""Plan of the motion planner: its direction field, the path along the field, the decision."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.recorder import palette
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.throttle import Throttle
from navigation.decision import DirectionField, MotionDecision
from navigation.motion.univector import normalized

Array = NDArray[np.float64]

# Lengths are those in a world of scale 1.
SPACING, REACH = 0.25, 1.5  # of the arrows of the field, and their maximum distance [m]
ARROW = 0.13  # length of each [m]
STEP, STEPS = 0.15, 8  # of the path that follows the field [m]
SPEED_SCALE = 2.0  # prediction time of the arrow of the decision [s]
HEIGHT = 0.016  # of the drawing [m]


class PlanLayer:
    """Layer of new motion decisions, with the field of planners that have one.

    Args:
        stream: recording.
        period: minimum interval between two fields [s].
        scale: of the world [1].
    """

    def __init__(self, stream: BlockStream, period: float, scale: float = 1.0) -> None:
        self._scale = scale
        self._throttle = Throttle(period)
        self._motion: MotionDecision | None = None
        self._shown = False
        field, plan = [palette.FIELD], [palette.PLAN]
        self._field = Channel(
            stream, "/plan/field", rr.Arrows3D, colors=field, radii=[0.008 * scale]
        )
        self._path = Channel(
            stream, "/plan/path", rr.LineStrips3D, colors=plan, radii=[0.007 * scale]
        )
        self._decision = Channel(
            stream, "/plan/decision", rr.Arrows3D, colors=plan, radii=[0.011 * scale]
        )

    def add(self, frames: Sequence[FrameRecord]) -> None:
        """Take camera frames."""
        for frame in frames:
            if frame.motion is not self._motion:
                self._motion = frame.motion
                self._add_decision(frame, frame.motion)

    def _add_decision(self, frame: FrameRecord, motion: MotionDecision) -> None:
        x, y, _ = frame.belief.pose.tolist()
        length = SPEED_SCALE * motion.speed
        self._decision.add(
            frame.time,
            origins=np.array([[x, y, HEIGHT]]),
            vectors=length * np.array([[cos(motion.direction), sin(motion.direction), 0.0]]),
        )
        if motion.field is None:
            if self._shown:
                self._draw(frame.time, np.zeros((0, 2)), np.zeros((0, 2)), [])
            self._shown = False
        elif self._throttle.due(frame.time):
            self._shown = True
            position = frame.belief.pose[:2]
            points = grid(position, self._scale)
            path = path_along(motion.field, position, frame.task.target, self._scale)
            self._draw(frame.time, points, normalized(motion.field.at(points)), [path])

    def _draw(self, time: float, points: Array, directions: Array, paths: list[Array]) -> None:
        arrows = ARROW * self._scale * _raised(directions, 0.0)
        # Arrows are centred on their points.
        self._field.add(time, origins=_raised(points, HEIGHT) - 0.5 * arrows, vectors=arrows)
        self._path.add(time, strips=[_raised(path, HEIGHT) for path in paths])


def grid(position: Array, scale: float = 1.0) -> Array:
    """Return the points of a fixed grid around `position` (2,) (n, 2) [m]."""
    spacing, reach = SPACING * scale, REACH * scale
    centre = np.round(position / spacing) * spacing
    steps = np.arange(-reach, reach + 0.5 * spacing, spacing)
    x, y = np.meshgrid(centre[0] + steps, centre[1] + steps)
    points = np.column_stack([x.ravel(), y.ravel()])
    inside: Array = points[np.hypot(*(points - position).T) <= reach]
    return inside


def path_along(field: DirectionField, position: Array, target: Array, scale: float = 1.0) -> Array:
    """Return the path along a field from `position` (2,) up to `target` (2,) (n, 2) [m]."""
    path, step = [np.asarray(position, dtype=float)], STEP * scale
    for _ in range(STEPS):
        if float(np.hypot(*(target - path[-1]))) <= step:
            path.append(target)
            break
        path.append(path[-1] + step * normalized(field.at(path[-1])))
    return np.array(path)


def _raised(points: Array, height: float) -> Array:
    return np.column_stack([points, np.full(len(points), height)])
