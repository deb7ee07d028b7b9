"""Images of the simulated camera with the masks that `hsr8 color-table` learns from."""

import mujoco
import numpy as np

from hsr8.cli.color_table import mask_colors
from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from hsr8.seeds import named_rng
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.camera.rendered import RenderedCamera
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.assembly import FIELD, Optics, assemble


def labelled(seed, pan, tilt):
    """Return a noisy image of `course` and its mask, for a pan and tilt of the camera [rad]."""
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
