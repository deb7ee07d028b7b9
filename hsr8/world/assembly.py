"""Builds the MuJoCo model of a world: robot, floor, lights, obstacles, beacons.

The same world is compiled in two qualities that share joints, sensors and state:
``vision`` is cheap and matt, for the robot's own camera; ``show`` is for people.
"""

from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from hsr8.world.layout import Beacon, Layout, Obstacle
from hsr8.world.models import models_dir
from vision.colour import COLOUR_CLASSES

Quality = Literal["vision", "show"]

FLOOR_RGB = (0.58, 0.57, 0.55)
RIM = 0.02  # half width of the line round the field [m]
MAT = 0.0005  # what is painted on the floor lies so high above it [m]
APRON = 1.2  # the floor goes on for so far beyond the field [m]


@dataclass(frozen=True, slots=True)
class Optics:
    """What rendering needs to know.

    Attributes:
        width, height: of the offscreen buffer [pixel].
        vertical_fov: of the head camera [rad].
        brightness: of all lights, 1 is normal.
    """

    width: int = 320
    height: int = 240
    vertical_fov: float = float(np.radians(70.0))
    brightness: float = 1.0


def assemble(layout: Layout, quality: Quality, optics: Optics) -> mujoco.MjModel:
    """Compile the world of `layout`."""
    spec = mujoco.MjSpec.from_file(str(models_dir() / "hsr8" / "hsr8.xml"))
    spec.modelname = "hsr8_world"
    _set_quality(spec, quality, optics)
    _add_light(spec, quality, optics.brightness)
    _add_floor(spec, layout.field_size, quality)
    _add_cameras(spec, max(layout.field_size))
    camera = spec.camera("egocentric")
    camera.fovy = float(np.degrees(optics.vertical_fov))
    camera.resolution = [optics.width, optics.height]
    for i, obstacle in enumerate(layout.static):
        _add_obstacle(spec, f"obstacle_{i:02d}", obstacle, quality)
    for i, mover in enumerate(layout.movers):
        _add_obstacle(spec, f"mover_{i:02d}", mover, quality)
    for beacon in layout.beacons:
        _add_beacon(spec, beacon, quality)
    return spec.compile()


def _set_quality(spec: mujoco.MjSpec, quality: Quality, optics: Optics) -> None:
    visual = spec.visual
    visual.global_.offwidth = optics.width
    visual.global_.offheight = optics.height
    visual.map.znear = 0.01
    visual.map.zfar = 30.0
    if quality == "vision":
        visual.quality.offsamples = 0
        visual.quality.shadowsize = 0
        visual.quality.numslices = 16
        visual.quality.numstacks = 8
    else:
        visual.quality.offsamples = 4
        visual.quality.shadowsize = 4096
        visual.quality.numslices = 40
        visual.quality.numstacks = 24
    spec.stat.extent = 1.0


def _add_light(spec: mujoco.MjSpec, quality: Quality, brightness: float) -> None:
    head = spec.visual.headlight
    head.active = 1
    head.specular = [0.0, 0.0, 0.0]
    sun = spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[0.0, 0.0, 6.0],
        dir=[0.35, 0.25, -1.0],
        specular=[0.0, 0.0, 0.0],
    )
    if quality == "vision":
        head.ambient = [0.42 * brightness] * 3
        head.diffuse = [0.30 * brightness] * 3
        sun.castshadow = False
        sun.diffuse = [0.42 * brightness] * 3
        return
    head.ambient = [0.36] * 3
    head.diffuse = [0.16] * 3
    sun.castshadow = True
    sun.diffuse = [0.62, 0.60, 0.56]
    sun.specular = [0.15, 0.15, 0.15]
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.80, 0.86, 0.92],
        rgb2=[0.93, 0.94, 0.95],
        width=256,
        height=1536,
    )


def _add_floor(spec: mujoco.MjSpec, field_size: tuple[float, float], quality: Quality) -> None:
    half = 0.5 * max(field_size)
    floor = spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[half + APRON, half + APRON, 0.05] if quality == "vision" else [0.0, 0.0, 0.05],
        rgba=[*FLOOR_RGB, 1.0],
        condim=4,
        **_CONTACT,
    )
    if quality == "vision":
        return
    texture = spec.add_texture(
        name="floor",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.62, 0.61, 0.585],
        rgb2=[0.585, 0.575, 0.55],
        width=512,
        height=512,
    )
    material = spec.add_material(name="floor", texrepeat=[2.0, 2.0], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture.name
    material.specular = 0.05
    material.reflectance = 0.04
    floor.material = "floor"
    for i, (x, y, along_x) in enumerate(
        ((0, half, True), (0, -half, True), (half, 0, False), (-half, 0, False))
    ):
        size = [half + RIM, RIM, MAT] if along_x else [RIM, half + RIM, MAT]
        spec.worldbody.add_geom(
            name=f"rim_{i}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[x, y, 0.0],
            size=size,
            rgba=[0.93, 0.93, 0.92, 1.0],
            contype=0,
            conaffinity=0,
        )


def _add_cameras(spec: mujoco.MjSpec, field_size: float) -> None:
    spec.worldbody.add_camera(
        name="top", pos=[0.0, 0.0, 1.45 * field_size], xyaxes=[0, -1, 0, 1, 0, 0], fovy=45.0
    )
    corner = 0.78 * field_size
    spec.worldbody.add_camera(
        name="corner",
        pos=[-corner, -corner, 0.62 * field_size],
        xyaxes=[0.7071, -0.7071, 0.0, 0.345, 0.345, 0.873],
        fovy=45.0,
    )


_CONTACT = {
    "contype": 3,
    "conaffinity": 1,
    "friction": [0.8, 0.01, 0.001],
    "solref": [0.01, 1.0],
    "solimp": [0.9, 0.95, 0.001, 0.5, 2.0],
}


def _paint(spec: mujoco.MjSpec, colour: str, quality: Quality) -> str:
    """Name of the material of a colour class, made when first asked for."""
    name = f"paint_{colour}"
    if spec.material(name) is None:
        material = spec.add_material(name=name, rgba=[*COLOUR_CLASSES[colour].rgb, 1.0])
        material.specular = 0.0 if quality == "vision" else 0.12
        material.shininess = 0.2
        material.reflectance = 0.0
    return name


def _add_obstacle(spec: mujoco.MjSpec, name: str, obstacle: Obstacle, quality: Quality) -> None:
    body = spec.worldbody.add_body(
        name=name,
        pos=[*obstacle.position, 0.5 * obstacle.height],
        mocap=obstacle.motion is not None,
    )
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[obstacle.radius, 0.5 * obstacle.height, 0.0],
        material=_paint(spec, obstacle.colour, quality),
        **_CONTACT,
    )


def _add_beacon(spec: mujoco.MjSpec, beacon: Beacon, quality: Quality) -> None:
    quarter = 0.25 * beacon.height
    body = spec.worldbody.add_body(name=f"beacon_{beacon.top}_{beacon.bottom}")
    body.pos = [*beacon.position, 0.0]
    for half, colour, z in (("bottom", beacon.bottom, quarter), ("top", beacon.top, 3 * quarter)):
        body.add_geom(
            name=f"beacon_{beacon.top}_{beacon.bottom}_{half}",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=[0.0, 0.0, z],
            size=[beacon.radius, quarter, 0.0],
            material=_paint(spec, colour, quality),
            **_CONTACT,
        )
