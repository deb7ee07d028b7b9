"""Curves and state lanes over time."""

from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import ellipse, palette
from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.recorder.table import Table
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
        stream: recording.
        path: entity of the plot.
        curves: name and colour of each.
    """

    def __init__(
        self, stream: BlockStream, path: str, curves: Sequence[tuple[str, palette.Color]]
    ) -> None:
        names, colors = zip(*curves, strict=True)
        stream.log(path, rr.SeriesLines(names=list(names), colors=list(colors)), static=True)
        self._channel = Channel(stream, path, rr.Scalars)

    def add(self, times: Sequence[float], values: Array) -> None:
        """Add the values of all curves at n times (n, curves); NaN leaves a gap."""
        self._channel.add_rows(times, [values.shape[1]] * len(values), scalars=values.ravel())


class Lane:
    """A state over time; only changes are logged.

    Args:
        stream: recording.
        path: entity of the lane.
        states: colour of every state.
    """

    def __init__(self, stream: BlockStream, path: str, states: dict[str, palette.Color]) -> None:
        style = rr.StateConfiguration(values=list(states), colors=list(states.values()))
        stream.log(path, style, static=True)
        self._channel = Channel(stream, path, rr.StateChange)
        self._state = ""

    def add(self, time: float, state: str) -> None:
        """Add the state at `time`."""
        if state != self._state:
            self._state = state
            self._channel.add(time, state=[state])


def gaze_reasons(frames: Table) -> list[str]:
    """Return the reason of the gaze of each frame: its maximum partial evaluation."""
    psi, lost, names = frames["psi"], frames["lost"], tuple(GAZE)
    best, any_ = psi.argmax(axis=1).tolist(), psi.max(axis=1) > 0.0
    return [
        "search" if is_lost else names[k] if positive else "none"
        for k, positive, is_lost in zip(best, any_.tolist(), lost.tolist(), strict=True)
    ]


class PlotLayer:
    """Layer of plots and state lanes of decisions and belief."""

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

    def add(self, records: Table) -> None:
        """Take records at the rate of the plots."""
        clearance = records["clearance"][:, None]
        shown = np.where(np.isfinite(clearance), clearance, np.nan)
        self._clearance.add(records["time"].tolist(), shown)

    def add_frames(self, frames: Table, truth: Array) -> None:
        """Take camera frames, each with the true pose of that time (n, 3)."""
        times = frames["time"].tolist()
        self._partial.add(times, frames["psi"])
        dx, dy, turn = (frames["pose"] - truth).T
        spread = 2.0 * ellipse.axes(frames["pose_covariance"][:, :2, :2])[0][:, 0]
        turned = [abs(wrap(angle)) for angle in turn.tolist()]
        self._error.add(times, np.column_stack([np.hypot(dx, dy), spread, turned]))
        localization = ["lost" if lost else "localized" for lost in frames["lost"].tolist()]
        for lane, states in (
            (self._situation, frames["situation"]),
            (self._gaze, gaze_reasons(frames)),
            (self._localization, localization),
        ):
            for time, state in zip(times, states, strict=True):
                lane.add(time, state)
