"""Fig. 3: the univector field, its parts, and the paths that follow it."""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, sin

from navigation import paper
from navigation.motion.univector import UnivectorField, normalized, shrunk_for_goal, unit_vectors
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
        circles: S_oe, d_e and d_b of the obstacle [m].
        arrows: unit vectors or zeros at the points of the grid (n, 2).
        paths: one from each start (m, steps, 2) [m].
        arrived: whether each path ends at the goal (m,).
        clearance: minimum distance of each path from the obstacle's surface for a robot (m,) [m].
    """

    name: str
    circles: tuple[float, float, float]
    arrows: Array
    paths: Array
    arrived: NDArray[np.bool_]
    clearance: Array

    @property
    def title(self) -> str:
        """The name, and how closely the paths pass if all lead to the goal."""
        if not self.arrived.all():
            return self.name
        least, touching = 100.0 * float(self.clearance.min()), int((self.clearance < 0.0).sum())
        if not touching:
            return f"{self.name}: all {len(self.paths)} paths at least {least:.0f} cm clear"
        return f"{self.name}: {touching} of {len(self.paths)} paths touch, by up to {-least:.0f} cm"


def grid() -> Array:
    """Points of the arrows (n, 2) [m]."""
    x, y = np.meshgrid(np.linspace(-1.6, 1.8, 28), np.linspace(-1.2, 1.2, 20))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def panels() -> list[FieldPanel]:
    """Move-to-goal alone, avoid-obstacle alone, their sum as printed, and the default blend."""
    printed, extended = NavigationParameters.paper(), NavigationParameters.extended()
    p, centres = printed.planner.paper, np.array([OBSTACLE])
    s_oe = RADIUS + printed.univector.s_robot + printed.univector.margin
    circles = (s_oe, p.d_e, p.d_b)
    discs = paper.Discs(centres, np.array([s_oe]), np.zeros(1), np.zeros(1, np.bool_))
    total = paper.PaperField(TARGET, GOAL_HEADING, discs, p)
    return [
        _panel(
            "move-to-goal, eq. (8)",
            circles,
            lambda x: unit_vectors(paper.move_to_goal(x, TARGET, GOAL_HEADING, p)),
        ),
        _panel(
            "avoid-obstacle, eq. (9)",
            circles,
            lambda x: paper.avoid_obstacle(x, TARGET, discs, p)[..., 0, :],
        ),
        _panel("printed sum, 0.75 and 0.25", circles, total.at),
        _default(extended, centres),
    ]


def _default(parameters: NavigationParameters, centres: Array) -> FieldPanel:
    """Blend by distance of the default planner."""
    u = parameters.univector
    distance = np.hypot(*(TARGET - centres).T)
    s_oe = np.array([RADIUS + u.s_robot + u.margin])
    radii, offsets = shrunk_for_goal(s_oe, np.array([RADIUS + u.s_robot]), distance, u)
    field = UnivectorField(centres, radii, offsets, TARGET, GOAL_HEADING, 0, u)
    circles = (float(radii[0]), float(offsets[0]), u.d_b)
    return _panel("blend by distance (default)", circles, field.at)


def _panel(
    name: str, circles: tuple[float, float, float], at: Callable[[Array], Array]
) -> FieldPanel:
    point, trace = STARTS.copy(), [STARTS.copy()]
    arrived = np.zeros(len(point), bool)
    for _ in range(round(5.0 / STEP)):
        point = point + STEP * normalized(at(point)) * ~arrived[:, None]
        arrived |= np.hypot(*(point - TARGET).T) < REACH
        trace.append(point.copy())
    paths = np.stack(trace, axis=1)
    reach = RADIUS + NavigationParameters().univector.s_robot
    gap = np.hypot(*(paths - np.array(OBSTACLE)).transpose(2, 0, 1)).min(axis=1) - reach
    return FieldPanel(name, circles, normalized(at(grid())), paths, arrived, gap)


def draw() -> Figure:
    """The figure."""
    with styled():
        made = figure(11.0, 7.6, "Fig. 3  Univector field, arrival heading π/6")
        points = grid()
        for axes, panel in zip(made.subplots(2, 2).ravel(), panels(), strict=True):
            axes.set_title(panel.title)
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
                for r, style in zip(np.cumsum(panel.circles), ("-", "--", ":"), strict=True):
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
