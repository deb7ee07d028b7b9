"""How well the detector sees: random scenes rendered by MuJoCo against segmentation truth.

    python scripts/vision_study.py --frames 400 --seed 1 --pictures /tmp

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


@dataclass
class Tally:
    """Counts and errors of the whole study."""

    seen: int = 0
    hit: int = 0
    reported: int = 0
    true: int = 0
    wrong_name: int = 0
    errors: list[tuple[float, ...]] = field(default_factory=list)


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

    def post(x: float, y: float, radius: float, low: float, high: float, colour: str) -> int:
        geom = root.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=(x, y, 0.5 * (low + high)),
            size=(radius, 0.5 * (high - low), 0),
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
        geom = post(x, y, radius, 0.0, 0.30, colour)
        things.append(Thing("obstacle", colour, x, y, radius, 0.30, (geom,)))
    corners = [(a, b) for a in (-RIM, RIM) for b in (-RIM, 0.0, RIM)]
    for (x0, y0), i in zip(corners, rng.permutation(len(NAMES)).tolist(), strict=True):
        x, y = x0 - robot[0], y0 - robot[1]
        top, bottom = NAMES[i].split("/")
        geoms = (post(x, y, 0.05, 0.0, 0.30, bottom), post(x, y, 0.05, 0.30, 0.60, top))
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
        text = f"{d.label[:3]} {d.distance:.2f}({d.covariance[0, 0] ** 0.5:.2f}) r{d.radius:.2f}{flags}"
        cv2.putText(
            big, text, (x0, max(12, y0 - 3)), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (255, 255, 255)
        )
    cv2.imwrite(str(path), big)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tilt-sigma", type=float, default=0.5, help="pose error [deg]")
    parser.add_argument("--light", type=float, nargs=2, default=(1.0, 1.0))
    parser.add_argument("--noise", type=float, default=0.0, help="pixel noise [grey levels]")
    parser.add_argument("--pictures", type=Path, default=None)
    parser.add_argument("--bad", action="store_true", help="pictures of frames with mistakes only")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    rng = np.random.default_rng(args.seed)
    camera = PinholeCamera.from_vertical_fov(WIDTH, HEIGHT, FOV)
    detector = Detector(camera, VisionParameters())
    clear, partial, beacons = Tally(), Tally(), Tally()
    precision = Tally()
    times, pictures = [], 0
    scenes = frames(args.frames, rng, tuple(args.light), args.noise)
    for index, (image, geoms, R, p, things) in enumerate(scenes):
        pose = told(R, p, rng, radians(args.tilt_sigma))
        detector.detect(image, pose)
        start = time.process_time()
        found = detector.detect(image, pose)
        times.append(1e3 * (time.process_time() - start))
        mistakes = judge(found, geoms, R, p, things, camera, (clear, partial, beacons, precision))
        if args.pictures and pictures < 30 and (mistakes or not args.bad):
            annotate(image, found, args.pictures / f"vision_{index:03d}.png")
            print(index, *mistakes, sep="\n    ")
            pictures += 1
    report(clear, partial, beacons, precision, times)


def judge(found, geoms, R, p, things, camera, tallies) -> list[str]:
    """Compare one frame's detections with the truth; returns what went wrong, in words."""
    clear, partial, beacons, precision = tallies
    mistakes = []
    places = [(d, d.distance * cos(d.bearing), d.distance * sin(d.bearing)) for d in found]
    used: set[int] = set()
    visible = []
    for thing in things:
        pixels = int(np.isin(geoms, thing.geoms).sum())
        if pixels < 12:
            continue
        full, cut = silhouette(thing, camera, R, p)
        hidden = 1.0 - pixels / max(int(full.sum()), 1)
        distance = hypot(thing.x, thing.y)
        visible.append((distance, thing, hidden, cut, pixels))
    for distance, thing, hidden, cut, pixels in sorted(visible, key=lambda v: v[0]):
        options = [
            (hypot(x - thing.x, y - thing.y), i)
            for i, (d, x, y) in enumerate(places)
            if i not in used
            and d.label == thing.label
            and abs(d.bearing - atan2(thing.y, thing.x)) < 0.08 + 0.08 / distance
        ]
        gap, best = min(options, default=(9.0, -1))
        limit = max(MAX_MATCH, 0.2 * distance)
        if best >= 0:
            limit = max(limit, 3.0 * places[best][0].covariance[0, 0] ** 0.5)
        matched = gap < limit
        if matched:
            used.add(best)
        unhidden = hidden < 0.04 and not cut
        inside = 0.3 <= distance <= 2.5
        tally = beacons if thing.kind == "beacon" else clear if unhidden else partial
        counted = unhidden and distance <= 5.0 if thing.kind == "beacon" else inside
        if counted:
            tally.seen += 1
            tally.hit += matched
            if not matched and unhidden:
                mistakes.append(
                    f"missed {thing.label} at {distance:.2f} ({pixels} px, hidden {hidden:.2f})"
                )
        if matched:
            d = places[best][0]
            bearing = d.bearing - atan2(thing.y, thing.x)
            e = np.array([d.distance - distance, atan2(sin(bearing), cos(bearing))])
            nees = float(e @ np.linalg.solve(d.covariance, e))
            row = (
                distance,
                e[0],
                e[1],
                nees,
                d.radius - thing.radius,
                d.radius_sigma,
                float(d.occluded),
                float(d.cut),
                hidden,
            )
            tally.errors.append(row)
            if nees > 20:
                mistakes.append(
                    f"{thing.label} at {distance:.2f} nees {nees:.0f} e {e} sd "
                    f"{np.sqrt(np.diag(d.covariance))} hidden {hidden:.2f} {cut}"
                )
    for i, (d, x, y) in enumerate(places):
        precision.reported += 1
        if i in used:
            precision.true += 1
        else:
            mistakes.append(
                f"false {d.label} at {d.distance:.2f} {d.bearing:.2f} sd {d.covariance[0, 0] ** 0.5:.2f} {d.cut} {d.occluded} {d.box}"
            )
            precision.wrong_name += d.kind == "beacon"
            if not (d.cut or d.occluded):
                precision.seen += 1
        if not (d.cut or d.occluded):
            precision.hit += 1
    return mistakes


def report(clear, partial, beacons, precision, times) -> None:
    def line(name: str, t: Tally) -> None:
        share = 100.0 * t.hit / max(t.seen, 1)
        print(f"{name}: found {t.hit}/{t.seen} = {share:.2f} %")
        bins = defaultdict(list)
        for row in t.errors:
            bins[min(int(row[0]), 4)].append(row)
        for b, rows in sorted(bins.items()):
            a = np.array(rows)
            r = 100.0 * np.abs(a[:, 1]) / a[:, 0]
            n = a[:, 3]
            print(
                f"  {b}-{b + 1} m: n {len(a):4d}  range [%] p50 {np.median(r):.2f} p95 "
                f"{np.percentile(r, 95):.2f} mean {100 * np.mean(a[:, 1] / a[:, 0]):+.2f}  bearing [deg] rms "
                f"{np.degrees(np.sqrt(np.mean(a[:, 2] ** 2))):.2f} p95 "
                f"{np.degrees(np.percentile(np.abs(a[:, 2]), 95)):.2f}  NEES/2 mean "
                f"{n.mean() / 2:.2f} median {np.median(n) / 2:.2f} p99 {np.percentile(n, 99) / 2:.1f}  "
                f"radius err [mm] {1e3 * a[:, 4].mean():+.1f} rms {1e3 * np.sqrt(np.mean(a[:, 4] ** 2)):.1f} "
                f"z {np.sqrt(np.mean((a[:, 4] / a[:, 5]) ** 2)):.2f}"
            )

    line("clear obstacles 0.3-2.5 m", clear)
    line("partly hidden or cut obstacles", partial)
    line("beacons", beacons)
    print(
        f"reported {precision.reported}, true {precision.true} = "
        f"{100.0 * precision.true / max(precision.reported, 1):.2f} %; clear reported "
        f"{precision.hit}, false {precision.seen} "
        f"(precision {100.0 * (1 - precision.seen / max(precision.hit, 1)):.2f} %); "
        f"false beacons {precision.wrong_name}"
    )
    print(
        f"time per frame [ms]: median {np.median(times):.2f} p95 {np.percentile(times, 95):.2f} "
        f"mean {np.mean(times):.2f}"
    )


if __name__ == "__main__":
    main()
