"""Panel of a walk from above, with the world around it."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from hsr8.recording.derived import Walk, pushes_of
from hsr8.show.walk_panels import CURVES, FEET, ORANGE, PUSH, contacts, outline, to_local
from hsr8.world.field.layout import Layout

ARROW = 0.08  # drawn length of a push [m]
STATIC, MOVER = "#CCCCCC", "#777777"
JUMP = 1.0  # distance between two records of a mover that appears or disappears [m]
NAME = 5, -9  # offset of the name of a via point [point]


def footsteps(axes: Axes, walk: Walk, layout: Layout) -> None:
    """Draw footsteps, the paths of ZMP and CoM, obstacles and via points from above.

    Args:
        axes: axes to draw into.
        walk: walking of the run.
        layout: layout of the run's world.
    """
    origin, yaw = walk.pose[0, :2], float(walk.pose[0, 2])
    for foot, color in enumerate(FEET):
        intervals = contacts(walk, foot)
        soles = [to_local(outline(walk, foot, rows), origin, yaw) for rows in intervals]
        axes.add_collection(PolyCollection(soles, fc=color, alpha=0.25, lw=0))
        axes.add_collection(PolyCollection(soles, fc="none", ec=color, lw=0.7))
    for name, label, color, width, dash in CURVES:
        if name in ("zmp", "cop", "com"):
            x, y = to_local(getattr(walk, name), origin, yaw).T
            axes.plot(x, y, color=color, lw=width, ls=dash, label=label)
    for push in pushes_of(walk.records):
        at = to_local(push.point[None, :2], origin, yaw)[0]
        arrow = to_local(push.force[None, :2], np.zeros(2), yaw)[0]
        arrow *= ARROW / np.hypot(*arrow)
        axes.update_datalim([at - arrow])
        axes.annotate(
            "",
            at,
            at - arrow,
            arrowprops={"arrowstyle": "-|>", "color": PUSH, "lw": 1.4, "shrinkA": 0, "shrinkB": 0},
        )
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    _draw_world(axes, walk, layout)
    axes.set_xlabel("forward [m]")
    axes.set_ylabel("left [m]")


def _draw_world(axes: Axes, walk: Walk, layout: Layout) -> None:
    """Draw obstacles and via points, clipped to the axes; artists do not change the limits."""
    origin, yaw = walk.pose[0, :2], float(walk.pose[0, 2])
    labels = {False: "obstacle", True: "mover, at the end"}
    for k, obstacle in enumerate(layout.obstacles):
        moves = obstacle.motion is not None
        path = to_local(walk.records["obstacle_positions"][:, k], origin, yaw)
        fill, label = "none" if moves else STATIC, labels.pop(moves, None)  # once in the legend
        at = path[-1].tolist()
        axes.add_artist(Circle(at, obstacle.radius, fc=fill, ec=MOVER, zorder=1.5, label=label))
        if moves:
            path[:-1][np.hypot(*np.diff(path, axis=0).T) > JUMP] = np.nan
            axes.add_artist(Line2D(*path.T, color=MOVER, lw=0.8, ls=":", zorder=1.5))
    points = to_local(np.reshape(layout.waypoints, (-1, 2)), origin, yaw).tolist()
    for k, point in enumerate(points, start=1):
        goal = k == len(points) and not layout.endless
        label = "via point" if k == 1 and not goal else None
        mark = Line2D(*zip(point), color=ORANGE, marker="o", ls="", ms=5, label=label)
        axes.add_artist(mark)
        axes.annotate(
            "goal" if goal else str(k),
            point,
            NAME,
            textcoords="offset points",
            color=ORANGE,
            annotation_clip=True,
        )
