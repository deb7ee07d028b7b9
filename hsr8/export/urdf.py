"""URDF of a robot: the links, joints, masses and shapes of its compiled MuJoCo model."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, sin
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.export.links import Link, links_of, model_of
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.shown import VISUAL_GROUPS, visual_model

Array = NDArray[np.float64]
Element = ElementTree.Element

_GEOM = mujoco.mjtGeom
MESHES = "meshes"  # folder of the mesh files
UNKNOWN = 1e6  # maximum torque and speed of a joint whose model lacks them [N m, rad/s]
SPHERE_SEGMENTS = (24, 12)  # of the mesh of a sphere, around and from pole to pole
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@dataclass(frozen=True, slots=True)
class Urdf:
    """Robot description.

    Attributes:
        text: XML; it names the mesh files by folder and name.
        meshes: contents of the mesh files, binary STL, by name.
    """

    text: str
    meshes: Mapping[str, bytes]

    def write(self, file: Path, folder: Path) -> None:
        """Write a new description, and its mesh files, if any, into a new folder.

        Raises:
            OSError: a file cannot be written.
        """
        if self.meshes:
            folder.mkdir()
        for name, content in self.meshes.items():
            (folder / name).write_bytes(content)
        file.write_text(self.text, encoding="utf-8")


def urdf_of(robot: LoadedRobot, folder: str = MESHES) -> Urdf:
    """Return the URDF of a robot.

    The base has no parent; the frames of camera, IMU and soles are links without mass.

    Args:
        robot: its joints, masses and shapes.
        folder: folder of the mesh files, next to the description.

    Raises:
        UsageError: a joint has a type that URDF lacks.
    """
    model = model_of(robot)
    writer = _Writer(model, folder)
    visual = visual_model(robot)
    shown = np.isin(visual.geom_group, VISUAL_GROUPS)
    solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    tree = robot.model.tree
    limits = dict(zip(tree.names, zip(tree.effort, tree.speed, strict=True), strict=True))
    root = Element("robot", name=robot.name)
    for link in links_of(model):
        part = ElementTree.SubElement(root, "link", name=link.name)
        if link.body >= 0:
            writer.add_inertia(part, link.body)
            writer.add_shapes(part, "visual", visual, link.body, shown)
            writer.add_shapes(part, "collision", model, link.body, solid)
        if link.parent:
            root.append(writer.joint(link, limits))
    ElementTree.indent(root)
    return Urdf(ElementTree.tostring(root, "unicode", xml_declaration=True) + "\n", writer.meshes)


@dataclass
class _Writer:
    """Elements of one description.

    Attributes:
        model: compiled robot.
        folder: folder of the mesh files.
        meshes: so far, by name.
    """

    model: mujoco.MjModel
    folder: str
    meshes: dict[str, bytes] = field(default_factory=dict)

    def joint(self, link: Link, limits: Mapping[str, tuple[float, float]]) -> Element:
        """Return the joint of a link."""
        joint = Element("joint", name=link.joint, type=link.kind)
        joint.append(_origin(link.position, link.orientation))
        ElementTree.SubElement(joint, "parent", link=link.parent)
        ElementTree.SubElement(joint, "child", link=link.name)
        if link.number < 0:
            return joint
        ElementTree.SubElement(joint, "axis", xyz=_text(link.axis))
        model, j = self.model, link.number
        effort, speed = limits.get(link.joint, (float(model.jnt_actfrcrange[j, 1]), 0.0))
        limit = {
            "effort": repr(min(float(effort), UNKNOWN)),
            "velocity": repr(min(float(speed), UNKNOWN)),
        }
        if link.kind != "continuous":
            limit |= {"lower": repr(float(model.jnt_range[j, 0]))}
            limit |= {"upper": repr(float(model.jnt_range[j, 1]))}
        ElementTree.SubElement(joint, "limit", limit)
        dof = int(model.jnt_dofadr[j])
        damping, friction = float(model.dof_damping[dof]), float(model.dof_frictionloss[dof])
        ElementTree.SubElement(joint, "dynamics", damping=repr(damping), friction=repr(friction))
        return joint

    def add_inertia(self, part: Element, body: int) -> None:
        """Add mass, centre of mass and inertia of a body, in its axes."""
        model = self.model
        if not model.body_mass[body]:
            return
        rotation = _matrix(model.body_iquat[body])
        inertia = rotation @ np.diag(model.body_inertia[body]) @ rotation.T
        inertial = ElementTree.SubElement(part, "inertial")
        inertial.append(Element("origin", xyz=_text(model.body_ipos[body]), rpy="0 0 0"))
        ElementTree.SubElement(inertial, "mass", value=repr(float(model.body_mass[body])))
        entries = {
            f"i{'xyz'[i]}{'xyz'[k]}": repr(float(inertia[i, k]))
            for i in range(3)
            for k in range(i, 3)
        }
        ElementTree.SubElement(inertial, "inertia", entries)

    def add_shapes(
        self,
        part: Element,
        tag: str,
        model: mujoco.MjModel,
        body: int,
        chosen: NDArray[np.bool_],
    ) -> None:
        """Add the chosen geoms of a body as elements `tag`."""
        first = int(model.body_geomadr[body])
        for geom in range(first, first + int(model.body_geomnum[body])):
            if not chosen[geom]:
                continue
            for offset, shape in self._shapes(tag, model, geom):
                element = ElementTree.SubElement(part, tag)
                position = model.geom_pos[geom] + _matrix(model.geom_quat[geom]) @ offset
                element.append(_origin(position, model.geom_quat[geom]))
                ElementTree.SubElement(element, "geometry").append(shape)
                if tag == "visual":
                    material = int(model.geom_matid[geom])
                    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
                    name = f"rgba_{'_'.join(f'{round(255 * float(v))}' for v in rgba)}"
                    color = ElementTree.SubElement(element, "material", name=name)
                    ElementTree.SubElement(color, "color", rgba=_text(rgba))

    def _shapes(self, tag: str, model: mujoco.MjModel, geom: int) -> list[tuple[Array, Element]]:
        """Return the shapes of a geom, each with its offset in the geom's frame [m]."""
        kind, size, here = _GEOM(int(model.geom_type[geom])), model.geom_size[geom], np.zeros(3)
        radius, length = repr(float(size[0])), repr(2.0 * float(size[1]))
        if kind == _GEOM.mjGEOM_BOX:
            return [(here, Element("box", size=_text(2.0 * size)))]
        if kind == _GEOM.mjGEOM_SPHERE:
            return [(here, Element("sphere", radius=radius))]
        if kind in (_GEOM.mjGEOM_CYLINDER, _GEOM.mjGEOM_CAPSULE):
            shapes = [(here, Element("cylinder", radius=radius, length=length))]
            if kind == _GEOM.mjGEOM_CAPSULE:
                end = np.array([0.0, 0.0, float(size[1])])
                shapes += [(at, Element("sphere", radius=radius)) for at in (end, -end)]
            return shapes
        if kind == _GEOM.mjGEOM_ELLIPSOID:
            name = "sphere.stl"
            if name not in self.meshes:
                self.meshes[name] = _stl(*_sphere())
            return [(here, Element("mesh", filename=f"{self.folder}/{name}", scale=_text(size)))]
        if kind == _GEOM.mjGEOM_MESH:
            mesh = model.mesh(int(model.geom_dataid[geom]))
            name = f"{mesh.name.replace('/', '_')}_{tag}.stl"
            if name not in self.meshes:
                vertex, face = int(mesh.vertadr[0]), int(mesh.faceadr[0])
                self.meshes[name] = _stl(
                    model.mesh_vert[vertex : vertex + int(mesh.vertnum[0])],
                    model.mesh_face[face : face + int(mesh.facenum[0])],
                )
            return [(here, Element("mesh", filename=f"{self.folder}/{name}"))]
        return []


def _origin(position: Array, orientation: Array) -> Element:
    rotation = _matrix(orientation)
    yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    c, s = cos(yaw), sin(yaw)  # the next angles compensate the rounding of the yaw near poles
    pitch = np.arctan2(-rotation[2, 0], c * rotation[0, 0] + s * rotation[1, 0])
    roll = np.arctan2(
        s * rotation[0, 2] - c * rotation[1, 2], c * rotation[1, 1] - s * rotation[0, 1]
    )
    return Element("origin", xyz=_text(position), rpy=_text([roll, pitch, yaw]))


def _matrix(quaternion: Array) -> Array:
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, quaternion)
    return rotation.reshape(3, 3)


def _text(values: Array | list[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _sphere() -> tuple[Array, NDArray[np.int64]]:
    """Return vertices and triangles of a sphere of radius 1."""
    around, along = SPHERE_SEGMENTS
    turn = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    polar = np.linspace(0.0, np.pi, along + 1)[:, None]
    x, y = np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn)
    vertices = np.stack([x, y, np.broadcast_to(np.cos(polar), x.shape)], axis=-1).reshape(-1, 3)
    i, k = np.mgrid[:along, :around]
    a, b = i * around + k, i * around + (k + 1) % around
    c, d = a + around, b + around
    upper, lower = np.stack([a, c, d], axis=-1), np.stack([a, d, b], axis=-1)
    return vertices, np.concatenate([*upper[:-1], *lower[1:]])


def _stl(vertices: Array, triangles: NDArray[np.int64]) -> bytes:
    """Return a binary STL file of vertices (n, 3) [m] and triangles (m, 3)."""
    corners = np.asarray(vertices)[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    content = np.zeros(len(triangles), _TRIANGLE)
    content["normal"] = normal / np.where(length > 0.0, length, 1.0)
    content["corners"] = corners
    return bytes(80) + np.uint32(len(triangles)).tobytes() + content.tobytes()
