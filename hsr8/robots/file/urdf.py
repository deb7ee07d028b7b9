"""URDF files: checked, completed and handed to MuJoCo's own reader.

MuJoCo reads links, joints, shapes, limits and mimic joints. Added here are mesh files of packages
and of formats that it lacks, and the maximum speeds of the joints.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite, isnan
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from hsr8.errors import ModelError
from hsr8.robots.file.files import find_mesh
from hsr8.robots.file.meshes import is_binary_stl, is_pointer, read_mesh

Element = ElementTree.Element

NUMBERS: dict[str, dict[str, int]] = {  # attributes of an element, and how many numbers they have
    "origin": {"xyz": 3, "rpy": 3},
    "axis": {"xyz": 3},
    "mass": {"value": 1},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), 1),
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), 1),
    "dynamics": dict.fromkeys(("damping", "friction"), 1),
    "mimic": dict.fromkeys(("multiplier", "offset"), 1),
    "box": {"size": 3},
    "sphere": {"radius": 1},
    "cylinder": {"radius": 1, "length": 1},
    "capsule": {"radius": 1, "length": 1},
    "mesh": {"scale": 3},
    "color": {"rgba": 4},
}
PARTS, LINK_PARTS = ("link", "joint", "material"), ("inertial", "visual", "collision")
REQUIRED = {"mass", "box", "sphere", "cylinder", "capsule"}  # elements without defaults
SHAPES = ("box", "sphere", "cylinder", "capsule", "mesh")
JOINTS = ("fixed", "revolute", "continuous", "prismatic")
MAX_EFFORT, MAX_SPEED = 1e4, 1e3  # a larger number is a placeholder [N m], [rad/s]
PHYSICS_STEP = 0.0025  # a URDF file states none [s]
VISUAL = {"group": 2, "contype": 0, "conaffinity": 0}
COLLISION = {"group": 3, "contype": 0, "conaffinity": 2}  # it hits obstacles, and not itself
PLAIN, GREY = (0.5, 0.5, 0.5, 1.0), (0.75, 0.75, 0.77, 1.0)  # MuJoCo's colour without material
COMPILER = {
    "fusestatic": "false",
    "discardvisual": "false",
    "inertiafromgeom": "false",
    "balanceinertia": "false",
}


@dataclass(slots=True)
class _Meshes:
    """Mesh files of a robot by the name of their asset, and those that are left out."""

    file: Path
    packages: Mapping[str, Path]
    paths: dict[str, Path] = field(default_factory=dict)
    missing: dict[str, None] = field(default_factory=dict)


def read_urdf(
    file: Path, packages: Mapping[str, Path]
) -> tuple[mujoco.MjSpec, dict[str, float], list[str]]:
    """Read a URDF file.

    Args:
        file: URDF file.
        packages: folders of the packages that it names.

    Returns:
        MuJoCo model with one body per link and a fixed base, maximum speeds by joint [rad/s], and
        notes.

    Raises:
        ModelError: the file cannot be read, a number is invalid, or the links do not form a tree.
    """
    robot = _parsed(file)
    _check_numbers(robot, file)
    _check_tree(robot, file)
    _drop_world(robot)
    for joint in robot.findall("joint"):
        _check_joint(joint, file)
    for link in robot.findall("link"):
        _check_link(link, file)
    speed = {
        joint.get("name", ""): value
        for joint in robot.findall("joint")
        if 0.0 < (value := _number(joint.find("limit"), "velocity")) <= MAX_SPEED
    }
    meshes = _Meshes(file, packages)
    _name_shapes(robot)
    _place_meshes(robot, meshes)
    SubElement = ElementTree.SubElement
    SubElement(SubElement(robot, "mujoco"), "compiler", COMPILER)
    try:
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding="unicode"))
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise ModelError(f"{file}: invalid robot model: {reason}") from error
    spec.modelname = file.stem
    spec.option.timestep = PHYSICS_STEP
    notes = _load_meshes(spec, meshes)
    for geom in spec.geoms:
        for key, value in (VISUAL if not geom.contype else COLLISION).items():
            setattr(geom, key, value)
        if tuple(geom.rgba) == PLAIN:
            geom.rgba = GREY
    for joint in robot.findall("joint"):
        if joint.get("type") in ("revolute", "prismatic"):
            moving = spec.joint(joint.get("name", ""))
            moving.limited = mujoco.mjtLimited.mjLIMITED_TRUE  # also by a range of zero
            limit = joint.find("limit[@effort]")
            if limit is not None and not _number(limit, "effort"):
                moving.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE
    return spec, speed, notes


def drop_invalid_meshes(spec: mujoco.MjSpec) -> list[str]:
    """Remove the meshes that MuJoCo cannot compile, with their shapes; return a note on each."""
    notes = []
    for mesh in list(spec.meshes):
        geoms = [geom for geom in spec.geoms if geom.meshname == mesh.name]
        trial = mujoco.MjSpec()
        keys = ("name", "file", "scale", "uservert", "userface", "inertia")
        trial.add_mesh(**{key: getattr(mesh, key) for key in keys})
        trial.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_MESH,
            meshname=mesh.name,
            contype=int(any(geom.conaffinity for geom in geoms)),
        )
        try:
            trial.compile()
        except ValueError as error:
            reason = " ".join(str(error).split())
            notes.append(f"mesh {mesh.file or mesh.name} left out: {reason}")
            for element in (*geoms, mesh):
                spec.delete(element)
    return notes


def _parsed(file: Path) -> Element:
    """Return the elements of a URDF file, without those for other programs."""
    try:
        robot = ElementTree.fromstring(file.read_bytes())
    except (OSError, ValueError, ElementTree.ParseError) as error:
        raise ModelError(f"{file}: cannot be read: {error}; expected a URDF file") from error
    if robot.tag != "robot":
        raise ModelError(
            f"{file}: not a URDF file, got the element <{robot.tag}>; expected <robot>"
        )
    if any("xacro" in element.tag for element in robot.iter()):
        raise ModelError(f"{file}: a xacro file; expected the URDF file that `xacro` makes of it")
    for parent, known in ((robot, PARTS), *((link, LINK_PARTS) for link in robot.findall("link"))):
        for element in list(parent):
            if element.tag not in known:
                parent.remove(element)  # among them <mujoco>, whose options are replaced
    return robot


def _check_numbers(robot: Element, file: Path) -> None:
    """Refuse attributes that are not the numbers of their element; limits may be infinite."""
    for part in robot:
        owner = f"{part.tag} {part.get('name', '')!r}"
        for element in part.iter():
            for key, count in NUMBERS.get(element.tag, {}).items():
                text = element.get(key)
                if text is None and element.tag not in REQUIRED:
                    continue
                try:
                    values = [float(word) for word in (text or "").split()]
                except ValueError:
                    values = []
                may_be_infinite = element.tag == "limit"
                valid = all(isfinite(v) or (may_be_infinite and not isnan(v)) for v in values)
                if len(values) != count or not valid:
                    kind = "a finite number" if count == 1 else f"{count} finite numbers"
                    raise ModelError(f"{file}: {owner}: {key}, got {text!r}; expected {kind}")


def _check_tree(robot: Element, file: Path) -> None:
    """Refuse links that do not form one tree."""
    links = [link.get("name", "") for link in robot.findall("link")]
    joints = robot.findall("joint")
    for kind, names in (("link", links), ("joint", [j.get("name", "") for j in joints])):
        twice = [name for name, count in Counter(names).items() if count > 1]
        if twice:
            raise ModelError(f"{file}: {kind} {twice[0]!r} appears twice; expected unique names")
    above: dict[str, Element] = {}
    for joint in joints:
        name, mimic = joint.get("name"), joint.find("mimic")
        if mimic is not None and (
            (leader := mimic.get("joint")) == name or all(j.get("name") != leader for j in joints)
        ):
            raise ModelError(
                f"{file}: joint {name!r}: mimic, got {leader!r}; expected another joint of the file"
            )
        for end in ("parent", "child"):
            if _end(joint, end) not in links:
                raise ModelError(
                    f"{file}: joint {name!r}: {end}, got {_end(joint, end)!r}; expected a link of "
                    "the file"
                )
        child = _end(joint, "child")
        if child in above:
            raise ModelError(
                f"{file}: link {child!r}: closed chain, it is the child of the joints "
                f"{above[child].get('name')!r} and {name!r}; expected one parent: remove one of "
                "the joints, a tree of links is needed"
            )
        above[child] = joint
    for link in links:
        ancestors = [link]
        while ancestors[-1] in above:
            ancestors.append(_end(above[ancestors[-1]], "parent"))
            if ancestors[-1] in ancestors[:-1]:
                raise ModelError(
                    f"{file}: link {link!r}: closed chain, it is its own ancestor; expected a tree"
                )
    roots = [link for link in links if link not in above]
    if len(roots) != 1:
        raise ModelError(
            f"{file}: {len(roots)} root links, got {', '.join(roots[:5]) or 'none'}; expected one "
            "link without a parent, whose joints carry all others"
        )


def _drop_world(robot: Element) -> None:
    """Leave out an empty root link that only anchors the robot: a floating joint, or ``world``."""
    joints = robot.findall("joint")
    children = {_end(joint, "child") for joint in joints}
    (root,) = (link for link in robot.findall("link") if link.get("name") not in children)
    top = [joint for joint in joints if _end(joint, "parent") == root.get("name")]
    if len(root) or len(top) != 1:
        if root.get("name") == "world":  # MuJoCo would take it for its world
            root.set("name", "world_link")
            for joint in top:
                joint.find("parent").set("link", "world_link")  # type: ignore[union-attr]
        return
    if top[0].get("type") == "floating" or root.get("name") == "world":
        robot.remove(root)
        robot.remove(top[0])


def _check_joint(joint: Element, file: Path) -> None:
    owner, kind = f"{file}: joint {joint.get('name')!r}", joint.get("type", "")
    if kind not in JOINTS:
        raise ModelError(
            f"{owner}: type, got {kind!r}; expected revolute, continuous, prismatic or fixed: make "
            "it fixed, the simulator frees the base itself"
        )
    axis = joint.find("axis")
    if kind != "fixed" and axis is not None:
        direction = np.array(axis.get("xyz", "1 0 0").split(), float)
        if np.linalg.norm(direction) < 1e-6:
            raise ModelError(f"{owner}: axis, got {axis.get('xyz')!r}; expected a direction")
    limit, dynamics = joint.find("limit"), joint.find("dynamics")
    if kind == "revolute" and limit is None:
        raise ModelError(
            f"{owner}: limits are missing; expected <limit lower= upper= effort= velocity=/>, or "
            "the type continuous"
        )
    lower, upper = _number(limit, "lower"), _number(limit, "upper")
    if kind != "continuous" and lower > upper:
        raise ModelError(
            f"{owner}: lower limit above the upper one, got {lower:g} .. {upper:g}; expected lower "
            "<= upper"
        )
    for key in ("damping", "friction"):
        if _number(dynamics, key) < 0.0:
            raise ModelError(f"{owner}: {key}, got {_number(dynamics, key):g}; expected >= 0")
    if limit is not None and not 0.0 <= _number(limit, "effort") <= MAX_EFFORT:
        limit.attrib.pop("effort")  # a placeholder


def _check_link(link: Element, file: Path) -> None:
    owner = f"{file}: link {link.get('name')!r}"
    mass = link.find("inertial/mass")
    if link.find("inertial") is not None and mass is None:
        raise ModelError(f"{owner}: <inertial> without <mass>; expected <mass value=/>")
    if mass is not None and _number(mass, "value") < 0.0:
        raise ModelError(f"{owner}: mass, got {_number(mass, 'value'):g} kg; expected 0 or more")
    for shape in (*link.findall("visual"), *link.findall("collision")):
        geometry = shape.find("geometry")
        if geometry is None or not len(geometry):
            link.remove(shape)
            continue
        solid = geometry[0]
        if solid.tag not in SHAPES:
            raise ModelError(
                f"{owner}: geometry <{solid.tag}>; expected box, sphere, cylinder, capsule or mesh"
            )
        sizes = [v for key in NUMBERS[solid.tag] for v in (solid.get(key) or "").split()]
        if not all(float(v) != 0.0 and (float(v) > 0.0 or solid.tag == "mesh") for v in sizes):
            raise ModelError(
                f"{owner}: size of the {solid.tag}, got {' '.join(sizes)}; expected positive sizes"
            )


def _name_shapes(robot: Element) -> None:
    """Name the shapes uniquely, after their links where they have no name; collision shapes first.

    A description can then name the shapes of a link that is fused with another one.
    """
    names: set[str] = set()
    for tag in ("collision", "visual"):
        for link in robot.findall("link"):
            for shape in link.findall(tag):
                name = shape.get("name", "") or link.get("name", "")
                choices = (name, *(f"{name}/{k}" for k in range(2, len(names) + 3)))
                unique: str = next(choice for choice in choices if choice not in names)
                shape.set("name", unique)
                names.add(unique)


def _place_meshes(robot: Element, meshes: _Meshes) -> None:
    """Give every mesh file and scale its own name; remove shapes without a file."""
    names: dict[tuple[Path, str], str] = {}
    for link in robot.findall("link"):
        for shape in (*link.findall("visual"), *link.findall("collision")):
            mesh = shape.find("geometry/mesh")
            if mesh is None:
                continue
            uri = mesh.get("filename", "")
            path = find_mesh(uri, meshes.file, meshes.packages)
            if path is None:
                meshes.missing[uri] = None
                link.remove(shape)
                continue
            key = path, mesh.get("scale", "")
            names.setdefault(key, f"{path.stem}_{len(names)}")
            meshes.paths[names[key]] = path
            mesh.set("filename", f"{names[key]}.stl")  # the name of the asset, not its file


def _load_meshes(spec: mujoco.MjSpec, meshes: _Meshes) -> list[str]:
    """Set the files of the meshes, or the contents of those that MuJoCo cannot read."""
    notes = []
    for mesh in list(spec.meshes):
        path = meshes.paths[mesh.name]
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        kind = path.suffix.lower()
        readable = kind == ".obj" or (kind == ".stl" and is_binary_stl(path))
        if readable and not is_pointer(path):
            mesh.file = str(path)
            continue
        mesh.file = ""
        try:
            vertices, triangles = read_mesh(path)
        except ModelError as error:
            notes.append(f"mesh left out: {error}")
            for element in (*(g for g in spec.geoms if g.meshname == mesh.name), mesh):
                spec.delete(element)
            continue
        mesh.uservert, mesh.userface = vertices.ravel(), triangles.ravel()
    if meshes.missing:
        notes.append(
            f"{len(meshes.missing)} meshes missing, first {next(iter(meshes.missing))}: their "
            "shapes are left out; `packages` states where a package is"
        )
    return notes


def _end(joint: Element, tag: str) -> str:
    """Return the link at an end of a joint."""
    end = joint.find(tag)
    return "" if end is None else end.get("link", "")


def _number(element: Element | None, key: str) -> float:
    """Return a number of an element; 0 where it states none."""
    return 0.0 if element is None else float(element.get(key, "0"))
