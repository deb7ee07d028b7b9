"""Curves and state lanes of decisions and belief."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.derived import ellipse_axes
from hsr8.recording.table import Table
from hsr8.show.evaluations import EVALUATIONS
from hsr8.show.log.stream import LogStream
from navigation.angles import wrap

Array = NDArray[np.float64]
Curves = Sequence[tuple[str, palette.Color]]  # name and colour of each

BLUE, ORANGE, GREEN, GREY = (52, 112, 206), (240, 140, 20), (76, 168, 78), (130, 130, 134)
RED, VIOLET, SAND = (206, 60, 56), (146, 84, 196), (196, 178, 130)
SITUATIONS = {
    "free": GREEN,
    "veto": SAND,
    "accelerate": BLUE,
    "brake": ORANGE,
    "escape": RED,
    "path_change": VIOLET,
}
REASONS = dict(zip(EVALUATIONS, (GREY, BLUE, ORANGE, GREEN), strict=True))
GAZE = {name.partition(" ")[0]: color for name, color in REASONS.items()}
GAZE |= {"search": RED, "none": SAND}
LOCALIZATION = {"localized": GREEN, "lost": RED}
LANES = {"planner": SITUATIONS, "gaze": GAZE, "localization": LOCALIZATION}
PLOTS = {
    "clearance": (("clearance [m]", BLUE),),
    "clearance/believed": (("nearest believed obstacle, from the robot axis [m]", ORANGE),),
    "partial": tuple(REASONS.items()),
    "pose_error": (("position error [m]", BLUE), ("2σ [m]", GREY), ("heading error [rad]", ORANGE)),
}


def style_plots(
    log: LogStream, plots: Mapping[str, Curves], lanes: Mapping[str, dict[str, palette.Color]]
) -> None:
    """Set names and colours of the curves in each plot, and of the states in each lane."""
    for name, curves in plots.items():
        names, colors = zip(*curves, strict=True)
        log.log(f"/plots/{name}", rr.SeriesLines(names=names, colors=colors), static=True)
    for name, states in lanes.items():
        style = rr.StateConfiguration(values=list(states), colors=list(states.values()))
        log.log(f"/state/{name}", style, static=True)


def log_clearance(log: LogStream, records: Table) -> None:
    """Log the clearance at the rate of the plots."""
    clearance = records["clearance"][:, None]
    shown = np.where(np.isfinite(clearance), clearance, np.nan)
    log.curves("/plots/clearance", records["time"], shown)


def log_decisions(log: LogStream, frames: Table, truth: Array) -> None:
    """Log camera frames, each with the true pose of that time (n, 3) [m, m, rad]."""
    times = frames["time"]
    log.curves("/plots/partial", times, frames["psi"])
    if "nearest_track" in frames:  # runs of earlier versions have none
        nearest = frames["nearest_track"][:, None]
        shown = np.where(np.isfinite(nearest), nearest, np.nan)
        log.curves("/plots/clearance/believed", times, shown)
    dx, dy, turn = (frames["pose"] - truth).T
    spread = 2.0 * ellipse_axes(frames["pose_covariance"][:, :2, :2])[0][:, 0]
    turned = [abs(wrap(angle)) for angle in turn.tolist()]
    errors = np.column_stack([np.hypot(dx, dy), spread, turned])
    log.curves("/plots/pose_error", times, errors)
    log.lane("/state/planner", times, frames["situation"].tolist())
    log.lane("/state/gaze", times, gaze_reasons(frames))
    localization = ["lost" if lost else "localized" for lost in frames["lost"].tolist()]
    log.lane("/state/localization", times, localization)


def gaze_reasons(frames: Table) -> list[str]:
    """Return the reason of the gaze of each frame: its maximum partial evaluation."""
    psi, lost, names = frames["psi"], frames["lost"], tuple(GAZE)
    best, any_ = psi.argmax(axis=1).tolist(), psi.max(axis=1) > 0.0
    return [
        "search" if is_lost else names[k] if positive else "none"
        for k, positive, is_lost in zip(best, any_.tolist(), lost.tolist(), strict=True)
    ]
