"""Figures of the walking of a run, for print."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Patch

from hsr8.errors import UsageError
from hsr8.files.atomic import draft
from hsr8.recording.derived import Walk, walk_of
from hsr8.recording.table import Table
from hsr8.show import walk_panels as panels
from hsr8.show.walk_map import footsteps
from hsr8.world.field.layout import Layout
from walking.body.robot_model import RobotModel

What = Literal["walking", "zmp", "footsteps", "velocity", "torques", "tilt"]
WIDTH = 11.0  # of a figure [inch]
STYLE: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E6E6E6",
    "grid.linewidth": 0.6,
    "axes.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "figure.dpi": 100,
    "savefig.dpi": 150,
    "svg.hashsalt": "hsr8",
}
Draw = Callable[[Axes, Walk], None]


@dataclass(frozen=True)
class Panel:
    """One pair of axes over time.

    Attributes:
        height: [inch].
        draw: draws it.
        legend: whether its curves are named next to it.
        patches: further entries of the legend.
    """

    height: float
    draw: Draw
    legend: bool = True
    patches: Callable[[], list[Patch]] = list


TIME_PANELS: dict[str, tuple[Panel, ...]] = {
    "zmp": (
        Panel(2.0, partial(panels.along, axis=0), patches=panels.sole_legend),
        Panel(2.0, partial(panels.along, axis=1), legend=False),
    ),
    "velocity": tuple(
        Panel(0.9, partial(panels.velocity, component=k), legend=k == 0) for k in range(3)
    ),
    "torques": tuple(Panel(1.1, partial(panels.torque, group=group)) for group in panels.GROUPS),
    "tilt": (Panel(0.9, panels.tilt),),
}
MIN_RECORDS = 4  # of a plot
MIN_HEIGHT, MAX_HEIGHT = 1.5, 4.5  # of the view from above [inch]
AXES_WIDTH = 0.8  # of the axes, a fraction of the figure [1]


def draw(records: Table, robot: RobotModel, layout: Layout, what: What, title: str) -> Figure:
    """Draw a figure.

    Args:
        records: the rows to draw.
        robot: model of the robot.
        layout: layout of the run's world.
        what: one group of panels, or all of them.
        title: title of the figure.

    Raises:
        UsageError: too few rows.
    """
    if len(records) < MIN_RECORDS:
        raise UsageError(f"nothing to plot: only {len(records)} records in that time")
    groups = tuple(TIME_PANELS) if what == "walking" else (what,)
    rows = [panel for group in groups for panel in TIME_PANELS.get(group, ())]
    walk = walk_of(records, robot)
    above = _footsteps_height(walk) if what in ("walking", "footsteps") else 0.0
    heights = [panel.height for panel in rows]
    if rows:
        heights.append(0.16 * (1 + len(panels.active_limits(walk))) + 0.12)
    with rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, above + sum(heights) + 0.9), layout="constrained")
        FigureCanvasAgg(figure)
        figure.suptitle(title, fontsize=11, x=0.01, ha="left", weight="bold")
        parts: list[FigureBase] = [figure, figure]
        if above and rows:
            ratios = [above, sum(heights)]
            parts = figure.subfigures(2, 1, height_ratios=ratios, squeeze=False)[:, 0].tolist()
        if above:
            axes = parts[0].subplots()
            footsteps(axes, walk, layout)
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        if rows:
            column = parts[1].subplots(
                len(heights), 1, sharex=True, squeeze=False, height_ratios=heights
            )
            _draw_over_time(column[:, 0].tolist(), rows, walk)
    return figure


def save(figure: Figure, out: Path) -> None:
    """Write a figure; the suffix of `out` selects the format.

    Raises:
        OSError: it cannot be written.
    """
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with rc_context(STYLE), draft(out) as file:
        figure.savefig(file, metadata=undated.get(out.suffix.lower()))


def _draw_over_time(axes: list[Axes], rows: list[Panel], walk: Walk) -> None:
    for one, panel in zip(axes, rows, strict=False):
        panel.draw(one, walk)
        if panel.legend:
            handles = [*one.get_legend_handles_labels()[0], *panel.patches()]
            one.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5))
    panels.lanes(axes[-1], walk)
    axes[-1].legend(handles=panels.lane_legend(walk), loc="upper left", bbox_to_anchor=(1.0, 1.15))
    panels.mark_pushes(axes, walk)
    axes[-1].set_xlim(float(walk.time[0]), float(walk.time[-1]))
    axes[-1].set_xlabel("time [s]")


def _footsteps_height(walk: Walk) -> float:
    """Return the height of the view from above at equal scales [inch]."""
    path = panels.to_local(walk.pose[:, :2], walk.pose[0, :2], float(walk.pose[0, 2]))
    extent = np.ptp(path, axis=0) + 0.25
    return float(np.clip(AXES_WIDTH * WIDTH * extent[1] / extent[0], MIN_HEIGHT, MAX_HEIGHT))
