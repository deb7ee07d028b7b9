"""How well the detector sees crowded random scenes, against segmentation truth.

    python scripts/vision_study.py --frames 1000 --seed 1 --images runs

Every frame draws 16 obstacles and 6 beacons around a camera at walking height with a
random gaze and a swaying body; the detector gets a pose with random errors of the
expected size.
"""

import argparse
import os
import time
from collections.abc import Iterator
from math import atan2, hypot, radians
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

from vision.camera import CameraPose, PinholeCamera
from vision.color import COLOR_CLASSES
from vision.detection import Detection
from vision.detector import Detector
from vision.parameters import VisionParameters

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray
from vision_score import Study
from vision_truth import Array, Target, rotation_of, sights

WIDTH, HEIGHT, FOV = 320, 240, radians(70.0)
CAMERA_HEIGHT = 0.47
OBSTACLES = tuple(n for n, c in COLOR_CLASSES.items() if c.kind == "obstacle")
BEACONS = tuple(n for n, c in COLOR_CLASSES.items() if c.kind == "beacon")
NAMES = tuple(f"{a}/{b}" for a in BEACONS for b in BEACONS if a != b)
FIELD = 2.5  # half side of the field [m]
RIM = 2.9  # half side of the square the beacons stand on [m]


def world(rng: np.random.Generator, light: float) -> tuple[mujoco.MjModel, list[Target]]:
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

    targets: list[Target] = []
    robot = rng.uniform(-1.8, 1.8, 2)

    def post(at: tuple[float, float], radius: float, span: tuple[float, float], color: str) -> int:
        geom = root.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=(*at, 0.5 * (span[0] + span[1])),
            size=(radius, 0.5 * (span[1] - span[0]), 0),
            rgba=(*COLOR_CLASSES[color].rgb, 1.0),
        )
        geom.name = f"g{len(root.geoms)}"
        return len(root.geoms) - 1

    while len(targets) < 16:
        x, y = (rng.uniform(-FIELD, FIELD, 2) - robot).tolist()
        radius = rng.uniform(0.05, 0.12)
        clear = all(hypot(x - t.x, y - t.y) > radius + t.radius + 0.05 for t in targets)
        if hypot(x, y) < radius + 0.2 or not clear:
            continue
        color = OBSTACLES[rng.integers(len(OBSTACLES))]
        geom = post((x, y), radius, (0.0, 0.30), color)
        targets.append(Target("obstacle", color, x, y, radius, 0.30, (geom,)))
    corners = [(a, b) for a in (-RIM, RIM) for b in (-RIM, 0.0, RIM)]
    for (x0, y0), i in zip(corners, rng.permutation(len(NAMES)).tolist(), strict=True):
        x, y = x0 - robot[0], y0 - robot[1]
        top, bottom = NAMES[i].split("/")
        geoms = (
            post((x, y), 0.05, (0.0, 0.30), bottom),
            post((x, y), 0.05, (0.30, 0.60), top),
        )
        targets.append(Target("beacon", NAMES[i], x, y, 0.05, 0.60, geoms))
    return spec.compile(), targets


def frames(
    count: int, rng: np.random.Generator, light: tuple[float, float], noise: float
) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.int32], Array, Array, list[Target]]]:
    """Image, geom of each pixel, true rotation and position of the camera, and targets."""
    for _ in range(count):
        model, targets = world(rng, rng.uniform(*light))
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
        yield image, geoms, R, p, targets


LEVEL = rotation_of(0.0, 0.0, 0.0)


def perturbed(R: Array, p: Array, rng: np.random.Generator, sigma: float) -> CameraPose:
    """Return the pose with errors of the expected size."""
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


def annotate(image: NDArray[np.uint8], detections: tuple[Detection, ...], path: Path) -> None:
    """Write the image, three times as large, with its detections."""
    big = cv2.resize(image[:, :, ::-1], None, fx=3, fy=3, interpolation=cv2.INTER_NEAREST)
    for d in detections:
        x0, y0, x1, y1 = (3 * b for b in d.box)
        cv2.rectangle(big, (x0, y0), (x1, y1), (255, 255, 255), 1)
        flags = ("c" if d.cut else "") + ("o" if d.occluded else "")
        sigma = float(d.covariance[0, 0]) ** 0.5
        text = f"{d.label[:3]} {d.distance:.2f}({sigma:.2f}) r{d.radius:.2f}{flags}"
        cv2.putText(
            big, text, (x0, max(12, y0 - 3)), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (255, 255, 255)
        )
    cv2.imwrite(str(path), big)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tilt-sigma", type=float, default=0.5, help="pose error [deg]")
    parser.add_argument("--light", type=float, nargs=2, default=(1.0, 1.0), help="brightness")
    parser.add_argument("--noise", type=float, default=0.0, help="pixel noise [grey levels]")
    parser.add_argument("--images", type=Path, help="folder for annotated frames with mistakes")
    args = parser.parse_args()
    cv2.setNumThreads(1)
    rng = np.random.default_rng(args.seed)
    camera = PinholeCamera.from_vertical_fov(WIDTH, HEIGHT, FOV)
    detector = Detector(camera, VisionParameters())
    study = Study()
    scenes = frames(args.frames, rng, tuple(args.light), args.noise)
    for index, (image, geoms, R, p, targets) in enumerate(scenes):
        pose = perturbed(R, p, rng, radians(args.tilt_sigma))
        laps = []
        for _ in range(5):
            start = time.process_time()
            detections = detector.detect(image, pose)
            laps.append(1e3 * (time.process_time() - start))
        study.times.append(min(laps))
        mistakes = study.judge(detections, sights(geoms, R, p, targets, camera))
        if args.images and mistakes:
            annotate(image, detections, args.images / f"vision_{index:03d}.png")
            print(index, *mistakes, sep="\n    ")
    study.report()


if __name__ == "__main__":
    main()
