"""Fig. 4: the three ways to meet a mover, as the robot judged them and as it walked."""

from dataclasses import dataclass
from math import atan2, cos, hypot, inf, isfinite, sin

from hsr8.show.walk_panels import INK
from hsr8.simulation.decisions import FrameRecord
from navigation.motion.collision_band import Encounter, free_intervals

import numpy as np
from figure_style import (
    GOAL,
    MOVER,
    ROBOT,
    STILL,
    VIRTUAL,
    disc,
    figure,
    robot,
    square,
    styled,
)
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon, Rectangle
from numpy.typing import NDArray
from recorded_run import RecordedRun, run
from study import STAND_INS

Array = NDArray[np.float64]

PAPER = "navigation.profile=paper"
WITHOUT = ("navigation.planner.paper.min_speed=1.0",)  # no obstacle is a mover
CASES = {
    "a": ("fig4a", "(a) outside the band: another speed", {"brake", "accelerate"}, 27.0),
    "b": ("fig4b", "(b) inside the band: escape", {"escape"}, 24.0),
    "c": ("fig4c", "(c) definite collision: another path", {"path_change"}, 26.0),
}
DRAWN = {
    "c": (
        "navigation.planner.paper.d_e=0.15",
        "navigation.planner.paper.d_b=0.30",
        "navigation.planner.paper.k_r=0.30",
        "navigation.planner.paper.omega_dist=12",
        "navigation.univector.eta_vo=0.5",
    )
}
"""Wide bands and a long virtual path, as the paper draws (c); those of the profile are short."""
LARGE = 0.10  # radius of a virtual obstacle worth an image [m]
STAMP = 4.0  # between two drawn positions [s]


@dataclass(frozen=True)
class Case:
    """One column of the figure.

    Attributes:
        letter: letter of the case.
        title: title of the column.
        frame: the decision shown on top.
        direction: direction of the line of motion in W [rad].
        encounter: mover and robot in axes of that line.
        ran: the run with the scheme, and without.
    """

    letter: str
    title: str
    frame: FrameRecord
    direction: float
    encounter: Encounter
    ran: tuple[RecordedRun, RecordedRun]


def case(letter: str) -> Case:
    """Run one case with and without the scheme and find the decision to show."""
    name, title, situations, duration = CASES[letter]
    settings = (PAPER, *STAND_INS, *DRAWN.get(letter, ()))
    ran = (
        run(name, settings, 0, duration),
        run(name, (*settings, *WITHOUT), 0, duration),
    )
    v_max = ran[0].scenario.robot.speed.vx
    horizon = ran[0].scenario.navigation.planner.paper.horizon
    for frame in ran[0].frames:
        if frame.motion.situation not in situations or not frame.motion.extended_radii:
            continue
        direction, encounter = _encounter(frame, straight=letter == "c")
        if encounter.case(v_max, horizon) == letter and _telling(letter, frame, encounter):
            return Case(letter, title, frame, direction, encounter, ran)
    raise RuntimeError(f"scenario {name} never came to case ({letter})")


def _telling(letter: str, frame: FrameRecord, encounter: Encounter) -> bool:
    """Whether the decision has taken full effect: a permanently free speed, a large oval."""
    if letter == "c":
        return any(v.radius > LARGE for v in frame.motion.virtual_obstacles)
    return not encounter.collides(frame.motion.speed, inf)


def _encounter(frame: FrameRecord, *, straight: bool) -> tuple[float, Encounter]:
    """The mover as believed, in axes of the motion, or of the straight line to the destination."""
    pose, task = frame.belief.pose, frame.task
    dx, dy = (task.target - pose[:2]).tolist()
    direction = atan2(dy, dx) if straight else frame.motion.direction
    radii = dict(frame.motion.extended_radii)
    track = next(t for t in frame.belief.tracks if t.id in radii)
    offset = track.position - pose[:2]
    return direction, Encounter.on_line(direction, offset, track.velocity, radii[track.id])


def clearance(ran: RecordedRun) -> Array:
    """Distance between the surfaces of mover and robot, a disc, at every record (n,) [m]."""
    radius = ran.scenario.world.mover[0].radius + ran.scenario.navigation.univector.s_robot
    places, movers = np.array(ran.robot)[:, :2], np.array(ran.movers)[:, 0]
    return np.hypot(*(places - movers).T) - radius


def _diagram(axes: Axes, shown: Case) -> None:
    e = shown.encounter
    speed = hypot(e.forward, e.left)
    ux, uy = e.forward / speed, e.left / speed
    side, far = np.array([-uy, ux]) * e.radius, np.array([ux, uy]) * 3.0
    at = np.array([e.along, e.across])
    band = np.array([at + side, at + side + far, at - side + far, at - side])
    axes.add_patch(Polygon(band, closed=True, facecolor=MOVER, alpha=0.10, edgecolor="none"))
    axes.axhline(0.0, color=INK, linewidth=0.7)
    disc(axes, at, e.radius, fill=False, edgecolor=MOVER, linewidth=2.0)
    axes.annotate("", at + 2.0 * np.array([e.forward, e.left]), at,
                  arrowprops={"arrowstyle": "-|>", "color": MOVER})  # fmt: skip
    robot(axes, (0.0, 0.0, 0.0))
    touched = [(v, e.touch_time(v)) for v in e.crossing_speeds()]
    for k, (v, time) in enumerate(touched, 1):
        if isfinite(time) and v > 0.0:
            disc(axes, at + time * np.array([e.forward, e.left]), e.radius, fill=False,
                 edgecolor=MOVER, linewidth=0.8)  # fmt: skip
            axes.plot(v * time, 0.0, "o", color=INK, markersize=3.5)
            axes.annotate(
                f"$p_{{oc,{k}}}$: {v:.2f} m/s, {time:.1f} s", (v * time, 0.0),
                xytext=(-0.5, -0.42 - 0.17 * k),
                fontsize=7.5, arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.5},
            )  # fmt: skip
    if shown.letter == "c":
        _virtual(axes, shown)
    square(axes, (-0.55, 2.35), (-0.85, 1.35), "the line of motion")
    axes.grid(False)
    axes.set_title(shown.title, weight="bold")


def _virtual(axes: Axes, shown: Case) -> None:
    pose, e = shown.frame.belief.pose, shown.encounter
    force = shown.frame.motion.virtual_obstacles[0]
    x, y = (force.position - pose[:2]).tolist()
    c, s = cos(shown.direction), sin(shown.direction)
    at = (c * x + s * y, c * y - s * x)
    disc(
        axes,
        at,
        max(force.radius, 0.012),
        fill=False,
        edgecolor=VIRTUAL,
        linewidth=1.5,
        linestyle=(0, (4, 2)),
    )
    axes.plot(*at, "+", color=VIRTUAL, markersize=7)
    axes.annotate(f"dynamic virtual obstacle, $R_{{vo}}$ = {force.radius:.2f} m", at,
                  xytext=(-6, 46),
                  textcoords="offset points", fontsize=7.5, color=VIRTUAL,
                  arrowprops={"arrowstyle": "-", "color": VIRTUAL, "linewidth": 0.6})  # fmt: skip
    v_r = np.array([shown.frame.motion.speed, 0.0])
    vx, vy = foot_velocity(v_r, np.subtract(at, (e.along, e.across))).tolist()
    axes.annotate("", (at[0] + 2.0 * vx, at[1] + 2.0 * vy), at,
                  arrowprops={"arrowstyle": "-|>", "color": VIRTUAL, "lw": 1})  # fmt: skip


def foot_velocity(robot_velocity: Array, q: Array) -> Array:
    """Return v_r_perp_op = (v_r . q) q/|q|², the velocity of a virtual obstacle (2,) [m/s].

    The projection divides by the squared norm, else its unit would be m²/s (eq. (11)).

    Args:
        robot_velocity: velocity of the robot (2,) [m/s].
        q: p_vo - p_o, from the mover to its virtual obstacle (2,) [m].
    """
    velocity: Array = (robot_velocity @ q) * q / (q @ q)
    return velocity


def _speeds(axes: Axes, shown: Case) -> None:
    """Which speeds are free, the one asked for and the one chosen."""
    v_max = shown.ran[0].scenario.robot.speed.vx
    axes.add_patch(Rectangle((0.0, 0.0), v_max, 1.0, facecolor=MOVER, alpha=0.35))
    for low, high in free_intervals((shown.encounter,), v_max, inf):
        axes.add_patch(Rectangle((low, 0.0), high - low, 1.0, facecolor="#BFDCC9"))
    axes.plot(2 * [shown.frame.motion.speed], (-0.15, 1.15), color=ROBOT, linewidth=2.2)
    axes.set(
        xlim=(0.0, v_max),
        ylim=(-0.2, 1.2),
        yticks=[],
        xticks=np.linspace(0.0, v_max, 5),
        xlabel="speed of the robot [m/s]",
    )
    axes.spines["left"].set_visible(False)
    axes.grid(False)


def _paths(axes: Axes, shown: Case) -> None:
    for ran, color, z in zip(shown.ran, (ROBOT, STILL), (6, 5), strict=True):
        places = np.array(ran.robot)
        axes.plot(*places[:, :2].T, color=color, linewidth=1.4, zorder=z)
        for time in np.arange(0.0, ran.time[-1], STAMP):
            k = ran.at(time)
            scale = 0.45 if shown.letter == "b" else 1.0
            robot(axes, places[k], scale, facecolor=color, zorder=z)
    ran = shown.ran[0]
    movers, radius = np.array(ran.movers)[:, 0], ran.scenario.world.mover[0].radius
    last = ran.time[-1]
    axes.plot(*movers.T, color=MOVER, linewidth=0.8)
    for time in np.arange(0.0, last, STAMP):
        at = movers[ran.at(time)]
        disc(axes, at, radius, facecolor=MOVER, alpha=0.30, edgecolor=MOVER)
        if abs(at[0]) < 2.2 and -1.1 < at[1] < 1.3:
            axes.annotate(f"{time:.0f}", at, ha="center", va="center", fontsize=6.5, clip_on=True)
    for ran in shown.ran:
        hit = np.flatnonzero(clearance(ran) <= 0.0)
        if len(hit):
            axes.plot(
                *ran.robot[int(hit[0])][:2], "x", color="black", markersize=8, mew=1.8, zorder=9
            )
    axes.plot(*shown.frame.task.target, "o", color=GOAL, markersize=6, zorder=4)
    if shown.letter == "b":
        square(axes, (-2.25, -0.35), (-0.30, 0.80))
    else:
        square(axes, (-2.25, 2.05), (-1.1, 1.4))


def _gaps(axes: Axes, shown: Case) -> None:
    gaps = [clearance(ran) for ran in shown.ran]
    for ran, gap, color in zip(shown.ran, gaps, (ROBOT, STILL), strict=True):
        axes.plot(ran.time, gap, color=color, linewidth=1.3)
    least = [f"{100.0 * gap.min():.0f} cm" for gap in gaps]
    axes.set_title(f"minimum {least[0]}, without the scheme {least[1]}", fontsize=8)
    axes.axhspan(-1.0, 0.0, color=MOVER, alpha=0.15, linewidth=0)
    axes.axvline(shown.frame.time, color=ROBOT, linewidth=0.8, linestyle=":")
    axes.set(xlabel="time [s]", ylabel="clearance [m]", ylim=(-0.2, 1.6))
    axes.set_xlim(0.0, shown.ran[0].time[-1])


def draw(cases: list[Case]) -> Figure:
    """The figure."""
    with styled():
        made = figure(
            11.0, 9.0, "Fig. 4  Meeting a mover, profile paper, with and without the scheme"
        )
        rows = made.subplots(4, 3, height_ratios=(2.45, 0.22, 1.9, 1.1))
        for column, shown in enumerate(cases):
            for axes, part in zip(rows[:, column], (_diagram, _speeds, _paths, _gaps), strict=True):
                part(axes, shown)
        handles = [
            Line2D([], [], color=ROBOT, label="robot with the scheme; chosen speed"),
            Line2D([], [], color=STILL, label="robot without it"),
            Line2D([], [], color=MOVER, label=f"mover, numbers are seconds; every {STAMP:.0f} s"),
            Patch(color=MOVER, alpha=0.10, label="$R_{coll}$"),
            Line2D([], [], color=VIRTUAL, linestyle="--", label="dynamic virtual obstacle"),
            Line2D([], [], color="black", marker="x", linestyle="", label="contact"),
            Line2D([], [], color=GOAL, marker="o", linestyle="", label="goal"),
        ]
        made.legend(handles=handles, loc="outside lower center", ncols=7)
    return made
