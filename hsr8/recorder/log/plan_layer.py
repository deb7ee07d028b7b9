"""Plan of the motion planner: its direction field, the path along the field, the decision."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.recorder.log.geometry import raised
from hsr8.recorder.table import Table

Array = NDArray[np.float64]

ARROW = 0.13  # length of the arrows of the field in a world of scale 1 [m]
SPEED_SCALE = 2.0  # prediction time of the arrow of the decision [s]
HEIGHT = 0.016  # of the drawing [m]


class PlanLayer:
    """Layer of new motion decisions, with the field of planners that have one.

    Args:
        stream: recording.
        scale: of the world [1].
    """

    def __init__(self, stream: BlockStream, scale: float = 1.0) -> None:
        self._scale = scale
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

    def add(self, frames: Table) -> None:
        """Take camera frames."""
        planned = frames.take(np.flatnonzero(frames["planned"]))
        if not len(planned):
            return
        times = planned["time"].tolist()
        direction, length = planned["direction"], SPEED_SCALE * planned["speed"]
        arrows = np.column_stack([length * np.cos(direction), length * np.sin(direction)])
        self._decision.add_rows(
            times,
            [1] * len(times),
            origins=raised(planned["pose"][:, :2], HEIGHT),
            vectors=raised(arrows, 0.0),
        )
        fields = zip(
            times,
            planned["field_points"],
            planned["field_directions"],
            planned["field_path"],
            strict=True,
        )
        for time, points, directions, path in fields:
            if not len(points):
                continue
            vectors = ARROW * self._scale * raised(directions, 0.0)
            # Arrows are centred on their points.
            origins = raised(points, HEIGHT) - 0.5 * vectors
            self._field.add(time, origins=origins, vectors=vectors)
            self._path.add(time, strips=[raised(path, HEIGHT)])
