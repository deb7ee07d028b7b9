"""Fig. 3: the univector field, its parts, and the paths that follow it."""

from dataclasses import dataclass
from math import cos, pi, sin

from navigation.belief.belief import Motion, Track
from navigation.belief.tracks import Tracks
from navigation.motion.avoid_obstacle import avoid_obstacle
from navigation.motion.motion_field import FieldScene, MotionField
from navigation.motion.move_to_goal import move_to_goal, muf
from navigation.motion.univector import extended_radius, normalized, physical_radius
from navigation.parameters.navigation import NavigationParameters

import numpy as np
from figure_style import GOAL, MOVER, ROBOT, STILL, disc, figure, square, styled
from matplotlib.figure import Figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

GOAL_HEADING = pi / 6  # printed in the caption of Fig. 3
TARGET = np.array([1.2, 0.0])
OBSTACLE, RADIUS = (0.0, 0.05), 0.10  # [m]
STARTS = np.array([(-1.6, y) for y in np.linspace(-1.2, 1.2, 13)])
REACH = 0.05  # distance from the goal at which a path ends [m]
STEP = 0.01  # of a path [m]


@dataclass(frozen=True)
class FieldPanel:
    """One field.

    Attributes:
        name: title of the panel.
        parameters: parameters that make it.
        arrows: unit vectors or zeros at the points of the grid (n, 2).
        paths: one from each start (m, steps, 2) [m].
        arrived: whether each path ends at the goal (m,).
        clearance: minimum distance of each path from the obstacle's surface for a robot (m,) [m].
    """

    name: str
    parameters: NavigationParameters
    arrows: Array
    paths: Array
    arrived: NDArray[np.bool_]
    clearance: Array


def obstacle() -> Tracks:
    """The obstacle of the figure."""
    still = Track(
        id=0,
        label="red",
        position=np.array(OBSTACLE),
        velocity=np.zeros(2),
        covariance=np.eye(4) * 1e-8,
        radius=RADIUS,
        radius_sigma=0.0,
        motion=Motion.STATIC,
        hits=99,
        age=0.0,
        last_seen=np.array(OBSTACLE),
        visible=True,
    )
    return Tracks.of([still])


def grid() -> Array:
    """Points of the arrows (n, 2) [m]."""
    x, y = np.meshgrid(np.linspace(-1.6, 1.8, 28), np.linspace(-1.2, 1.2, 20))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def panels() -> list[FieldPanel]:
    """Move-to-goal alone, avoid-obstacle alone, their sum as printed, and the default blend."""
    paper, extended = NavigationParameters.paper(), NavigationParameters.extended()
    made = []
    for name, p in (
        ("printed sum, 0.75 and 0.25", paper),
        ("blend by distance (default)", extended),
    ):
        u, obstacles = p.univector, obstacle()
        s_oe = extended_radius(obstacles, 0.0, np.zeros(1), u)
        scene = FieldScene(obstacles, s_oe, np.zeros(1), TARGET, GOAL_HEADING)
        field = MotionField(u, p.moving_obstacles)
        if p is paper:
            made.append(
                _panel(
                    "move-to-goal, eq. (8)",
                    p,
                    lambda x: muf(
                        x, TARGET, move_to_goal(x, 0.0, TARGET, GOAL_HEADING, paper.univector)
                    ),
                )
            )
            made.append(_panel("avoid-obstacle, eq. (9)", p, lambda x, s=s_oe: avoid_obstacle(
                x, TARGET, np.array([OBSTACLE]), s, paper.univector,
            )[..., 0, :]))  # fmt: skip
        made.append(_panel(name, p, lambda x, f=field, s=scene: f.at(x, 0.0, s, ())))
    return made


def _panel(name, parameters, at) -> FieldPanel:
    point, trace = STARTS.copy(), [STARTS.copy()]
    arrived = np.zeros(len(point), bool)
    for _ in range(round(5.0 / STEP)):
        point = point + STEP * normalized(at(point)) * ~arrived[:, None]
        arrived |= np.hypot(*(point - TARGET).T) < REACH
        trace.append(point.copy())
    paths = np.stack(trace, axis=1)
    reach = physical_radius(obstacle(), parameters.univector)[0]
    gap = np.hypot(*(paths - np.array(OBSTACLE)).transpose(2, 0, 1)).min(axis=1) - reach
    return FieldPanel(name, parameters, normalized(at(grid())), paths, arrived, gap)


def draw() -> Figure:
    """The figure."""
    with styled():
        made = figure(11.0, 7.6, "Fig. 3  Univector field, arrival heading π/6")
        points = grid()
        for axes, panel in zip(made.subplots(2, 2).ravel(), panels(), strict=True):
            p = panel.parameters.univector
            axes.set_title(panel.name)
            u = panel.arrows
            acts = np.abs(u).sum(axis=1) > 0.0
            axes.quiver(
                *points[acts].T, *u[acts].T, color="#9AA4AE", scale=42, width=0.0019, pivot="mid"
            )
            if "avoid" not in panel.name:
                for path, arrived in zip(panel.paths, panel.arrived, strict=True):
                    axes.plot(*path.T, color=ROBOT if arrived else MOVER, linewidth=1.0)
                axes.plot(*STARTS.T, "o", color=ROBOT, markersize=2.5)
            disc(axes, OBSTACLE, RADIUS, facecolor=STILL, edgecolor="none")
            if "move" not in panel.name:
                s_oe = RADIUS + p.s_robot + p.margin
                for r, style in ((s_oe, "-"), (s_oe + p.d_e, "--"), (s_oe + p.d_e + p.d_b, ":")):
                    disc(
                        axes,
                        OBSTACLE,
                        r,
                        fill=False,
                        edgecolor=MOVER,
                        linewidth=0.8,
                        linestyle=style,
                    )
            axes.annotate(
                "", TARGET + 0.3 * np.array([cos(GOAL_HEADING), sin(GOAL_HEADING)]), TARGET,
                arrowprops={"arrowstyle": "-|>", "color": GOAL, "linewidth": 1.8},
            )  # fmt: skip
            axes.plot(*TARGET, "o", color=GOAL, markersize=5)
            square(axes, (-1.7, 1.9), (-1.25, 1.25))
            axes.grid(False)
        made.supxlabel(
            "circles: S_oe (solid), S_oe + d_e (dashed), S_oe + d_e + d_b (dotted); "
            "grey: the obstacle; blue: paths from equally spaced starts; orange: goal",
            fontsize=8,
        )
    return made
