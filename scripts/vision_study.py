"""How well the detector sees: random scenes rendered by MuJoCo against segmentation truth.

    python scripts/vision_study.py --frames 1000 --seed 1 --pictures runs

Every frame draws 16 obstacles and 6 beacons around a camera at walking height with a
random gaze and a swaying body; the detector is told a pose with random errors of the
size it is told to expect.
"""

import argparse
import os
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import atan2, cos, hypot, radians, sin
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

from vision.camera import CameraPose, PinholeCamera
from vision.colour import COLOUR_CLASSES
from vision.detection import Detection
from vision.detector import Detector
from vision.parameters import VisionParameters

Array = NDArray[np.float64]

WIDTH, HEIGHT, FOV = 320, 240, radians(70.0)
CAMERA_HEIGHT = 0.47
OBSTACLES = tuple(n for n, c in COLOUR_CLASSES.items() if c.kind == "obstacle")
BEACONS = tuple(n for n, c in COLOUR_CLASSES.items() if c.kind == "beacon")
NAMES = tuple(f"{a}/{b}" for a in BEACONS for b in BEACONS if a != b)
FIELD = 2.5  # half side of the field [m]
RIM = 2.9  # half side of the square the beacons stand on [m]
MAX_MATCH = 0.25  # a detection farther than this from every visible thing is false [m]
MIN_PIXELS = 12  # a thing of which less can be seen does not count [pixel]
SURPRISE = 20.0  # NEES of two degrees of freedom that one in 20 000 should exceed


@dataclass(frozen=True)
class Thing:
    """A cylinder of the scene and how much of it can be seen."""

    kind: str
    label: str
    x: float
    y: float
    radius: float
    height: float
    geoms: tuple[int, ...]


@dataclass(frozen=True)
class Sight:
    """A thing in one frame.

    Attributes:
        thing: what it is.
        distance: from the robot [m].
        bearing: [rad].
        hidden: share of its outline that other things hide.
        cut: the border of the image cuts it.
    """

    thing: Thing
    distance: float
    bearing: float
    hidden: float
    cut: bool

    @property
    def clear(self) -> bool:
        """Whether nothing hides or cuts it."""
        return self.hidden < 0.04 and not self.cut

    @property
    def group(self) -> str:
        """Name of the table it is counted in."""
        if self.thing.kind == "beacon":
            return "beacons"
        return "clear obstacles" if self.clear else "partly hidden or cut obstacles"

    @property
    def counted(self) -> bool:
        """Whether the detector is asked to find it."""
        if self.thing.kind == "beacon":
            return self.clear and self.distance < 5.0
        return 0.3 <= self.distance <= 2.5


@dataclass
class Tally:
    """Counts and errors of one group of things."""

    seen: int = 0
    hit: int = 0
    errors: list[tuple[float, ...]] = field(default_factory=list)


@dataclass
class Study:
    """Everything counted."""

    groups: dict[str, Tally] = field(default_factory=lambda: defaultdict(Tally))
    reported: int = 0
    false: int = 0
    reported_clear: int = 0
    false_clear: int = 0
    false_beacons: int = 0
    times: list[float] = field(default_factory=list)


def world(rng: np.random.Generator, light: float) -> tuple[mujoco.MjModel, list[Thing]]:
    """A field with 16 obstacles and 6 beacons; the robot stands at a random place in it."""
    spec = mujoco.MjSpec()
    spec.visual.headlight.ambient = np.full(3, 0.35 * light)
    spec.visual.headlight.diffuse = np.full(3, 0.5 * light)
    spec.visual.headlight.specular = np.zeros(3)
    spec.visual.quality.offsamples = 0
    spec.visual.quality.shadowsize = 0
    spec.visual.quality.numslices = 16
    spec.visual.quality.numstacks = 8
    spec.visual.global_.offwidth, spec.visual.global_.offheight = WIDTH, HEIGHT
    spec.visual.map.znear = 0.01
    spec.stat.extent = 1.0
    root = spec.worldbody
    root.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=(0, 0, 3),
        dir=(0.2, 0.1, -1),
        diffuse=np.full(3, 0.6 * light),
        specular=np.zeros(3),
        castshadow=False,
    )
    root.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=(0, 0, 0.05), rgba=(0.6, 0.59, 0.56, 1))
    root.add_camera(name="eye", mode=mujoco.mjtCamLight.mjCAMLIGHT_FIXED, fovy=70.0)

    things: list[Thing] = []
    robot = rng.uniform(-1.8, 1.8, 2)

    def post(at: tuple[float, float], radius: float, span: tuple[float, float], colour: str) -> int:
        geom = root.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=(*at, 0.5 * (span[0] + span[1])),
            size=(radius, 0.5 * (span[1] - span[0]), 0),
            rgba=(*COLOUR_CLASSES[colour].rgb, 1.0),
        )
        geom.name = f"g{len(root.geoms)}"
        return len(root.geoms) - 1

    while len(things) < 16:
        x, y = (rng.uniform(-FIELD, FIELD, 2) - robot).tolist()
        radius = rng.uniform(0.05, 0.12)
        clear = all(hypot(x - t.x, y - t.y) > radius + t.radius + 0.05 for t in things)
        if hypot(x, y) < radius + 0.2 or not clear:
            continue
        colour = OBSTACLES[rng.integers(len(OBSTACLES))]
        geom = post((x, y), radius, (0.0, 0.30), colour)
        things.append(Thing("obstacle", colour, x, y, radius, 0.30, (geom,)))
    corners = [(a, b) for a in (-RIM, RIM) for b in (-RIM, 0.0, RIM)]
    for (x0, y0), i in zip(corners, rng.permutation(len(NAMES)).tolist(), strict=True):
        x, y = x0 - robot[0], y0 - robot[1]
        top, bottom = NAMES[i].split("/")
        geoms = (
            post((x, y), 0.05, (0.0, 0.30), bottom),
            post((x, y), 0.05, (0.30, 0.60), top),
        )
        things.append(Thing("beacon", NAMES[i], x, y, 0.05, 0.60, geoms))
    return spec.compile(), things


def rotation_of(yaw: float, pitch: float, roll: float) -> Array:
    """R_RC of a camera turned left by `yaw`, up by `pitch`, rolled by `roll` [rad]."""
    cy, sy, cp, sp, cr, sr = cos(yaw), sin(yaw), cos(pitch), sin(pitch), cos(roll), sin(roll)
    Rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    Ry = np.array([[cp, 0, -sp], [0, 1, 0], [sp, 0, cp]])
    Rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    level: Array = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Rz @ Rx @ Ry @ level


def silhouette(thing: Thing, camera: PinholeCamera, R: Array, p: Array) -> tuple[Array, bool]:
    """Mask of the whole cylinder as if alone, and whether the border cuts it."""
    angle = np.arange(48) * (2.0 * np.pi / 48)
    ring = np.stack(
        [thing.x + thing.radius * np.cos(angle), thing.y + thing.radius * np.sin(angle)]
    )
    points = np.concatenate(
        [np.stack([*ring, np.full(48, z)], axis=1) for z in (0.0, thing.height)]
    )
    local = (points - p) @ R
    mask = np.zeros((camera.height, camera.width), np.uint8)
    if (local[:, 2] < 0.02).any():
        return mask, True
    pixels = camera.project(local)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    cut = bool((low < 0).any() or high[0] > camera.width or high[1] > camera.height)
    hull = cv2.convexHull(pixels.astype(np.float32))[:, 0].astype(float)
    x0, y0 = np.maximum(np.floor(low), 0).astype(int).tolist()
    x1, y1 = np.minimum(np.ceil(high), (camera.width, camera.height)).astype(int).tolist()
    if x1 <= x0 or y1 <= y0:
        return mask, True
    u, v = np.meshgrid(np.arange(x0, x1) + 0.5, np.arange(y0, y1) + 0.5)
    edge = np.roll(hull, -1, axis=0) - hull
    side = edge[:, 0, None, None] * (v - hull[:, 1, None, None]) - edge[:, 1, None, None] * (
        u - hull[:, 0, None, None]
    )
    mask[y0:y1, x0:x1] = (side >= 0).all(axis=0) | (side <= 0).all(axis=0)
    return mask, cut


def frames(
    count: int, rng: np.random.Generator, light: tuple[float, float], noise: float
) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.int32], Array, Array, list[Thing]]]:
    """Image, geom of each pixel, true rotation and position of the camera, and things."""
    for _ in range(count):
        model, things = world(rng, rng.uniform(*light))
        data = mujoco.MjData(model)
        pan, tilt = rng.uniform(-1.57, 1.57), rng.uniform(-1.05, 0.35)
        if rng.random() < 0.5:
            tilt = rng.uniform(-0.6, 0.0)
        R = rotation_of(pan, tilt, radians(rng.normal(0, 3.0)))
        R = rotation_of(0.0, radians(rng.normal(0, 2.0)), 0.0) @ LEVEL.T @ R
        p = np.array([0.03, rng.normal(0, 0.01), CAMERA_HEIGHT + rng.normal(0, 0.005)])
        model.cam_pos[0] = p
        mujoco.mju_mat2Quat(model.cam_quat[0], (R * (1.0, -1.0, -1.0)).ravel())
        mujoco.mj_forward(model, data)
        with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
            renderer.update_scene(data, camera="eye")
            image = renderer.render().copy()
            renderer.enable_segmentation_rendering()
            renderer.update_scene(data, camera="eye")
            geoms = renderer.render()[:, :, 0].copy()
        if noise:
            noisy = image + rng.normal(0.0, noise, image.shape)
            image = np.clip(np.round(noisy), 0, 255).astype(np.uint8)
        yield image, geoms, R, p, things


LEVEL = rotation_of(0.0, 0.0, 0.0)


def told(R: Array, p: Array, rng: np.random.Generator, sigma: float) -> CameraPose:
    """The pose with the errors that the detector is told to expect."""
    errors = rng.normal(0.0, 1.0, 4) * (sigma, sigma, 0.2 * sigma, 0.003)
    heading = atan2(R[1, 0], R[0, 0]) + 0.5 * np.pi
    turn, back = rotation_of(heading, 0, 0) @ LEVEL.T, rotation_of(-heading, 0, 0) @ LEVEL.T
    small = rotation_of(errors[2], errors[0], errors[1]) @ LEVEL.T
    return CameraPose(
        rotation=turn @ small @ back @ R,
        position=p + np.array([0.0, 0.0, errors[3]]),
        tilt_sigma=sigma,
        roll_sigma=sigma,
        yaw_sigma=0.2 * sigma,
        height_sigma=0.003,
    )


def annotate(image: NDArray[np.uint8], found: tuple[Detection, ...], path: Path) -> None:
    """Write the image, three times as large, with what was found in it."""
    big = cv2.resize(image[:, :, ::-1], None, fx=3, fy=3, interpolation=cv2.INTER_NEAREST)
    for d in found:
        x0, y0, x1, y1 = (3 * b for b in d.box)
        cv2.rectangle(big, (x0, y0), (x1, y1), (255, 255, 255), 1)
        flags = ("c" if d.cut else "") + ("o" if d.occluded else "")
        sigma = float(d.covariance[0, 0]) ** 0.5
        text = f"{d.label[:3]} {d.distance:.2f}({sigma:.2f}) r{d.radius:.2f}{flags}"
        cv2.putText(
            big, text, (x0, max(12, y0 - 3)), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (255, 255, 255)
        )
    cv2.imwrite(str(path), big)


def sights(
    geoms: NDArray[np.int32], R: Array, p: Array, things: list[Thing], camera: PinholeCamera
) -> list[Sight]:
    """Things of which at least a few pixels can be seen, nearest first."""
    found = []
    for thing in things:
        pixels = int(np.isin(geoms, thing.geoms).sum())
        if pixels < MIN_PIXELS:
            continue
        full, cut = silhouette(thing, camera, R, p)
        hidden = 1.0 - pixels / max(int(full.sum()), 1)
        distance, bearing = hypot(thing.x, thing.y), atan2(thing.y, thing.x)
        found.append(Sight(thing, distance, bearing, hidden, cut))
    return sorted(found, key=lambda s: s.distance)


def judge(study: Study, found: tuple[Detection, ...], truth: list[Sight]) -> list[str]:
    """Count one frame; returns what went wrong, in words."""
    mistakes = []
    used: set[int] = set()
    for sight in truth:
        tally = study.groups[sight.group]
        best = match(sight, found, used)
        tally.seen += sight.counted
        if best is None:
            if sight.counted and sight.clear:
                mistakes.append(f"missed {sight.thing.label} at {sight.distance:.2f} m")
            continue
        used.add(best)
        tally.hit += sight.counted
        d = found[best]
        turn = d.bearing - sight.bearing
        error = np.array([d.distance - sight.distance, atan2(sin(turn), cos(turn))])
        nees = float(error @ np.linalg.solve(d.covariance, error))
        radius_error = d.radius - sight.thing.radius
        tally.errors.append(
            (sight.distance, *error.tolist(), nees, radius_error, radius_error / d.radius_sigma)
        )
        if nees > SURPRISE:
            mistakes.append(f"{d.label} at {sight.distance:.2f} m: NEES {nees:.0f}, off by {error}")
    for i, d in enumerate(found):
        clear, false = not (d.cut or d.occluded), i not in used
        study.reported += 1
        study.false += false
        study.reported_clear += clear
        study.false_clear += clear and false
        study.false_beacons += false and d.kind == "beacon"
        if false:
            mistakes.append(f"false {d.label} at {d.distance:.2f} m, {d.box}")
    return mistakes


def match(sight: Sight, found: tuple[Detection, ...], used: set[int]) -> int | None:
    """The detection nearest to a thing, if near enough to be of it."""
    options = []
    for i, d in enumerate(found):
        turn = d.bearing - sight.bearing
        gap = abs(d.distance - sight.distance)
        limit = max(MAX_MATCH, 0.2 * sight.distance, 3.0 * float(d.covariance[0, 0]) ** 0.5)
        aside = abs(atan2(sin(turn), cos(turn))) * sight.distance
        same = d.label == sight.thing.label and i not in used
        if same and gap < limit and aside < 0.08 * sight.distance + 0.08:
            options.append((gap + aside, i))
    return min(options)[1] if options else None


def report(study: Study) -> None:
    """Print the tables."""
    for name, tally in sorted(study.groups.items()):
        share = 100.0 * tally.hit / max(tally.seen, 1)
        print(f"{name}: found {tally.hit} of {tally.seen} = {share:.2f} %")
        print(
            "    range    n  |range error| %     bearing error deg   NEES / 2       radius"
            "\n    [m]           p50   p95   mean   rms    p95         mean   p99     rms mm  z"
        )
        rows = np.array(tally.errors)
        for metre in range(5):
            a = rows[(rows[:, 0] >= metre) & (rows[:, 0] < metre + 1)] if len(rows) else rows
            if not len(a):
                continue
            relative, turn = 100.0 * a[:, 1] / a[:, 0], np.degrees(a[:, 2])
            print(
                f"    {metre}-{metre + 1}   {len(a):5d}"
                f" {np.median(abs(relative)):6.2f}{np.percentile(abs(relative), 95):6.2f}"
                f"{relative.mean():+7.2f}"
                f"{np.sqrt(np.mean(turn**2)):7.2f}{np.percentile(abs(turn), 95):7.2f}"
                f"      {a[:, 3].mean() / 2:7.2f}{np.percentile(a[:, 3], 99) / 2:6.1f}"
                f"   {1e3 * np.sqrt(np.mean(a[:, 4] ** 2)):6.1f}"
                f"{np.sqrt(np.mean(a[:, 5] ** 2)):6.2f}"
            )
    print(
        f"reported {study.reported}, false {study.false}: precision "
        f"{100.0 * (1.0 - study.false / max(study.reported, 1)):.2f} %\n"
        f"neither cut nor occluded: {study.reported_clear}, false {study.false_clear}: precision "
        f"{100.0 * (1.0 - study.false_clear / max(study.reported_clear, 1)):.2f} %\n"
        f"false beacons: {study.false_beacons}"
    )
    print(
        f"processor time of a frame [ms]: median {np.median(study.times):.2f}, "
        f"p95 {np.percentile(study.times, 95):.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tilt-sigma", type=float, default=0.5, help="pose error [deg]")
    parser.add_argument("--light", type=float, nargs=2, default=(1.0, 1.0), help="brightness")
    parser.add_argument("--noise", type=float, default=0.0, help="pixel noise [grey levels]")
    parser.add_argument("--pictures", type=Path, help="folder for annotated frames with mistakes")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    rng = np.random.default_rng(args.seed)
    camera = PinholeCamera.from_vertical_fov(WIDTH, HEIGHT, FOV)
    detector = Detector(camera, VisionParameters())
    study = Study()
    scenes = frames(args.frames, rng, tuple(args.light), args.noise)
    for index, (image, geoms, R, p, things) in enumerate(scenes):
        pose = told(R, p, rng, radians(args.tilt_sigma))
        laps = []
        for _ in range(5):
            start = time.process_time()
            found = detector.detect(image, pose)
            laps.append(1e3 * (time.process_time() - start))
        study.times.append(min(laps))
        mistakes = judge(study, found, sights(geoms, R, p, things, camera))
        if args.pictures and mistakes:
            annotate(image, found, args.pictures / f"vision_{index:03d}.png")
            print(index, *mistakes, sep="\n    ")
    report(study)


if __name__ == "__main__":
    main()
