"""Robot as people and as its own camera see it.

People see its visual shapes, with fewer triangles: a mesh file can have a million, which take
a second per image. The head camera sees the shapes that collide, as does its self mask.
"""

from collections import Counter
from functools import lru_cache
from math import sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.meshes import Array, Triangles, decimated
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.model.normal_form import COLLISION_GROUP
from hsr8.robots.model.posed_shapes import robot_height
from hsr8.robots.parts.skeleton import Posed, matrix_of

VISUAL_GROUPS = (0, 1, 2)
"""Groups of geoms that MuJoCo draws; those from 3 are collision shapes."""
SHOWN_GROUP = 2
"""Group of geoms that are drawn in the place of others."""
HIDDEN_GROUP = 5
"""Group of geoms that MuJoCo does not draw."""
CELL = 1.0 / 220.0  # side of the cells in which vertices are merged, in leg lengths [1]
MAX_TRIANGLES = 100_000  # of a robot for people, reached within `MAX_ROUNDS` or nearly
MIN_TRIANGLES = 400  # of a mesh that is simplified
MAX_ROUNDS = 4  # of larger and larger cells
MAX_SATURATION = 0.3  # of the colours of a robot in its camera [1]
BRIGHTNESS = np.array([0.299, 0.587, 0.114], np.float32)  # of red, green and blue [1]

TETRAHEDRON: tuple[Array, Triangles] = (  # stand-in for a mesh that is not drawn
    np.vstack([np.zeros(3), 1e-3 * np.eye(3)]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)

_MESH = mujoco.mjtGeom.mjGEOM_MESH


@lru_cache(maxsize=8)
def visual_model(robot: LoadedRobot) -> mujoco.MjModel:
    """Return the compiled model of `visual_spec`, without a world."""
    return visual_spec(robot).compile()


def stature(robot: LoadedRobot) -> float:
    """Return the height of a robot's highest shape in its ready posture above the floor [m]."""
    angles = dict(zip(robot.model.names, robot.model.ready.tolist(), strict=True))
    return robot_height(Posed.at(visual_model(robot), {**robot.held, **angles}, robot.height))


def visual_spec(robot: LoadedRobot) -> mujoco.MjSpec:
    """Return a copy of a robot for people: visual shapes, collision shapes where there are none."""
    return _visual(robot).copy()


@lru_cache(maxsize=8)
def _visual(robot: LoadedRobot) -> mujoco.MjSpec:
    spec = robot.spec.copy()
    for body in spec.bodies[1:]:
        if not any(geom.group in VISUAL_GROUPS for geom in body.geoms):
            for geom in body.geoms:
                geom.group = SHOWN_GROUP if _solid(geom) else geom.group
    if robot.has_meshes:
        _simplify(spec, CELL * robot.model.measures().leg)
    return spec


def camera_spec(robot: LoadedRobot) -> mujoco.MjSpec:
    """Return a copy of a robot for its own camera: solid shapes in the place of meshes, pale.

    Saturated colours are reserved for obstacles and beacons.
    """
    spec = robot.spec.copy()
    solid = {geom.meshname for geom in spec.geoms if geom.type == _MESH and _solid(geom)}
    for geom in spec.geoms:
        if geom.type == _MESH and not _solid(geom):
            geom.group = HIDDEN_GROUP
        elif _solid(geom) and robot.has_meshes and geom.group == COLLISION_GROUP:
            geom.group = SHOWN_GROUP
    for mesh in spec.meshes:
        if mesh.name not in solid:
            _set_mesh(mesh, *TETRAHEDRON)
    for part in (*spec.materials, *(g for g in spec.geoms if g.group in VISUAL_GROUPS)):
        part.rgba = _pale(np.array(part.rgba))
    return spec


def _solid(geom: mujoco.MjsGeom) -> bool:
    return bool(geom.contype or geom.conaffinity)


def _pale(rgba: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return a colour, or grey of equal brightness if the colour is saturated (4,)."""
    high, low = rgba[:3].max(), rgba[:3].min()
    if high - low > MAX_SATURATION * high:
        rgba[:3] = rgba[:3] @ BRIGHTNESS
    return rgba


def _simplify(spec: mujoco.MjSpec, cell: float) -> None:
    """Simplify the drawn meshes of a robot.

    Args:
        spec: specification, changed in place.
        cell: side of the cells, larger for a robot of many triangles [m].
    """
    model = spec.copy().compile()
    drawn = np.isin(model.geom_group, VISUAL_GROUPS) & (model.geom_type == int(_MESH))
    textured = np.append((model.mat_texid >= 0).any(axis=1), False)[model.geom_matid]
    fixed = set(model.geom_dataid[drawn & textured].tolist())
    counts = Counter(int(mesh) for mesh in model.geom_dataid[drawn] if mesh not in fixed)
    meshes: dict[int, tuple[Array, Triangles]] = {}
    for _ in range(MAX_ROUNDS):
        meshes = {mesh: _simple(model, mesh, cell) for mesh in counts}
        total = sum(count * len(meshes[mesh][1]) for mesh, count in counts.items())
        if total <= MAX_TRIANGLES:
            break
        cell *= 1.05 * sqrt(total / MAX_TRIANGLES)
    for mesh in spec.meshes:
        if mesh.id not in fixed:
            _set_mesh(mesh, *meshes.get(mesh.id, TETRAHEDRON))


def _simple(model: mujoco.MjModel, number: int, cell: float) -> tuple[Array, Triangles]:
    """Return vertices (n, 3) [m] and triangles (m, 3) of a simplified mesh, in its file's frame."""
    mesh = model.mesh(number)
    first, face = int(mesh.vertadr[0]), int(mesh.faceadr[0])
    vertices = model.mesh_vert[first : first + int(mesh.vertnum[0])].astype(np.float64)
    triangles = model.mesh_face[face : face + int(mesh.facenum[0])].astype(np.int64)
    if len(triangles) >= MIN_TRIANGLES:
        vertices, triangles = decimated(vertices, triangles, cell)
    rotation = matrix_of(model.mesh_quat[number])
    return vertices @ rotation.T + model.mesh_pos[number], triangles


def _set_mesh(mesh: mujoco.MjsMesh, vertices: Array, triangles: Triangles) -> None:
    """Replace the file of a mesh by vertices (n, 3) [m] and triangles (m, 3)."""
    mesh.file, mesh.content_type = "", ""
    mesh.scale, mesh.refpos, mesh.refquat = np.ones(3), np.zeros(3), (1.0, 0.0, 0.0, 0.0)
    mesh.usernormal, mesh.usertexcoord = [], []
    mesh.userfacenormal, mesh.userfacetexcoord = [], []
    mesh.uservert, mesh.userface = vertices.ravel(), triangles.ravel()
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
