"""Curves and state lanes: what went on, over time."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import ellipse, palette
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.record import TickRecord
from navigation.angles import wrap

Array = NDArray[np.float64]

BLUE, ORANGE, GREEN, GREY = (52, 112, 206), (240, 140, 20), (76, 168, 78), (130, 130, 134)
RED, VIOLET, SAND = (206, 60, 56), (146, 84, 196), (196, 178, 130)
SITUATIONS = {
    "free": GREEN,
    "accelerate": BLUE,
    "brake": ORANGE,
    "escape": RED,
    "path_change": VIOLET,
}
GAZE = {
    "local map": GREY,
    "self": BLUE,
    "obstacle": ORANGE,
    "way": GREEN,
    "search": RED,
    "none": SAND,
}
LOCALIZATION = {"localized": GREEN, "lost": RED}


class Curves:
    """Several curves in one plot.

    Args:
        stream: where they go.
        path: entity of the plot.
        curves: name and colour of each.
    """

    def __init__(
        self,
        stream: BlockStream,
        path: str,
        curves: Sequence[tuple[str, palette.Color]],
    ) -> None:
        names, colors = zip(*curves, strict=True)
        stream.log(path, rr.SeriesLines(names=list(names), colors=list(colors)), static=True)
        self._channel = Channel(stream, path, rr.Scalars.columns)

    def add(self, times: Sequence[float], values: Array) -> None:
        """Values of all curves at n times (n, curves); NaN leaves a gap."""
        self._channel.add_rows(times, [values.shape[1]] * len(values), scalars=values.ravel())

    def flush(self) -> None:
        """Send the block."""
        self._channel.flush()


class Lane:
    """A state over time; only changes are logged.

    Args:
        stream: where it goes.
        path: entity of the lane.
        states: colour of every state.
    """

    def __init__(self, stream: BlockStream, path: str, states: dict[str, palette.Color]) -> None:
        look = rr.StateConfiguration(values=list(states), colors=list(states.values()))
        stream.log(path, look, static=True)
        self._channel = Channel(stream, path, rr.StateChange.columns)
        self._state = ""

    def add(self, time: float, state: str) -> None:
        """The state at `time`."""
        if state != self._state:
            self._state = state
            self._channel.add(time, state=[state])

    def flush(self) -> None:
        """Send the block."""
        self._channel.flush()


def gaze_reason(frame: FrameRecord) -> str:
    """What the head looks for: the largest partial evaluation at the time of the choice."""
    if frame.belief.lost:
        return "search"
    gaze = frame.gaze
    values = (gaze.psi_lm, gaze.psi_sf, gaze.psi_ob, gaze.psi_way)
    return tuple(GAZE)[values.index(max(values))] if max(values) > 0.0 else "none"


class PlotLayer:
    """Plots and state lanes of the decisions and the belief."""

    def __init__(self, stream: BlockStream) -> None:
        self._clearance = Curves(stream, "/plots/clearance", (("clearance [m]", BLUE),))
        self._partial = Curves(
            stream,
            "/plots/partial",
            (("ψ local map", GREY), ("ψ self", BLUE), ("ψ obstacle", ORANGE), ("ψ way", GREEN)),
        )
        self._error = Curves(
            stream,
            "/plots/pose_error",
            (("position error [m]", BLUE), ("2σ [m]", GREY), ("heading error [rad]", ORANGE)),
        )
        self._situation = Lane(stream, "/state/planner", SITUATIONS)
        self._gaze = Lane(stream, "/state/gaze", GAZE)
        self._localization = Lane(stream, "/state/localization", LOCALIZATION)
        self._parts = (
            self._clearance,
            self._partial,
            self._error,
            self._situation,
            self._gaze,
            self._localization,
        )

    def add(self, records: Sequence[TickRecord]) -> None:
        """Take records at the rate of the plots."""
        clearance = np.array([[record.truth.clearance] for record in records])
        shown = np.where(np.isfinite(clearance), clearance, np.nan)
        self._clearance.add([record.time for record in records], shown)

    def add_frames(self, seen: Sequence[tuple[FrameRecord, Array]]) -> None:
        """Take camera frames, each with the true pose (3,) at that time."""
        frames = [frame for frame, _ in seen]
        times, gazes = [f.time for f in frames], [f.gaze for f in frames]
        self._partial.add(
            times, np.array([(g.psi_lm, g.psi_sf, g.psi_ob, g.psi_way) for g in gazes])
        )
        dx, dy, turn = np.array([frame.belief.pose - truth for frame, truth in seen]).T
        covariance = np.array([f.belief.pose_covariance for f in frames])[:, :2, :2]
        spread = 2.0 * ellipse.axes(covariance)[0][:, 0]
        turned = [abs(wrap(angle)) for angle in turn.tolist()]
        self._error.add(times, np.column_stack([np.hypot(dx, dy), spread, turned]))
        for frame in frames:
            self._situation.add(frame.time, frame.motion.situation)
            self._gaze.add(frame.time, gaze_reason(frame))
            self._localization.add(frame.time, "lost" if frame.belief.lost else "localized")

    def flush(self) -> None:
        """Send the block."""
        for part in self._parts:
            part.flush()
