"""Images of the pages on how to do something: each from a short run.

The body is kinematic, but in the animation of the dashboard.
"""

import io
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import hsr8
from hsr8.export.bag import write_bag
from hsr8.export.world_files import CELL, occupancy_map
from hsr8.recording.derived import ellipse_axes
from hsr8.recording.run import Run
from hsr8.scenario.loader import load_scenario
from hsr8.show.plan_view import PlanView
from hsr8.show.video.run_video import VideoOptions, render_run
from hsr8.sweep.bench.suite import SHIPPED, read_suite
from hsr8.sweep.seeds import parse_seeds
from hsr8.world.field.generator import draw_layout, draw_world
from hsr8.world.field.layout import Layout

import gymnasium
import numpy as np
from figure_style import (
    GOAL,
    MOVER,
    ROBOT,
    STILL,
    covariance,
    disc,
    figure,
    robot,
    square,
)
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from rich.console import Console
from rich.text import Text
from rosbags.highlevel import AnyReader

Array = NDArray[np.float64]

ROOT = Path(__file__).parents[1]
FAST = {"robot.body": "kinematic", "camera.source": "analytic"}
BLACK = 8.0, 6.0  # start and duration of the fault [s]
WINDOW = 6.0, 6.4  # shown messages [s]
GYM_SEED, GYM_STEPS = 3, 12
CLIP_SEED, CLIP = 2, (6.0, 18.0)  # shown part of a course [s]
WORLDS = (
    *("course", "crowd", "dense", "fast", "conflict", "behind", "corridor", "crossing"),
    *("blind-corner", "pedestrians"),
)
COMPARED = "success", "time_to_goal_s", "path_length_m", "min_clearance_m"
LEGEND = {"frameon": False, "fontsize": 8}


@cache
def quick() -> Run:
    """Run `quick` with a kinematic body."""
    return hsr8.run("quick", settings=FAST)


def world(axes: Axes, layout: Layout, run: Run) -> None:
    """Draw obstacles at the end of a run, the paths of movers, and the mission."""
    positions = run.records["obstacle_positions"]
    for k, obstacle in enumerate(layout.obstacles):
        moves = obstacle.motion is not None
        disc(axes, positions[-1, k], obstacle.radius, facecolor=MOVER if moves else STILL)
        if moves:
            axes.plot(*positions[:, k].T, color=MOVER, linewidth=0.9, linestyle=":")
    axes.plot(*layout.waypoints.T, "*", color=GOAL, markersize=9)
    width, depth = layout.field_size
    square(axes, (-0.5 * width, 0.5 * width), (-0.5 * depth, 0.5 * depth))


def faults() -> Figure:
    """Draw the error of the believed pose while the camera is black."""
    start, duration = BLACK
    fault = f'fault=[{{kind="camera-black",start={start},duration={duration}}}]'
    made = figure(6.8, 2.8, "Pose without images for 6 s")
    axes = made.subplots()
    run = hsr8.run(load_scenario("quick", [*(f"{k}={v}" for k, v in FAST.items()), fault]))
    frames, records = run.frames, run.records
    frames = frames.take(np.flatnonzero(frames["time"] > start - 3.0))
    true = records["robot"][records.at(frames["time"])]
    error = np.hypot(*(frames["pose"] - true)[:, :2].T)
    spread = 2.0 * ellipse_axes(frames["pose_covariance"][:, :2, :2])[0][:, 0]
    axes.axvspan(start, start + duration, color="#DDDDDD", label="camera black")
    axes.plot(frames["time"], 100.0 * error, color=MOVER, label="position error")
    axes.plot(frames["time"], 100.0 * spread, color=ROBOT, label="2σ of the belief")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("[cm]")
    axes.legend(**LEGEND)
    return made


def circle() -> Figure:
    """Draw the paths of robot and people in `circle`."""
    scenario = load_scenario("circle", FAST)
    run = hsr8.run(scenario)
    made = figure(4.8, 4.6, "Circle crossing: the robot among five people")
    axes = made.subplots()
    world(axes, draw_layout(scenario, run.seed), run)
    poses = run.records["robot"]
    axes.plot(*poses[:, :2].T, color=ROBOT, linewidth=1.6)
    robot(axes, poses[-1].tolist(), 1.2)
    axes.set_title("blue: robot, red: people, star: goal of the robot")
    return made


def bench() -> Figure:
    """Draw the first world of every family of the benchmark."""
    suite = read_suite(SHIPPED)
    seed = parse_seeds(suite.full)[0]
    made = figure(9.0, 6.0, f"The families of the suite, seed {seed}")
    for axes, family in zip(made.subplots(2, 3).flat, suite.families, strict=True):
        scenario = load_scenario(family, suite.settings, seed)
        axes.imshow(PlanView(draw_layout(scenario, seed), scenario.robot.radius).draw())
        axes.set_axis_off()
        axes.set_title(family)
    return made


def gym() -> Figure:
    """Draw an observation and the image from outside, and the reward of an episode."""
    settings = ["robot.body=kinematic", "camera.source=analytic"]
    env = gymnasium.make(
        "hsr8.gym:hsr8/Navigate-v0", scenario="crowd", settings=settings, render_mode="rgb_array"
    )
    observation, _ = env.reset(seed=GYM_SEED)
    rewards, ended = [0.0], False
    while not ended and len(rewards) < GYM_STEPS:
        ahead = observation["target"][:2]
        turn = float(np.clip(2.0 * np.arctan2(ahead[1], ahead[0]), -1.0, 1.0))
        observation, reward, stopped, cut, _ = env.step(np.array([1.0, 0.0, turn], np.float32))
        rewards.append(rewards[-1] + float(reward))
        ended = stopped or cut
    made = figure(9.2, 3.0, "Navigate-v0 after a policy that walks straight to the target")
    outside, observed, curve = made.subplots(1, 3, width_ratios=(1.3, 1.0, 1.0))
    outside.imshow(env.render())
    outside.set_axis_off()
    outside.set_title("env.render()")
    robot(observed, (0.0, 0.0, 0.0))
    for row in observation["tracks"][observation["track_mask"] > 0]:
        disc(observed, row[:2], float(row[5]), facecolor=MOVER if row[7] == 1.0 else STILL)
        covariance(observed, row[:2], np.eye(2) * row[4] ** 2, 2.0, color=ROBOT, linewidth=0.8)
    observed.plot(*observation["target"][:2], "*", color=GOAL, markersize=9)
    square(observed, (-2.0, 2.0), (-2.0, 2.0), "R")
    observed.set_title("observation: tracks and target")
    curve.plot(rewards, color=ROBOT)
    curve.set_xlabel("step")
    curve.set_title("sum of the rewards")
    env.close()
    return made


def export() -> Figure:
    """Draw the map for the ROS map server with the path of a run in it."""
    run = quick()
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    made = figure(4.6, 4.4, "Map of a world, and the path of a run from its table")
    axes = made.subplots()
    grid = occupancy_map(layout)
    width, depth = layout.field_size
    square(axes, (-0.5 * width, 0.5 * width), (-0.5 * depth, 0.5 * depth))
    half = 0.5 * np.array(grid.shape[::-1]) * CELL * layout.scale
    axes.imshow(grid, extent=(-half[0], half[0], -half[1], half[1]), cmap="gray")
    axes.plot(*run.records["robot"][:, :2].T, color=ROBOT, linewidth=1.5)
    return made


def ros() -> Figure:
    """Draw the messages of all topics of a bag in half a second."""
    run = quick()
    times: dict[str, list[float]] = {}
    with TemporaryDirectory() as folder:
        bag = Path(folder, "bag")
        write_bag(run, bag)
        with AnyReader([bag]) as reader:
            for connection, stamp, _ in reader.messages():
                times.setdefault(connection.topic, []).append(1e-9 * stamp)
    made = figure(7.2, 3.4, "Messages of a run in 0.4 s")
    axes = made.subplots()
    names = sorted(times, key=lambda name: len(times[name]))
    axes.eventplot([times[name] for name in names], colors=ROBOT, linelengths=0.7, linewidths=1.2)
    axes.set_yticks(range(len(names)), names)
    axes.set_xlim(*WINDOW)
    axes.set_xlabel("simulated time [s]")
    return made


def python() -> Figure:
    """Draw the path of the planner of the page next to that of the default planner."""
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (text,) = (block for block in blocks if "class StraightThere" in block)
    made = figure(4.8, 4.6, "Paths of the default planner and of `StraightThere`")
    axes = made.subplots()
    with TemporaryDirectory() as folder:
        file = Path(folder, "straight.py")
        file.write_text(text.partition("\nsettings")[0], encoding="utf-8")
        custom = hsr8.run("quick", settings=FAST | {"plugin.planner": f"{file}:StraightThere"})
    run = quick()
    world(axes, draw_layout(run.scenario(), run.seed), run)
    for one, color, name in ((run, ROBOT, "default"), (custom, GOAL, "StraightThere")):
        label = f"{name}: {one.metrics['collisions']} collisions"
        axes.plot(*one.records["robot"][:, :2].T, color=color, label=label)
    axes.legend(**LEGEND)
    return made


def called(folder: str, words: str) -> str:
    """Run a command of hsr8 in a folder and return its output."""
    command = [sys.executable, "-m", "hsr8", *shlex.split(words)]
    return subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=True
    ).stdout


def terminal(folder: Path) -> None:
    """Write the terminal of a first run as SVG, without its fonts, which are on the network."""
    console = Console(record=True, width=100, file=io.StringIO())
    with TemporaryDirectory() as scratch:
        for words in ("run quick", "info runs/quick"):
            console.print(Text(f"$ hsr8 {words}", style="bold"))
            lines = called(scratch, words).splitlines()
            shown = [line for line in lines if not line.startswith("│ machine")]
            console.print(Text.from_ansi("\n".join(shown)))
    text = console.export_svg(title="a first run")
    (folder / "terminal.svg").write_text(
        re.sub(r"@font-face \{.*?\}", "", text, flags=re.DOTALL), encoding="utf-8"
    )


def comparison(folder: Path) -> None:
    """Write the forest plot of the sweeps of the tutorial as SVG."""
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    with TemporaryDirectory() as scratch:
        for name, kind in (("yard.toml", "toml"), ("shy.py", "python")):
            text = re.search(rf"`{name}`:\n\n```{kind}\n(.*?)```", page, re.DOTALL)
            assert text is not None
            Path(scratch, name).write_text(text[1], encoding="utf-8")
        sweeps = re.findall(r"^hsr8 (sweep .*)$", page, re.MULTILINE)
        arms = [line.split()[-1] for line in sweeps]
        for line in sweeps:
            called(scratch, line)
        file = shlex.quote(str(folder / "comparison.svg"))
        metrics = " ".join(f"--metric {name}" for name in COMPARED)
        called(scratch, f"compare {' '.join(arms)} {metrics} --figure {file}")


HOWTO = {
    "faults": faults,
    "circle": circle,
    "bench": bench,
    "gym": gym,
    "export": export,
    "ros": ros,
    "python": python,
}


def worlds(folder: Path) -> None:
    """Write the plans of the built-in scenarios, as ``hsr8 check --image`` draws them."""
    plans = folder / "worlds"
    plans.mkdir(exist_ok=True)
    for name in WORLDS:
        scenario = load_scenario(name)
        drawn = draw_world(scenario, scenario.seed)
        plan = PlanView(drawn.layout, scenario.robot.radius, 600, drawn.certificate)
        Image.fromarray(plan.draw()).save(plans / f"{name}.webp", quality=85)


def dashboard(folder: Path) -> None:
    """Draw the video of a course, in full physics, as an animation."""
    run = hsr8.run("course", seed=CLIP_SEED, settings={"duration": CLIP[1]})
    start, stop = CLIP
    options = VideoOptions(fps=6, speed=1.0, start=start, stop=stop, size=(800, 450), fine=True)
    render_run(run, options, folder / "dashboard.webp", lambda done, of: None)


WRITTEN: dict[str, Callable[[Path], None]] = {
    "dashboard": dashboard,
    "terminal": terminal,
    "comparison": comparison,
    "worlds": worlds,
}
"""Functions that write their images into a folder themselves."""
