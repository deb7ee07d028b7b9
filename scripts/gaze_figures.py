"""Figs. 1 and 7: the sample points of the local map, and how the gaze is chosen."""

from dataclasses import dataclass
from math import cos, degrees, sin

from hsr8.show.walk_panels import INK
from hsr8.simulation.decisions import FrameRecord
from navigation.gaze.scene import GazeScene
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints
from navigation.scene import Scene
from navigation.transform import points_to_world

import numpy as np
from figure_style import (
    CONFIDENT,
    GOAL,
    MOVER,
    STILL,
    VIEW,
    covariance,
    disc,
    figure,
    robot,
    square,
    styled,
    window,
)  # fmt: skip
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray
from recorded_run import RecordedRun, run

Array = NDArray[np.float64]

SCENARIO = ("navigation.profile=paper", "robot.body=kinematic")
SEED, DURATION = 1, 24.0
JUMP = np.radians(25.0)  # minimum change of a gaze worth an image [rad]
DRIFT = 0.1  # maximum change of one gaze between frames, while the body turns [rad]


@dataclass(frozen=True)
class Look:
    """One decision of the gaze.

    Attributes:
        frame: frame in which it was taken.
        scene: its partial evaluations.
        after: the frame after the saccade.
        parameters: parameters of the decisions.
    """

    frame: FrameRecord
    scene: GazeScene
    after: FrameRecord
    parameters: NavigationParameters


def recorded() -> RecordedRun:
    """The beginning of the paper's experiment with its own gaze."""
    return run("paper", SCENARIO, SEED, DURATION)


def looks(ran: RecordedRun) -> list[Look]:
    """Every decision that moved the gaze far, best first: many obstacles, high evaluations."""
    p = ran.scenario.navigation
    samples = SamplePoints.polar(p.evaluation, p.gaze.max_pan)
    looks = []
    for k in range(1, len(ran.frames) - 6):
        before, frame = ran.frames[k - 1], ran.frames[k]
        moved = np.hypot(frame.gaze.pan - before.gaze.pan, frame.gaze.tilt - before.gaze.tilt)
        after = _settled(ran.frames[k : k + 10])
        if moved < JUMP or after is None or len(frame.belief.tracks) < 4:
            continue
        scene = Scene.of(frame.belief, frame.task, p, body=before.motion.velocity)
        gaze_scene = GazeScene.of(scene, frame.motion, samples, np.zeros((0, 2)), p)
        looks.append(Look(frame, gaze_scene, after, p))
    return sorted(
        looks, key=lambda x: -float(x.scene.psi_ob[x.scene.attended].sum()) - x.scene.map.psi
    )


def most_divided(looks: list[Look]) -> Look:
    """The decision with the most points of both kinds, confident and not."""

    def divided(look: Look) -> int:
        m = look.scene.map
        return min(int(m.under_confident.sum()), int((m.counted & ~m.under_confident).sum()))

    return max(looks, key=divided)


def _settled(frames: list[FrameRecord]) -> FrameRecord | None:
    """Return the first frame, from the third on, in which the head has reached the first gaze.

    Args:
        frames: successive frames, in which the gaze drifts while the body turns.
    """
    for k in range(1, len(frames)):
        if abs(frames[k].gaze.pan - frames[k - 1].gaze.pan) > DRIFT:
            return None
        if k >= 2 and _there(frames[k]):
            return frames[k]
    return None


def _there(frame: FrameRecord) -> bool:
    view = frame.belief.view
    return max(abs(view.pan - frame.gaze.pan), abs(view.tilt - frame.gaze.tilt)) < 0.05


def _window(frame: FrameRecord) -> Array:
    view = frame.belief.view
    fov = view.horizontal_fov, view.vertical_fov
    return window(view.pan, view.tilt, fov, float(view.position[2]))


def _confident(axes: Axes, frame: FrameRecord, threshold: float, **look: object) -> None:
    """Outline of the confident area in R."""
    x, y = np.meshgrid(np.linspace(-1.6, 2.2, 153), np.linspace(-2.1, 2.6, 189))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    c = frame.belief.local_map.confidence_at(points_to_world(frame.belief.pose, points))
    axes.contour(x, y, c.reshape(x.shape), [threshold], colors=CONFIDENT, **look)


def _points(axes: Axes, look: Look) -> None:
    scene = look.scene
    points, m = scene.samples.points, scene.map
    gazed = ~m.counted
    fine = m.counted & ~m.under_confident
    axes.plot(
        *points[gazed].T, ".", color=VIEW, markersize=3.5, label="in the gaze region, not counted"
    )
    axes.plot(
        *points[fine].T,
        "o",
        color=CONFIDENT,
        markersize=3.5,
        mfc="none",
        label=r"confident, $N_{cp}$",
    )
    axes.plot(
        *points[m.under_confident].T,
        "o",
        color=MOVER,
        markersize=3.2,
        label=r"under-confident, $N_{lp}$",
    )


def draw_map(look: Look) -> Figure:
    """Fig. 1."""
    with styled():
        made = figure(7.6, 5.6, "Fig. 1  Sample points of the local map")
        axes = made.subplots()
        axes.add_patch(
            Polygon(
                _window(look.frame),
                closed=True,
                facecolor=VIEW,
                alpha=0.25,
                label=r"gaze window $R_g$ on the floor",
            )
        )
        _confident(
            axes,
            look.frame,
            look.parameters.evaluation.lambda_cf,
            linestyles=[(0, (7, 3))],
            linewidths=1.4,
        )
        axes.plot([], [], color=CONFIDENT, linestyle=(0, (7, 3)), label=r"confident area $R_{cf}$")
        _points(axes, look)
        m = look.scene.map
        pan = float(look.scene.samples.bearing[m.under_confident].mean())
        axes.plot(
            [0.0, 1.5 * cos(pan)],
            [0.0, 1.5 * sin(pan)],
            color=INK,
            linewidth=1.1,
            label="candidate direction: mean bearing",
        )
        robot(axes, (0.0, 0.0, 0.0))
        n_lp, n_cp = int(m.under_confident.sum()), int((m.counted & ~m.under_confident).sum())
        square(axes, (-0.4, 1.75), (-1.5, 1.5), "R")
        axes.grid(False)
        axes.set_title(
            rf"$N_{{lp}}$ = {n_lp}, $N_{{cp}}$ = {n_cp}, $\psi_{{lm}}$ = {m.psi:.2f}; "
            f"t = {look.frame.time:.1f} s"
        )
        axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    return made


def draw_choice(look: Look) -> Figure:
    """Fig. 7."""
    with styled():
        made = figure(11.0, 7.4, "Fig. 7  Choice of the gaze")
        grid = made.add_gridspec(2, 2, width_ratios=(1.0, 1.05), height_ratios=(1.15, 1.0))
        left = made.add_subplot(grid[:, 0])
        _draw_scene(left, look)
        made.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=7)
        _draw_gaze_map(made, made.add_subplot(grid[0, 1]), look)
        axes = made.add_subplot(grid[1, 1])
        if look.after.image is not None:
            axes.imshow(look.after.image)
        view = look.after.belief.view
        axes.set_title(
            f"(c) image after it, pan {degrees(view.pan):.0f}°, tilt {degrees(view.tilt):.0f}°"
        )
        axes.set(xticks=[], yticks=[])
        axes.grid(False)
        for spine in axes.spines.values():
            spine.set_visible(False)
    return made


def _draw_scene(axes: Axes, look: Look) -> None:
    frame, scene = look.frame, look.scene
    pose = frame.belief.pose
    axes.add_patch(
        Polygon(_window(frame), closed=True, facecolor=VIEW, alpha=0.25, label="gaze window now")
    )
    axes.add_patch(
        Polygon(
            _window(look.after),
            closed=True,
            fill=False,
            edgecolor=INK,
            linewidth=1.0,
            label="gaze window chosen",
        )
    )
    _confident(axes, frame, look.parameters.evaluation.lambda_cf, linewidths=1.2)
    axes.plot([], [], color=CONFIDENT, label="confident area")
    axes.plot(*scene.samples.points.T, ".", color=MOVER, markersize=2.0, label="sample points")
    c, s = cos(pose[2]), sin(pose[2])
    turn = np.array([[c, s], [-s, c]])
    s_oe = scene.scene.s_oe
    for k, track in enumerate(frame.belief.tracks):
        at = turn @ (track.position - pose[:2])
        color = INK if scene.attended[k] else "#AAAAAA"
        disc(axes, at, track.radius, facecolor=STILL, edgecolor="none", alpha=0.8)
        disc(axes, at, float(s_oe[k]), fill=False, edgecolor=color, linewidth=1.1)
        disc(axes, at, float(s_oe[k]) - 0.025, fill=False, edgecolor=color, linewidth=0.6)
        covariance(
            axes, at, turn @ track.covariance[:2, :2] @ turn.T, 3.0, color="#D00000", linewidth=1.0
        )
        if scene.attended[k]:
            axes.annotate(f"{scene.psi_ob[k]:.2f}", at, xytext=(0, 9), textcoords="offset points",
                          ha="center", fontsize=7, clip_on=True)  # fmt: skip
    axes.plot([], [], color="#D00000", label="3σ of a track")
    axes.plot([], [], color=INK, label=r"extended shape, in $O$; its $\psi_{ob}$")
    axes.plot([], [], color="#AAAAAA", label="extended shape, not in $O$")
    robot(axes, (0.0, 0.0, 0.0))
    g = frame.gaze
    square(axes, (-1.5, 2.1), (-2.0, 2.5), "R")
    axes.set_title(
        rf"(a) t = {frame.time:.1f} s: $\psi_{{lm}}$ {g.psi_lm:.2f}, $\psi_{{sf}}$ {g.psi_sf:.2f}, "
        rf"$\psi_{{ob}}$ up to {g.psi_ob:.2f}, $\psi_{{way}}$ {g.psi_way:.2f}"
    )
    axes.grid(False)


def _draw_gaze_map(made: Figure, axes: Axes, look: Look) -> None:
    p, gm = look.parameters.gaze, look.frame.gaze.gaze_map
    step = degrees(p.step)
    pan = degrees(p.max_pan) + 0.5 * step
    low, high = degrees(p.min_tilt) - 0.5 * step, degrees(p.max_tilt) + 0.5 * step
    # Pan grows to the left, as in the image.
    shown = axes.imshow(
        gm[:, ::-1],
        origin="lower",
        extent=(pan, -pan, low, high),
        cmap="viridis",
        vmin=0.0,
        aspect="auto",
    )
    made.colorbar(shown, ax=axes, label="GM [1]", pad=0.02)
    g, view = look.frame.gaze, look.frame.belief.view
    axes.plot(
        degrees(view.pan),
        degrees(view.tilt),
        "o",
        color="white",
        mfc="none",
        markersize=8,
        label="gaze now",
    )
    axes.plot(
        degrees(g.pan),
        degrees(g.tilt),
        "*",
        color=GOAL,
        mec="white",
        mew=0.6,
        markersize=13,
        label="θ*, highest centre",
    )
    axes.set(xlabel="pan [deg]", ylabel="tilt [deg]")
    axes.set_title("(b) gaze angle integration map GM")
    axes.grid(False)
    axes.legend(loc="lower left", labelcolor="white")
