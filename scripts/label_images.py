"""Images of the simulated camera with the masks that `hsr8 color-table` learns from.

python scripts/label_images.py --out runs/labelled --count 8
hsr8 color-table runs/labelled/[0-9][0-9].png --out runs/colors.npz
"""

import argparse
import os
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

from hsr8.cli.color_table import MASK, mask_colors
from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.seeds import named_rng
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.camera.rendered import RenderedCamera
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.assembly import FIELD, Optics, assemble

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

LOOKS = ((-0.9, -0.3), (-0.3, -0.4), (0.3, -0.3), (0.9, -0.2))  # pan and tilt [rad]


def labelled(seed: int, pan: float, tilt: float) -> tuple[Image, Image]:
    """A noisy image of the world of `seed`, and its mask."""
    scenario = load_scenario("course")
    layout = draw_layout(scenario, seed)
    camera = scenario.camera
    fov = camera.vertical_fov
    model = assemble(load_robot("hsr8"), layout, "vision", Optics(camera.width, camera.height, fov))
    rng = named_rng(seed, "label")
    body = KinematicBody(model, load_robot("hsr8"), layout, scenario.sensors, rng)
    body.data.joint("head_pan").qpos[0] = pan
    body.data.joint("head_tilt").qpos[0] = tilt
    rendered = RenderedCamera(model, camera, rng)
    image = rendered.capture(body)()
    rendered.close()
    with mujoco.Renderer(model, camera.height, camera.width) as renderer:
        renderer.enable_segmentation_rendering()
        renderer.update_scene(body.data, camera=HEAD_CAMERA)
        geoms = renderer.render()[:, :, 0]
    mask = np.zeros((*geoms.shape, 3), np.uint8)
    paints = {f"{FIELD}paint_{name}": rgb for name, rgb in mask_colors().items()}
    for geom in np.unique(geoms[geoms >= 0]).tolist():
        material = int(model.geom_matid[geom])
        name = model.material(material).name if material >= 0 else ""
        if name in paints:
            mask[geoms == geom] = paints[name]
    return image, mask


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--count", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0, help="of the first world")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for k in range(args.count):
        image, mask = labelled(args.seed + k // len(LOOKS), *LOOKS[k % len(LOOKS)])
        cv2.imwrite(str(args.out / f"{k:02d}.png"), image[:, :, ::-1])
        cv2.imwrite(str(args.out / f"{k:02d}{MASK}"), mask[:, :, ::-1])


if __name__ == "__main__":
    main()
