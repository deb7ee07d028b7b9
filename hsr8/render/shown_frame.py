"""Camera frames as the dashboard and the maps show them: rows of the table, with the true pose.

The attributes of a frame are the columns `COLUMNS`, ``truth``, the true pose (3,) [m, m, rad], and
``gaze_map``, the latest gaze map in 255 shades, left and up of the head at left and up
(tilts, pans), None without a map.
"""

from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.run.run import Run

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
    made, maps = frames.present("gaze_map")
    latest = np.searchsorted(made, rows, side="right") - 1
    shown = frames.take(rows).objects(*COLUMNS)
    for frame, robot, k in zip(shown, truth.tolist(), latest.tolist(), strict=True):
        frame.truth = robot
        frame.gaze_map = maps[k][::-1, ::-1] if k >= 0 else None
    return tuple(shown[k] for k in index.tolist())
