"""Camera frames as the dashboard and the maps show them: rows of the table, with the true pose.

The attributes of a frame are the columns `COLUMNS`, ``truth``, the true pose (3,) [m, m, rad], and
``gaze_map``, the latest gaze map in 255 shades, left and up of the head at left and up
(tilts, pans), None without a map.
"""

from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.recorder.frame_row import FRAME
from hsr8.recorder.recorded import FrameSampler
from hsr8.recorder.run.run import Run
from hsr8.recorder.table import Table

Array = NDArray[np.float64]

COLUMNS = (
    *("time", "captured", "pose", "pose_covariance", "lost", "head", "fov", "gaze", "psi"),
    *("target", "via_points", "velocity", "situation"),
    *(f"tracks.{c}" for c in ("id", "label", "position", "velocity", "covariance", "radius")),
    *("tracks.motion", "tracks.visible", "virtual_obstacles.position", "virtual_obstacles.radius"),
    *("detections.label", "detections.box", "detections.distance"),
)


def shown_frames(run: Run, times: Array) -> tuple[SimpleNamespace, ...]:
    """Return the latest camera frame at each of the times (m,) [s]; empty if the run has none.

    Times with the same frame have the same object.
    """
    frames, records = run.frames, run.records
    if not len(frames):
        return ()
    rows, index = np.unique(frames.at(times), return_inverse=True)
    truth = records["robot"][records.at(frames["time"][rows])]
    shown = _shown(frames, rows, truth)
    return tuple(shown[k] for k in index.tolist())


def shown_frame(frame: FrameRecord, robot: Array) -> SimpleNamespace:
    """Return one camera frame with the true pose (3,) of the robot."""
    frames = Table.from_objects("frames", FRAME, [FrameSampler().sample(frame)])
    return _shown(frames, np.array([0]), robot[None])[0]


def _shown(frames: Table, rows: NDArray[np.intp], truth: Array) -> list[SimpleNamespace]:
    """Return camera frames, each with the true pose of the robot (n, 3)."""
    made, maps = frames.present("gaze_map")
    latest = np.searchsorted(made, rows, side="right") - 1
    shown = frames.take(rows).objects(*COLUMNS)
    for frame, robot, k in zip(shown, truth.tolist(), latest.tolist(), strict=True):
        frame.truth = robot
        frame.gaze_map = maps[k][::-1, ::-1] if k >= 0 else None
    return shown
