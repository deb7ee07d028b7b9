"""Shapes of a URDF robot: points of the feet for the soles, and geoms of its bodies."""

from collections.abc import Iterable, Mapping
from math import pi
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError
from hsr8.robots.mesh_points import find_mesh, is_binary_stl, read_mesh
from hsr8.robots.urdf_elements import Shape

Array = NDArray[np.float64]

VISUAL: dict[str, Any] = {"group": 2, "contype": 0, "conaffinity": 0}
COLLISION: dict[str, Any] = {"group": 3, "contype": 0, "conaffinity": 2}
GREY = (0.75, 0.75, 0.77, 1.0)
RIM_POINTS = 24
_TYPES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
}


def quaternion(pose: NDArray[Any]) -> Array:
    """Return the rotation of a pose as a quaternion w-x-y-z, shape (4,)."""
    return Rotation.from_matrix(pose[:3, :3]).as_quat(scalar_first=True)


def shape_points(shape: Shape, pose: Array, file: Path | None) -> Array:
    """Points on the underside of a shape.

    Args:
        shape: any kind.
        pose: in a frame whose z axis is up, shape (4, 4) [m].
        file: of the mesh, if the shape is one.

    Returns:
        Corners, rim points, vertices, or the lowest points of spheres in that frame, shape (n, 3)
        [m].
    """
    radius = 0.0
    if shape.kind == "box":
        corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        points = 0.5 * corners * shape.size
    elif shape.kind == "sphere":
        radius = shape.size[0]
        points = np.zeros((1, 3))
    elif shape.kind == "capsule":
        radius = shape.size[0]
        points = np.array([(0.0, 0.0, s * 0.5 * shape.size[1]) for s in (-1, 1)])
    elif shape.kind == "cylinder":
        rim, half = np.linspace(0.0, 2.0 * pi, RIM_POINTS, endpoint=False), 0.5 * shape.size[1]
        circle = shape.size[0] * np.column_stack([np.cos(rim), np.sin(rim)])
        points = np.vstack([np.column_stack([circle, np.full(len(rim), s)]) for s in (-half, half)])
    else:
        points = np.empty((0, 3)) if file is None else read_mesh(file)[0] * shape.size
    return points @ pose[:3, :3].T + pose[:3, 3] - (0.0, 0.0, radius)


class GeomBuilder:
    """Geoms of one model; every mesh file becomes one asset, a missing one is dropped with a note.

    Attributes:
        missing: URIs of meshes that were not found, in order.
        unreadable: messages of meshes that were found but cannot be used.
    """

    def __init__(self, spec: mujoco.MjSpec, urdf: Path, packages: Mapping[str, Path]) -> None:
        self._spec = spec
        self._urdf = urdf
        self._packages = packages
        self._assets: dict[tuple[str, tuple[float, ...]], str | None] = {}
        self.missing: dict[str, None] = {}
        self.unreadable: list[str] = []

    def file(self, shape: Shape) -> Path | None:
        """Return the file of the mesh of a shape, if it is one and the file exists."""
        return find_mesh(shape.mesh, self._urdf, self._packages) if shape.mesh else None

    def add(self, body: Any, shapes: Iterable[Shape], pose: Array, role: Mapping[str, Any]) -> None:
        """Add shapes to a body.

        Args:
            body: of the model.
            shapes: of one link.
            pose: of the link in the body, shape (4, 4) [m].
            role: keys of all geoms: group and contact bits.
        """
        for shape in shapes:
            at = pose @ shape.pose
            keys = dict(role, pos=at[:3, 3], quat=quaternion(at), rgba=shape.rgba or GREY, mass=0.0)
            if shape.kind == "mesh":
                asset = self._asset(shape)
                if asset is not None:
                    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=asset, **keys)
            else:
                body.add_geom(type=_TYPES[shape.kind], size=_half_size(shape), **keys)

    def notes(self) -> list[str]:
        """Notes on meshes that are not in the model."""
        notes = list(self.unreadable)
        if self.missing:
            notes.append(
                f"{len(self.missing)} meshes not found, first {next(iter(self.missing))}: their "
                "shapes are left out; `packages` states where a package is"
            )
        return notes

    def drop_invalid_meshes(self) -> None:
        """Drop meshes that MuJoCo cannot compile, each with a note."""
        for name in [name for name in self._assets.values() if name is not None]:
            geoms = [geom for geom in self._spec.geoms if geom.meshname == name]
            mesh = self._spec.mesh(name)
            trial = mujoco.MjSpec()
            trial.add_mesh(**_mesh_keys(mesh))
            solid = any(geom.conaffinity for geom in geoms)
            trial.worldbody.add_geom(
                type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, contype=int(solid)
            )
            try:
                trial.compile()
            except ValueError as error:
                self.unreadable.append(f"mesh {mesh.file or name} left out: {_one_line(error)}")
                for element in (*geoms, mesh):
                    self._spec.delete(element)

    def _asset(self, shape: Shape) -> str | None:
        key = (shape.mesh, shape.size)
        if key not in self._assets:
            self._assets[key] = self._load(shape)
        return self._assets[key]

    def _load(self, shape: Shape) -> str | None:
        path = self.file(shape)
        if path is None:
            self.missing[shape.mesh] = None
            return None
        keys: dict[str, Any] = {"name": f"{path.stem}_{len(self._assets)}", "scale": shape.size}
        kind = path.suffix.lower()
        if kind == ".obj" or (kind == ".stl" and is_binary_stl(path)):
            keys["file"] = str(path)
        else:
            try:
                vertices, triangles = read_mesh(path)
            except ModelError as error:
                self.unreadable.append(f"mesh left out: {error}")
                return None
            keys |= {"uservert": vertices.ravel(), "userface": triangles.ravel()}
        self._spec.add_mesh(inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL, **keys)
        return str(keys["name"])


def _half_size(shape: Shape) -> tuple[float, ...]:
    """Size of a primitive shape as MuJoCo counts it: half edges, radius and half length [m]."""
    if shape.kind == "box":
        return tuple(0.5 * edge for edge in shape.size)
    return (shape.size[0], *(0.5 * length for length in shape.size[1:]), 0.0, 0.0)[:3]


def _mesh_keys(mesh: Any) -> dict[str, Any]:
    keys = ("name", "file", "scale", "uservert", "userface", "inertia")
    return {key: getattr(mesh, key) for key in keys}


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())
