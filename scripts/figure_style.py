"""Style of the figures and images, and the marks that several of them share."""

from collections.abc import Sequence
from math import cos, pi, sin, tan
from typing import Any

from hsr8.show.walk_figure import STYLE as WALK_STYLE
from hsr8.show.walk_panels import BLUE, GREEN, ORANGE, PURPLE, VERMILION
from navigation.transform import points_to_world

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from numpy.typing import NDArray

Array = NDArray[np.float64]

STYLE: dict[Any, Any] = {**WALK_STYLE, "axes.titlesize": 9.0, "axes.labelsize": 8.5}
STYLE |= {"xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "axes.titlelocation": "left"}
ROBOT, MOVER, STILL, GOAL, VIEW = BLUE, VERMILION, "#8A8A8A", ORANGE, "#E8B93C"
VIRTUAL, CONFIDENT = PURPLE, GREEN
FAR = 1.6  # drawn length of the gaze window where it reaches the horizon [m]
ARROW = np.array([[0.16, 0.0], [-0.10, 0.09], [-0.05, 0.0], [-0.10, -0.09]])  # outline in R [m]


def figure(width: float, height: float, title: str) -> Figure:
    """Return an empty figure with a title; draw into it within `styled`.

    Args:
        width: width [inch].
        height: height [inch].
        title: title at the top left.
    """
    made = Figure(figsize=(width, height), layout="constrained")
    made.suptitle(title, fontsize=11, x=0.01, ha="left", weight="bold")
    return made


def styled() -> Any:
    """Return a context with the style of all figures."""
    return rc_context(STYLE)


def disc(axes: Axes, at: Sequence[float], radius: float, **look: Any) -> None:
    """Draw a circle of a radius in the unit of the axes."""
    axes.add_patch(Circle((float(at[0]), float(at[1])), radius, **look))


def robot(axes: Axes, pose: Sequence[float], scale: float = 1.0, **look: Any) -> None:
    """Draw the robot as an arrow head at `pose` (3,) [m, m, rad], `scale` times as large."""
    look = {"facecolor": ROBOT, "edgecolor": "white", "linewidth": 0.4, "zorder": 6} | look
    axes.add_patch(Polygon(points_to_world(pose, scale * ARROW), closed=True, **look))


def window(pan: float, tilt: float, fov: tuple[float, float], height: float) -> Array:
    """Return the outline of the gaze window on the floor in R (n, 2) [m], cut off at `FAR`.

    Its points are the intersections of the rays of the image's border with the floor.

    Args:
        pan: pan of the camera, left positive [rad].
        tilt: tilt of the camera, up positive [rad].
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
    """Set equal scales, limits [m] and labels, with the name of the frame if there is one."""
    axes.set_aspect("equal")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    suffix = f" of {frame}" if frame else ""
    axes.set_xlabel(f"x{suffix} [m]")
    axes.set_ylabel(f"y{suffix} [m]")


def covariance(axes: Axes, at: Sequence[float], matrix: Array, sigmas: float, **look: Any) -> None:
    """Draw the ellipse of `sigmas` standard deviations of a covariance (2, 2) [m²]."""
    value, vector = np.linalg.eigh(matrix)
    turn = np.linspace(0.0, 2.0 * pi, 60)
    half = sigmas * np.sqrt(np.maximum(value, 0.0))
    points = np.stack([half[0] * np.cos(turn), half[1] * np.sin(turn)], axis=1) @ vector.T
    axes.plot(at[0] + points[:, 0], at[1] + points[:, 1], **look)
