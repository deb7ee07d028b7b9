"""What the planner is about to do: its field around the robot, the way along it, the decision."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.log.throttle import Throttle
from navigation.decision import DirectionField, MotionDecision
from navigation.motion.univector import normalized

Array = NDArray[np.float64]

SPACING, REACH = 0.25, 1.5  # of the arrows of the field, and how far they go [m]
ARROW = 0.13  # length of each [m]
STRIDE, STRIDES = 0.15, 8  # of the way that follows the field [m]
SPEED_SCALE = 2.0  # the arrow of the decision shows the way of so many seconds [s]
HEIGHT = 0.016  # at which all this is drawn [m]


class PlanLayer:
    """Logs each new motion decision; planners without a field have only the decision.

    Args:
        stream: where it goes.
        period: time between two fields at least [s].
    """

    def __init__(self, stream: BlockStream, period: float) -> None:
        self._throttle = Throttle(period)
        self._motion: MotionDecision | None = None
        self._shown = False
        for path, style in (
            ("/plan/field", rr.Arrows3D.from_fields(colors=[palette.FIELD], radii=[0.008])),
            ("/plan/way", rr.LineStrips3D.from_fields(colors=[palette.PLAN], radii=[0.007])),
            ("/plan/decision", rr.Arrows3D.from_fields(colors=[palette.PLAN], radii=[0.011])),
        ):
            stream.log(path, style, static=True)
        self._field = Channel(stream, "/plan/field", rr.Arrows3D.columns)
        self._way = Channel(stream, "/plan/way", rr.LineStrips3D.columns)
        self._decision = Channel(stream, "/plan/decision", rr.Arrows3D.columns)

    def add(self, frames: Sequence[FrameRecord]) -> None:
        """Take camera frames."""
        for frame in frames:
            if frame.motion is not self._motion:
                self._motion = frame.motion
                self._add_decision(frame, frame.motion)

    def flush(self) -> None:
        """Send the block."""
        for channel in (self._field, self._way, self._decision):
            channel.flush()

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
            here = frame.belief.pose[:2]
            points = grid(here)
            way = along(motion.field, here, frame.task.target)
            self._draw(frame.time, points, normalized(motion.field.at(points)), [way])

    def _draw(self, time: float, points: Array, directions: Array, ways: list[Array]) -> None:
        arrows = ARROW * _raised(directions, 0.0)
        # The middle of an arrow is the point that it tells of.
        self._field.add(time, origins=_raised(points, HEIGHT) - 0.5 * arrows, vectors=arrows)
        self._way.add(time, strips=[_raised(way, HEIGHT) for way in ways])


def grid(here: Array) -> Array:
    """Points around `here` (2,) that stay where they are while the robot moves on (n, 2) [m]."""
    middle = np.round(here / SPACING) * SPACING
    steps = np.arange(-REACH, REACH + 0.5 * SPACING, SPACING)
    x, y = np.meshgrid(middle[0] + steps, middle[1] + steps)
    points = np.column_stack([x.ravel(), y.ravel()])
    inside: Array = points[np.hypot(*(points - here).T) <= REACH]
    return inside


def along(field: DirectionField, here: Array, target: Array) -> Array:
    """Where the field leads from `here` (2,), as far as `target` (2,) (n, 2) [m]."""
    way = [np.asarray(here, dtype=float)]
    for _ in range(STRIDES):
        if float(np.hypot(*(target - way[-1]))) <= STRIDE:
            way.append(target)
            break
        way.append(way[-1] + STRIDE * normalized(field.at(way[-1])))
    return np.array(way)


def _raised(points: Array, height: float) -> Array:
    return np.column_stack([points, np.full(len(points), height)])
