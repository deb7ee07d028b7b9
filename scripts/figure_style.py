"""How the paper's figures look, and what several of them draw."""

from collections.abc import Sequence
from math import cos, pi, sin, tan
from typing import Any

from hsr8.show.walk_figure import STYLE as WALK_STYLE
from hsr8.show.walk_panels import BLUE, GREEN, ORANGE, PURPLE, VERMILION

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from numpy.typing import NDArray

Array = NDArray[np.float64]

STYLE: dict[Any, Any] = {**WALK_STYLE, "axes.titlesize": 9.0, "axes.labelsize": 8.5}
STYLE |= {"xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "axes.titlelocation": "left"}
ROBOT, MOVER, STILL, GOAL, VIEW = BLUE, VERMILION, "#8A8A8A", ORANGE, "#E8B93C"
VIRTUAL, CONFIDENT = PURPLE, GREEN
FAR = 1.6  # drawn length of the gaze window where it reaches the horizon [m]
ARROW = np.array([[0.16, 0.0], [-0.10, 0.09], [-0.05, 0.0], [-0.10, -0.09]])  # the robot [m]


def figure(width: float, height: float, title: str) -> Figure:
    """An empty figure; draw into it within `rc_context(STYLE)`."""
    made = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(made)
    made.suptitle(title, fontsize=11, x=0.01, ha="left", weight="bold")
    return made


def styled() -> Any:
    """The style of all figures, as a context."""
    return rc_context(STYLE)


def disc(axes: Axes, at: Sequence[float], radius: float, **look: Any) -> None:
    """A circle in the scale of the axes."""
    axes.add_patch(Circle((float(at[0]), float(at[1])), radius, **look))


def placed(points: Array, pose: Sequence[float]) -> Array:
    """Points of R (n, 2) where `pose` puts them [m]."""
    x, y, yaw = pose
    c, s = cos(yaw), sin(yaw)
    return np.array([x, y]) + points @ np.array([[c, s], [-s, c]])


def robot(axes: Axes, pose: Sequence[float], scale: float = 1.0, **look: Any) -> None:
    """The robot as an arrow head of so many times its size."""
    look = {"facecolor": ROBOT, "edgecolor": "white", "linewidth": 0.4, "zorder": 6} | look
    axes.add_patch(Polygon(placed(scale * ARROW, pose), closed=True, **look))


def window(pan: float, tilt: float, fov: tuple[float, float], height: float) -> Array:
    """Gaze window on the floor in R (n, 2) [m], cut off at `FAR`.

    The image's border is followed and each of its rays is met with the floor.

    Args:
        pan: left positive [rad].
        tilt: up positive [rad].
        fov: horizontal and vertical field of view [rad].
        height: height of the camera [m].
    """
    h, v = tan(0.5 * fov[0]), tan(0.5 * fov[1])
    side = np.linspace(-1.0, 1.0, 25)
    one = np.ones_like(side)
    u = h * np.concatenate([side, one, -side, -one])
    w = v * np.concatenate([one, -side, -one, side])
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward = np.array([cp * ct, sp * ct, st])
    left, up = np.array([-sp, cp, 0.0]), np.array([-cp * st, -sp * st, ct])
    rays = forward + u[:, None] * left + w[:, None] * up
    length = np.hypot(rays[:, 0], rays[:, 1])
    down = np.maximum(-rays[:, 2], 1e-6)
    away = np.minimum(height * length / down, FAR)
    points: Array = away[:, None] * rays[:, :2] / length[:, None]
    return points


def square(axes: Axes, x: tuple[float, float], y: tuple[float, float], frame: str = "") -> None:
    """Equal scales, limits and labels with units."""
    axes.set_aspect("equal")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    suffix = f" of {frame}" if frame else ""
    axes.set_xlabel(f"x{suffix} [m]")
    axes.set_ylabel(f"y{suffix} [m]")


def covariance(axes: Axes, at: Sequence[float], matrix: Array, sigmas: float, **look: Any) -> None:
    """An ellipse of so many standard deviations."""
    value, vector = np.linalg.eigh(matrix)
    turn = np.linspace(0.0, 2.0 * pi, 60)
    half = sigmas * np.sqrt(np.maximum(value, 0.0))
    points = np.stack([half[0] * np.cos(turn), half[1] * np.sin(turn)], axis=1) @ vector.T
    axes.plot(at[0] + points[:, 0], at[1] + points[:, 1], **look)
