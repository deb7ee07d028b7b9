"""Draw the images of the manual from runs, those of the concept pages from a run of `crowd`.

    python scripts/manual_images.py             # all, into docs/images
    python scripts/manual_images.py gaze belief

The body is kinematic and the camera rendered, so a drawing shows images, detections and belief as
the robot has them. `footsteps` and `capture` are walks in full physics.
"""

import argparse
import re
from collections.abc import Callable
from math import degrees
from pathlib import Path
from tempfile import TemporaryDirectory

import hsr8
from hsr8.recording.palette import of_label
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.show.evaluations import EVALUATIONS
from hsr8.show.plan_sheet import plan_sheet
from hsr8.show.plan_view import PlanView
from hsr8.show.video.run_images import RunImages
from hsr8.show.walk_panels import BLUE, GREEN, INK, ORANGE, PURPLE
from hsr8.simulation.decisions import FrameRecord
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import TickRecord
from hsr8.world.field.generator import draw_world
from navigation.transform import points_to_world
from vision.detection import Detection

import numpy as np
from crowd_run import SEED, CrowdRun, crowd
from figure_style import (
    GOAL,
    MOVER,
    ROBOT,
    STILL,
    VIEW,
    covariance,
    disc,
    figure,
    robot,
    square,
    styled,
)
from howto_images import HOWTO, WRITTEN
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle
from numpy.typing import NDArray

Array = NDArray[np.float64]

IMAGES = Path(__file__).parents[1] / "docs/images"
WALK = ("command.vx=0.2", "command.wz=0.3", "duration=5.0", "recorder.period_ms=5")
STRIP = (-0.10, 0.10, 0.30, 0.50, 0.70, 1.10)  # of a capture step, after the push [s]
AROUND = 1.3  # half side of a map [m]


# Parts of maps


def ground(axes: Axes, ran: CrowdRun, record: TickRecord, centre: Array) -> None:
    """Draw beacons, obstacles in outlines and the true robot around a point."""
    here = np.reshape(record.truth.obstacle_positions, (-1, 2))
    for obstacle, position in zip(ran.layout.obstacles, here, strict=True):
        disc(axes, position, obstacle.radius, facecolor="none", edgecolor=INK, linewidth=1.0)
    for beacon in ran.layout.beacons:
        disc(axes, beacon.position, 0.05, facecolor=VIEW, edgecolor=INK, linewidth=0.8)
    robot(axes, record.truth.robot)
    x, y = centre.tolist()
    square(axes, (x - AROUND, x + AROUND), (y - AROUND, y + AROUND))


def view(axes: Axes, record: TickRecord, fov: float) -> None:
    """Draw the field of view of a frame."""
    frame = frame_of(record)
    angles = frame.context.view.pan + 0.5 * fov * np.linspace(-1.0, 1.0, 20)
    rim = 2.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = points_to_world(frame.belief.pose, np.vstack([np.zeros((1, 2)), rim]))
    axes.add_patch(Polygon(points, closed=True, facecolor=VIEW, alpha=0.25, zorder=0))


def frame_of(record: TickRecord) -> FrameRecord:
    """Return the camera frame of a record that has one."""
    assert record.frame is not None
    return record.frame


def color(label: str) -> tuple[float, ...]:
    """Return the colour of a class for Matplotlib."""
    return tuple(channel / 255 for channel in of_label(label))


def note(axes: Axes, text: str, at: Array, offset: tuple[float, float]) -> None:
    """Explain a mark by a text at an offset [points]."""
    axes.annotate(
        text,
        (float(at[0]), float(at[1])),
        xytext=offset,
        textcoords="offset points",
        fontsize=7.5,
        color=INK,
        ha="center",
        arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.6},
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.0},
        zorder=9,
    )


# Drawings


def vision() -> Figure:
    """Draw the image with the boxes of detections, and the fitted cylinders from above."""
    ran = crowd()
    record = max(ran.records, key=lambda r: len(frame_of(r).detections))
    frame = frame_of(record)
    made = figure(9.2, 3.9, "From pixels to cylinders")
    left, right = made.subplots(1, 2, width_ratios=(1.5, 1.0))
    assert frame.image is not None
    left.imshow(frame.image)
    left.set_axis_off()
    left.set_title("head camera: blobs and their distance")
    for detection in frame.detections:
        _box(left, detection)
    right.set_title("fitted cylinders, ellipses of 10 sigma")
    robot(right, (0.0, 0.0, 0.0), 0.8)
    for detection in frame.detections:
        at = detection.distance * np.array([np.cos(detection.bearing), np.sin(detection.bearing)])
        shade = color(detection.label)
        disc(right, at, max(detection.radius, 0.05), facecolor=shade, alpha=0.45)
        c, s = np.cos(detection.bearing), np.sin(detection.bearing)
        J = np.array([[c, -detection.distance * s], [s, detection.distance * c]])
        covariance(right, at, J @ detection.covariance @ J.T, 10.0, color=shade, linewidth=1.2)
    far = max(detection.distance for detection in frame.detections) + 0.3
    square(right, (-0.3, far), (-0.6 * far, 0.6 * far), "R")
    return made


def _box(axes: Axes, detection: Detection) -> None:
    left, top, right, bottom = detection.box
    axes.add_patch(
        Rectangle(
            (left, top),
            right - left,
            bottom - top,
            facecolor="none",
            edgecolor="white",
            linewidth=1.4,
        )
    )
    axes.text(
        left, top - 3, f"{detection.distance:.2f} m", color="white", fontsize=7, weight="bold"
    )


def belief() -> Figure:
    """Draw tracks and particles of movers that the camera no longer shows."""
    ran = crowd()

    def lost(record: TickRecord) -> float:
        tracks = frame_of(record).belief.tracks
        near = [
            t.particles is not None and np.hypot(*(t.position - record.truth.robot[:2])) < AROUND
            for t in tracks
        ]
        return float(sum(near))

    record = max(ran.records, key=lost)
    frame = frame_of(record)
    made = figure(6.4, 5.2, "Tracks, and particles of movers out of view")
    axes = made.subplots()
    view(axes, record, ran.fov[0])
    ground(axes, ran, record, frame.belief.pose[:2])
    for track in frame.belief.tracks:
        shade = color(track.label)
        if track.particles is None:
            disc(axes, track.position, track.radius, facecolor=shade, alpha=0.5)
            covariance(axes, track.position, track.covariance[:2, :2], 2.0, color=shade)
        else:
            axes.plot(*track.particles.positions.T, "o", color=shade, markersize=2.2, zorder=7)
            tips = track.particles.positions + track.particles.velocities
            ends = np.stack([track.particles.positions, tips], axis=1)
            axes.add_collection(LineCollection(list(ends), colors=[shade], linewidths=0.6))
        if np.hypot(*track.velocity) > 0.02:
            tip = track.position + 2.0 * track.velocity
            axes.annotate("", tip, track.position, arrowprops={"arrowstyle": "->", "color": shade})
    clouds = [t for t in frame.belief.tracks if t.particles is not None]
    nearest = min(clouds, key=lambda t: np.hypot(*(t.position - frame.belief.pose[:2])))
    note(axes, "16 particles of a lost mover", nearest.position, (0.0, 42.0))
    axes.set_title("filled: believed, outline: true, arrow: motion in 2 s, yellow: field of view")
    return made


def gaze() -> Figure:
    """Draw the value of all views, and the chosen one on the map."""
    ran = crowd()
    pairs = zip(ran.records, ran.records[1:], strict=False)
    _, record = max(pairs, key=lambda pair: _saccade(*map(frame_of, pair)))
    frame = frame_of(record)
    decision = frame.gaze
    made = figure(9.2, 3.9, "The gaze takes the view of the highest value per time")
    left, right = made.subplots(1, 2, width_ratios=(1.25, 1.0))
    values = decision.gaze_map
    limits = load_scenario("crowd").navigation.gaze
    across = limits.max_pan / (values.shape[1] - 1)  # half a cell
    up = 0.5 * (limits.max_tilt - limits.min_tilt) / (values.shape[0] - 1)
    pan, lowest, highest = limits.max_pan + across, limits.min_tilt - up, limits.max_tilt + up
    shown = left.imshow(
        values[::-1, ::-1],  # tilts upwards, pans to the left
        extent=[degrees(angle) for angle in (pan, -pan, lowest, highest)],
        aspect="auto",
        cmap="inferno",
        interpolation="nearest",
    )
    made.colorbar(shown, ax=left, label="value [1/s]", shrink=0.9)
    pan, tilt = degrees(decision.pan), degrees(decision.tilt)
    now = frame.context.view
    left.plot(degrees(now.pan), degrees(now.tilt), "o", color="white", markersize=5)
    left.plot(pan, tilt, "o", color=BLUE, markersize=11, fillstyle="none", markeredgewidth=2)
    left.grid(visible=False)
    left.set_xlabel("pan, left positive [deg]")
    left.set_ylabel("tilt [deg]")
    left.set_title("white: present direction, ring: chosen view")
    view(right, record, ran.fov[0])
    ground(right, ran, record, frame.belief.pose[:2])
    for track in frame.belief.tracks:
        disc(right, track.position, track.radius, facecolor=color(track.label), alpha=0.5)
        if track.particles is not None:
            right.plot(*track.particles.positions.T, "o", color=color(track.label), markersize=1.6)
    angle = float(frame.belief.pose[2]) + decision.pan
    start = frame.belief.pose[:2]
    tip = start + 1.1 * np.array([np.cos(angle), np.sin(angle)])
    right.annotate("", tip, start, arrowprops={"arrowstyle": "->", "color": BLUE, "lw": 2})
    psi = (decision.psi_lm, decision.psi_sf, decision.psi_ob, decision.psi_way)
    pairs = zip(EVALUATIONS, psi, strict=True)
    texts = [f"{name} {value:.2f}" for name, value in pairs]
    right.set_title("\n".join(", ".join(texts[k : k + 2]) for k in (0, 2)))
    return made


def _saccade(before: FrameRecord, frame: FrameRecord) -> float:
    """Return the angle of a new saccade, if the belief has particles [rad]."""
    clouds = sum(track.particles is not None for track in frame.belief.tracks)
    return abs(frame.gaze.pan - before.gaze.pan) if clouds else 0.0


def veto() -> Figure:
    """Draw the candidates of the safety filter at a veto."""
    ran = crowd()
    time, taken = max(ran.vetoes.items(), key=lambda item: np.ptp(item[1].loss.clip(0.0, 60.0)))
    record = next(r for r in ran.records if frame_of(r).time == time)
    made = figure(6.8, 5.2, "A veto of the safety filter")
    axes = made.subplots()
    ground(axes, ran, record, taken.start.pose[:2])
    for hypothesis in taken.discs:
        at, strength = hypothesis["position"], min(1.0, 0.1 + float(hypothesis["weight"]))
        disc(axes, at, hypothesis["radius"], facecolor=MOVER, alpha=0.12 * strength)
        path = np.stack([at, at + 2.0 * hypothesis["velocity"]])
        axes.plot(*path.T, color=MOVER, alpha=strength, linewidth=0.8)
    shade = colormaps["viridis_r"]
    worst = float(np.quantile(taken.loss, 0.9))
    colors = [shade(min(1.0, float(value) / worst)) for value in taken.loss]
    axes.add_collection(LineCollection(list(taken.paths), colors=colors, linewidths=1.0))
    best = int(np.argmin(taken.loss))
    for index, look, text in ((0, ORANGE, "desired"), (best, GREEN, "chosen")):
        axes.plot(*taken.paths[index].T, color=look, linewidth=2.6, zorder=8)
        label = f"{text}, loss {taken.loss[index]:.1f} s"
        note(axes, label, taken.paths[index, -1], (30.0 if index else -30.0, 28.0))
    axes.plot(*frame_of(record).task.target, "*", color=GOAL, markersize=11)
    x, y = taken.start.pose[:2].tolist()
    square(axes, (x - 0.95, x + 0.95), (y - 0.75, y + 0.75))
    axes.set_title("candidates by their loss; red: where movers may be, and their path in 2 s")
    return made


def footsteps() -> Figure:
    """Draw footsteps, ZMP, DCM and centre of mass of a walk in a curve."""
    scenario = load_scenario("walk", [*WALK])
    zmp, dcm, com, feet = [], [], [], {}
    with Simulation(scenario, SEED) as simulation:
        for tick in simulation:
            if tick.record is None:
                continue
            state = tick.record.walking
            zmp.append(state.zmp)
            dcm.append(state.dcm)
            com.append(state.balance.com)
            feet[state.step_count] = state.footsteps[0]
    sole = load_robot("hsr8").model.sole
    made = figure(6.4, 4.4, "Footsteps, ZMP, DCM and centre of mass from above")
    axes = made.subplots()
    for foot in feet.values():
        half = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * (sole.half_length, sole.half_width)
        corners = points_to_world((foot.x, foot.y, foot.yaw), half + np.array([sole.centre, 0.0]))
        axes.add_patch(
            Polygon(corners, facecolor=ROBOT if foot.left else ORANGE, alpha=0.22, edgecolor=STILL)
        )
    for points, look, text in (
        (zmp, MOVER, "ZMP"),
        (dcm, PURPLE, "DCM"),
        (com, INK, "centre of mass"),
    ):
        axes.plot(*np.array(points).T, color=look, linewidth=1.3, label=text)
    axes.legend(frameon=False, loc="upper left", fontsize=8)
    low, high = np.min(zmp, axis=0) - 0.12, np.max(zmp, axis=0) + 0.12
    square(axes, (low[0], high[0]), (low[1], high[1]))
    axes.set_title("blue: left foot, orange: right foot")
    return made


def capture() -> Figure:
    """Draw a push and the capture step as a strip of images."""
    settings = ["disturbance.random.impulse=[1.2,1.4]", "duration=12.0"]
    pushed = hsr8.run(load_scenario("push", settings), seed=SEED)
    moved = np.hypot(*pushed.records["capture"].T)
    pushes = pushed.records["pushes"]
    begins = np.unique(pushes["begin"])
    time = pushed.records["time"]
    reach = [moved[(time >= begin) & (time < begin + 0.8)].max() for begin in begins]
    begin = float(begins[int(np.argmax(reach))])
    instants = begin + np.array(STRIP)
    with RunImages(pushed, instants, (400, 540), fps=25, speed=1.0, fine=True) as images:
        draw = images.camera("follow")
        shots = [draw(k).copy() for k in range(len(instants))]
    made = figure(9.2, 1.9, f"A push, and a capture step of {100.0 * max(reach):.0f} cm")
    for axes, shot, after in zip(made.subplots(1, len(shots)), shots, STRIP, strict=True):
        axes.imshow(shot[140:380])
        axes.set_axis_off()
        axes.set_title(f"{after:+.2f} s")
    return made


def yard() -> Figure:
    """Draw the world of the tutorial, as ``hsr8 check --image`` does."""
    page = (IMAGES.parent / "tutorial.md").read_text()
    text = re.search(r"```toml\n(.*?)```", page, re.DOTALL)
    assert text is not None
    with TemporaryDirectory() as folder:
        file = Path(folder, "yard.toml")
        file.write_text(text[1])
        scenario = load_scenario(str(file))
    world = draw_world(scenario, scenario.seed)
    made = figure(5.0, 5.6, "")
    axes = made.subplots()
    plan = PlanView(world.layout, scenario.robot.radius, certificate=world.certificate)
    axes.imshow(plan_sheet(plan, f"yard, seed {scenario.seed}"))
    axes.set_axis_off()
    return made


DRAWINGS: dict[str, Callable[[], Figure]] = {
    "vision": vision,
    "belief": belief,
    "gaze": gaze,
    "veto": veto,
    "footsteps": footsteps,
    "capture": capture,
    "yard": yard,
    **HOWTO,
}


def main() -> None:
    """Draw the named images, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", choices=[*DRAWINGS, *WRITTEN, []], metavar="NAME")
    parser.add_argument("--out", type=Path, default=IMAGES, metavar="DIR")
    options = parser.parse_args()
    for name in options.names or [*DRAWINGS, *WRITTEN]:
        if name in WRITTEN:
            WRITTEN[name](options.out.resolve())
            continue
        with styled():
            made = DRAWINGS[name]()
            file = options.out / f"{name}.webp"
            made.savefig(file, dpi=120, pil_kwargs={"quality": 88})
        print(f"{file.name}  {file.stat().st_size / 1000:.0f} kB", flush=True)


if __name__ == "__main__":
    main()
