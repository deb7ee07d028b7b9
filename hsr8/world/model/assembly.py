"""Assembly of the MuJoCo model of a world: robot, floor, lights, obstacles, beacons.

A world is compiled in two qualities that share joints, sensors and state: ``vision``, matt and
fast, for the camera of the robot; ``show`` for people. Parts that do not depend on the layout are
in ``models/field/``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot
from typing import Any, Literal

import mujoco
import numpy as np

from hsr8.robots.file.files import models_dir, reading_models
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.robots.shown import camera_spec, visual_spec
from hsr8.scenario.fault import Bump
from hsr8.world.field.layout import Beacon, Layout, Obstacle
from vision.color import COLOR_CLASSES

Quality = Literal["vision", "show"]

FIELD = "field/"
"""Prefix of the names of all parts of the field, which those of a robot do not have."""

# Lengths are those in a world of scale 1.
BORDER = 0.02  # half width of the line around the field [m]
PAINT_HEIGHT = 0.0005  # of painted lines above the floor [m]
STRIPE = 0.010  # half height of the stripe that marks a mover, for people only [m]
SHOW_GAMMA = (
    0.7  # exponent of colours for people; those for vision are deeper and easier to separate
)
APRON = 1.5  # distance of the walls from the border of the field [m]
WALL_HEIGHT = 4.0  # [m]
SHADOW_SIZE = 2048  # resolution of the shadow map [texel]
REFERENCE_SIDE = 5.0  # of the field that the lights of models/field/ are made for [m]

_SOLID: dict[str, Any] = {
    "contype": 3,
    "conaffinity": 1,
    "friction": [0.8, 0.01, 0.001],
    "solref": [0.01, 1.0],
    "solimp": [0.9, 0.95, 0.001, 0.5, 2.0],
}
_VISUAL: dict[str, Any] = {"contype": 0, "conaffinity": 0, "mass": 0.0}


@dataclass(frozen=True, slots=True)
class Optics:
    """Rendering options of a model.

    Attributes:
        width, height: width and height of the offscreen buffer [pixel].
        vertical_fov: vertical field of view of the head camera [rad].
        brightness: factor on all lights [1].
        shadows: whether the camera of the robot sees cast shadows.
    """

    width: int = 320
    height: int = 240
    vertical_fov: float = float(np.radians(70.0))
    brightness: float = 1.0
    shadows: bool = False


@reading_models()
def assemble(
    robot: LoadedRobot, layout: Layout, quality: Quality, optics: Optics
) -> mujoco.MjModel:
    """Compile the world of `layout` with a robot.

    Static obstacles are bodies ``field/obstacle_00`` ..., movers are mocap bodies
    ``field/mover_00`` ..., beacons are ``field/beacon_<top>_<bottom>``, bumps are geoms
    ``field/bump_00`` ... of the world. The cameras ``field/top`` and ``field/corner`` are for
    people. The names of the robot have no prefix.

    Raises:
        ModelError: a model file is invalid.
    """
    spec = mujoco.MjSpec.from_file(str(models_dir() / "field" / f"{quality}.xml"))
    spec.modelname = f"hsr8_{quality}"
    spec.option.timestep = robot.spec.option.timestep
    _attach(spec, robot, quality)
    spec.visual.global_.offwidth = optics.width
    spec.visual.global_.offheight = optics.height
    spec.visual.map.zfar *= max(1.0, layout.scale)
    _set_lights(spec, optics.brightness, max(layout.field_size))
    if quality == "vision" and optics.shadows:
        _cast_shadows(spec, max(layout.field_size), layout.scale)
    camera = _part(spec.camera, HEAD_CAMERA)
    camera.fovy = float(np.degrees(optics.vertical_fov))
    camera.resolution = [optics.width, optics.height]
    _add_border(spec, layout.field_size, layout.scale)
    if quality == "vision":
        _add_room(spec, layout.field_size, layout.scale)
    _add_cameras(spec, layout.field_size)
    for i, obstacle in enumerate(layout.static):
        _add_obstacle(spec, f"{FIELD}obstacle_{i:02d}", obstacle, quality, layout.scale)
    for i, mover in enumerate(layout.movers):
        _add_obstacle(spec, f"{FIELD}mover_{i:02d}", mover, quality, layout.scale)
    for beacon in layout.beacons:
        _add_beacon(spec, beacon, quality)
    for i, bump in enumerate(layout.bumps):
        _add_bump(spec, f"{FIELD}bump_{i:02d}", bump)
    return spec.compile()


def _attach(spec: mujoco.MjSpec, robot: LoadedRobot, quality: Quality) -> None:
    """Add the robot in the shapes of a quality."""
    shapes = camera_spec(robot) if quality == "vision" else visual_spec(robot)
    spec.attach(shapes, prefix="", frame=spec.worldbody.add_frame())


def _part(find: Callable[[str], Any], name: str) -> Any:
    part = find(name)
    if part is None:
        raise ValueError(f"{find.__name__} {name!r} is missing")
    return part


def _set_lights(spec: mujoco.MjSpec, brightness: float, side: float) -> None:
    """Scale the lights, and raise them over a large field."""
    head = spec.visual.headlight
    head.ambient = brightness * np.asarray(head.ambient)
    head.diffuse = brightness * np.asarray(head.diffuse)
    for light in spec.lights:
        light.diffuse = brightness * np.asarray(light.diffuse)
        light.pos = max(1.0, side / REFERENCE_SIDE) * np.asarray(light.pos)


def _cast_shadows(spec: mujoco.MjSpec, side: float, scale: float) -> None:
    """Make the sun cast shadows on the whole field."""
    spec.visual.quality.shadowsize = SHADOW_SIZE
    spec.visual.map.shadowclip = (0.5 * side + APRON * scale) / spec.stat.extent
    _part(spec.light, f"{FIELD}sun").castshadow = True


def _add_border(spec: mujoco.MjSpec, field_size: tuple[float, float], scale: float) -> None:
    """Add the line around the field."""
    x, y = (0.5 * side for side in field_size)
    half, paint = BORDER * scale, PAINT_HEIGHT * scale
    halves = (half, y + half), (x - half, half)
    _add_frame(spec, "rim", (x, y), halves, z=0.0, half_height=paint, material=f"{FIELD}line")


def _add_room(spec: mujoco.MjSpec, field_size: tuple[float, float], scale: float) -> None:
    """Add plain walls around the field, so that the robot does not see empty space.

    The floor is rendered inside them only: an infinite plane costs more than the rest of an
    image. For contacts every plane is infinite.
    """
    x, y = (0.5 * side + APRON * scale for side in field_size)
    _part(spec.geom, f"{FIELD}floor").size = [x, y, 1.0]
    z = 0.5 * WALL_HEIGHT * scale
    halves = (0.01 * scale, y), (x, 0.01 * scale)
    _add_frame(spec, "wall", (x, y), halves, z=z, half_height=z, material=f"{FIELD}wall")


def _add_frame(
    spec: mujoco.MjSpec,
    name: str,
    distance: tuple[float, float],
    halves: tuple[tuple[float, float], tuple[float, float]],
    *,
    z: float,
    half_height: float,
    material: str,
) -> None:
    """Add four boxes around the origin at some `distance` along x and y [m].

    `halves` are the half sides of those in front and back, and of those left and right [m].
    """
    x, y = distance
    for side, position, half in (
        ("front", (x, 0.0), halves[0]),
        ("back", (-x, 0.0), halves[0]),
        ("left", (0.0, y), halves[1]),
        ("right", (0.0, -y), halves[1]),
    ):
        spec.worldbody.add_geom(
            name=f"{FIELD}{name}_{side}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[*position, z],
            size=[*half, half_height],
            material=material,
            **_VISUAL,
        )


def _add_cameras(spec: mujoco.MjSpec, field_size: tuple[float, float]) -> None:
    size = max(field_size)
    spec.worldbody.add_camera(
        name=f"{FIELD}top", pos=[0.0, 0.0, 1.55 * size], xyaxes=[0, -1, 0, 1, 0, 0], fovy=45.0
    )
    # From a corner, towards the centre of the field.
    position = np.array([-0.80, -0.80, 0.62]) * size
    away = position / np.linalg.norm(position)
    right = np.array([-away[1], away[0], 0.0]) / hypot(away[0], away[1])
    spec.worldbody.add_camera(
        name=f"{FIELD}corner", pos=position, xyaxes=[*right, *np.cross(away, right)], fovy=40.0
    )


def _paint(spec: mujoco.MjSpec, color: str, quality: Quality) -> str:
    """Return the name of the material of a colour class, which is created at first use."""
    name = f"{FIELD}paint_{color}"
    if spec.material(name) is None:
        rgb = np.asarray(COLOR_CLASSES[color].rgb)
        if quality == "show":
            rgb = rgb**SHOW_GAMMA
        material = spec.add_material(name=name, rgba=[*rgb, 1.0])
        material.specular = 0.0 if quality == "vision" else 0.25
        material.shininess = 0.0 if quality == "vision" else 0.4
        material.reflectance = 0.0
    return name


def _add_obstacle(
    spec: mujoco.MjSpec, name: str, obstacle: Obstacle, quality: Quality, scale: float
) -> None:
    is_mover = obstacle.motion is not None
    body = spec.worldbody.add_body(
        name=name, pos=[*obstacle.position, 0.5 * obstacle.height], mocap=is_mover
    )
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[obstacle.radius, 0.5 * obstacle.height, 0.0],
        material=_paint(spec, obstacle.color, quality),
        **_SOLID,
    )
    if is_mover and quality == "show":
        stripe = STRIPE * scale
        body.add_geom(
            name=f"{name}_stripe",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=[0.0, 0.0, 0.5 * obstacle.height - 4.0 * stripe],
            size=[obstacle.radius + 0.001 * scale, stripe, 0.0],
            material=f"{FIELD}stripe",
            **_VISUAL,
        )


def _add_beacon(spec: mujoco.MjSpec, beacon: Beacon, quality: Quality) -> None:
    quarter = 0.25 * beacon.height
    name = f"{FIELD}beacon_{beacon.top}_{beacon.bottom}"
    body = spec.worldbody.add_body(name=name, pos=[*beacon.position, 0.0])
    for half, color, z in (("bottom", beacon.bottom, quarter), ("top", beacon.top, 3 * quarter)):
        body.add_geom(
            name=f"{name}_{half}",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=[0.0, 0.0, z],
            size=[beacon.radius, quarter, 0.0],
            material=_paint(spec, color, quality),
            **_SOLID,
        )


def _add_bump(spec: mujoco.MjSpec, name: str, bump: Bump) -> None:
    """Add a disc on the floor in the colour of the lines; `WorldFaults` switches its contacts."""
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        pos=[*bump.position, 0.0],
        size=[bump.radius, bump.magnitude, 0.0],
        material=f"{FIELD}line",
        condim=4,
        **_SOLID,
    )
