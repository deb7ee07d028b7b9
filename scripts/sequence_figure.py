"""Fig. 9: the paper's run in snapshots, read from run folders."""

from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, hypot, sin
from pathlib import Path
from types import SimpleNamespace

from hsr8.recording.derived import walk_of
from hsr8.recording.run import Run, open_run
from hsr8.recording.table import Table
from hsr8.recording.verdict import counted
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.show.video.run_images import shown_frames
from hsr8.show.walk_panels import INK, LEFT, RIGHT, contacts, outline
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import Layout
from navigation.belief.belief import Motion, Track
from navigation.belief.tracks import Tracks
from navigation.partial_evaluation import psi_obstacle
from navigation.scene import extended_radius
from navigation.transform import points_to_world
from walking.body.robot_model import RobotModel

import numpy as np
from figure_style import (
    GOAL,
    MOVER,
    ROBOT,
    STILL,
    VIEW,
    VIRTUAL,
    disc,
    figure,
    robot,
    square,
    styled,
    window,
)  # fmt: skip
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from numpy.typing import NDArray

Array = NDArray[np.float64]

COLUMNS = 4
TRAIL, STEPS = 45.0, 12.0  # of the path and of the footprints shown [s]
NEAR = 0.8  # a virtual obstacle so near is worth a snapshot [m]


@dataclass(frozen=True)
class Tour:
    """A run as the figure needs it.

    Attributes:
        name: name of the row.
        scenario: scenario of the run.
        layout: its world.
        frames: belief and decisions.
        walked: records of the run.
        model: model of the robot.
        height: height of the camera [m].
        collisions: times of all collisions (n,) [s].
    """

    name: str
    scenario: Scenario
    layout: Layout
    frames: tuple[SimpleNamespace, ...]
    walked: Table
    model: RobotModel
    height: float
    collisions: Array


def tour(path: Path) -> Tour:
    """Read a run folder; the row is named by its conditions and results."""
    run: Run = open_run(path)
    scenario = load_scenario(str(run.scenario_file), [])
    layout = draw_layout(scenario, run.seed)
    return Tour(
        title(scenario, run),
        scenario,
        layout,
        shown_frames(run, run.frames["time"]),
        run.records,
        load_robot(scenario.robot.model).model,
        float(run.frames["capture_position"][0, 2]),
        run.events["time"][run.events["kind"] == "collision"],
    )


def title(scenario: Scenario, run: Run) -> str:
    """Name of the row: profile, weights and camera; via points, collisions and falls of the run."""
    navigation, camera = scenario.navigation, scenario.camera.source
    name = f"profile {navigation.profile}"
    if navigation.planner.method == "paper":
        name += f", {navigation.planner.paper.weights} weights"
    kinds = run.events["kind"]
    counts = [
        counted(int(run.frames["via_points"][-1]), "via point"),
        counted(int(np.count_nonzero(kinds == "collision")), "collision"),
        counted(int(np.count_nonzero(kinds == "fall")), "fall"),
        f"{float(run.records['time'][-1]):.1f} s",
    ]
    return "\n".join((name, f"{camera} camera", ", ".join(counts)))


def moments(shown: Tour) -> list[SimpleNamespace]:
    """One frame of each stretch of the run, if possible with a large virtual obstacle at hand."""
    edges = np.linspace(0.0, shown.frames[-1].time, COLUMNS + 1)
    return [
        max((f for f in shown.frames if a + 5.0 <= f.time < b), key=lambda f: _interest(f, a, b))
        for a, b in pairwise(edges.tolist())
    ]


def _interest(frame: SimpleNamespace, start: float, stop: float) -> tuple[float, float]:
    x, y, _ = frame.pose
    near = [
        virtual.radius
        for virtual in frame.virtual_obstacles
        if hypot(virtual.position[0] - x, virtual.position[1] - y) < NEAR
    ]
    return round(max(near, default=0.0), 2), -abs(frame.time - 0.5 * (start + stop))


def shapes(shown: Tour, frame: SimpleNamespace) -> list[tuple[tuple[float, float], float]]:
    """Centre and S_oe of the obstacles as believed."""
    tracks = [
        Track(
            id=t.id,
            label=t.label,
            position=np.array(t.position),
            velocity=np.array(t.velocity),
            covariance=np.array(t.covariance),
            radius=t.radius,
            radius_sigma=0.0,
            motion=Motion(t.motion),
            hits=1,
            age=0.0,
            last_seen=np.array(t.position),
            visible=t.visible,
        )
        for t in frame.tracks
    ]
    obstacles, p = Tracks.of(tracks), shown.scenario.navigation
    x, y, yaw = frame.pose
    forward, left, _ = frame.velocity
    velocity = np.array(
        [cos(yaw) * forward - sin(yaw) * left, sin(yaw) * forward + cos(yaw) * left]
    )
    psi_ob = psi_obstacle(obstacles, np.array([x, y]), velocity, p.evaluation)
    radii = extended_radius(obstacles, frame.psi[1], psi_ob, p.univector)
    return list(zip([t.position for t in frame.tracks], radii.tolist(), strict=True))


def draw(tours: list[Tour]) -> Figure:
    """The figure: a row for each run."""
    with styled():
        made = figure(11.0, 3.0 * len(tours) + 0.9, "Fig. 9  Snapshots of the 560.2 s tour")
        rows = made.subplots(len(tours), COLUMNS, squeeze=False, sharex=True, sharey=True)
        for row, shown in zip(rows, tours, strict=True):
            for axes, frame in zip(row, moments(shown), strict=True):
                _snapshot(axes, shown, frame)
            row[0].set_ylabel(f"{shown.name}\ny [m]")
            for axes in row[1:]:
                axes.set_ylabel("")
        for axes in rows[:-1].ravel():
            axes.set_xlabel("")
        made.legend(handles=_legend(), loc="outside lower center", ncols=5)
    return made


def _snapshot(axes: Axes, shown: Tour, frame: SimpleNamespace) -> None:
    records = shown.walked
    first, row = records.at([frame.time - TRAIL, frame.time]).tolist()
    earlier = records.at(np.linspace(frame.time - 8.0, frame.time, 20))
    movers = records["obstacle_positions"][:, len(shown.layout.static) :]
    fov = frame.fov[0], shown.scenario.camera.vertical_fov
    visible = points_to_world(frame.truth, window(*frame.head, fov, shown.height))
    axes.add_patch(Polygon(visible, closed=True, facecolor=VIEW, alpha=0.35, edgecolor="none"))
    for obstacle in shown.layout.static:
        disc(axes, obstacle.position, obstacle.radius, facecolor=STILL, edgecolor="none")
    for k, obstacle in enumerate(shown.layout.movers):
        disc(axes, movers[row, k], obstacle.radius, facecolor=MOVER, edgecolor="none")
        axes.plot(*movers[earlier, k].T, color=MOVER, linewidth=0.8)
    for at, radius in shapes(shown, frame):
        disc(axes, at, radius, fill=False, edgecolor=INK, linewidth=0.6)
    for virtual in frame.virtual_obstacles:
        disc(
            axes,
            virtual.position,
            virtual.radius,
            fill=False,
            edgecolor=VIRTUAL,
            linewidth=1.6,
            linestyle=(0, (3, 1.5)),
        )
    axes.plot(*records["qpos"][first : row + 1 : 10, :2].T, color=ROBOT, linewidth=0.8, alpha=0.6)
    _footprints(axes, shown, frame.time)
    _via_points(axes, shown, frame)
    robot(axes, frame.truth, facecolor=ROBOT)
    half = 0.5 * np.array(shown.layout.field_size)
    square(axes, (-half[0], half[0]), (-half[1], half[1]))
    axes.grid(False)
    hits = np.sum(shown.collisions <= frame.time)
    axes.set_title(
        f"{frame.time:.1f} s, {counted(frame.via_points, 'via point')}, "
        f"{counted(int(hits), 'contact')}",
        fontsize=8,
    )


def _footprints(axes: Axes, shown: Tour, time: float) -> None:
    walk = walk_of(shown.walked.window(time - STEPS, time), shown.model)
    for foot, color in enumerate((LEFT, RIGHT)):
        soles = [outline(walk, foot, rows) for rows in contacts(walk, foot)]
        axes.add_collection(
            PolyCollection(soles, facecolor=color, edgecolor="none", alpha=0.8, zorder=4)
        )


def _via_points(axes: Axes, shown: Tour, frame: SimpleNamespace) -> None:
    points = np.reshape(shown.layout.waypoints, (-1, 2))
    here, ahead = (
        points[frame.via_points % len(points)],
        points[(frame.via_points + 1) % len(points)],
    )
    turn = atan2(*(ahead - here)[::-1].tolist())
    axes.annotate("", here + 0.38 * np.array([cos(turn), sin(turn)]), here,
                  arrowprops={"arrowstyle": "-|>", "color": GOAL, "linewidth": 1.2})  # fmt: skip
    axes.plot(*here, "o", color=GOAL, markersize=4, zorder=5)


def _legend() -> list[object]:
    return [
        Line2D([], [], color=ROBOT, label=f"robot, path of the last {TRAIL:.0f} s"),
        Patch(color=STILL, label="still obstacle"),
        Patch(color=MOVER, label="mover, path of the last 8 s"),
        Line2D([], [], color=INK, linewidth=0.6, label=r"extended shape as believed, $S_{oe}$"),
        Line2D([], [], color=VIRTUAL, linestyle="--", label="dynamic virtual obstacle"),
        Patch(color=VIEW, alpha=0.5, label="gaze window (up to 1.6 m)"),
        Patch(color=LEFT, label="left footprints"),
        Patch(color=RIGHT, label="right footprints"),
        Line2D([], [], color=GOAL, marker="o", label="via point, arrival heading"),
    ]
