"""Elements of a URDF file: links with mass and shapes, and joints."""

from dataclasses import dataclass
from math import inf, isfinite, isnan
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError

Array = NDArray[np.float64]
Element = ElementTree.Element
Color = tuple[float, ...]
TURNING = ("revolute", "continuous")
MAX_OFFSET = 5.0  # of a link from its parent [m]


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass properties.

    Attributes:
        mass: [kg].
        com: centre of mass in the frame of the link, shape (3,) [m].
        inertia: about the centre of mass in the directions of the link, shape (3, 3) [kg m²].
    """

    mass: float
    com: Array
    inertia: Array


@dataclass(frozen=True, slots=True)
class Shape:
    """Visual or collision shape.

    Attributes:
        name: of the element, may be empty.
        pose: in the link, shape (4, 4) [m].
        kind: box, sphere, cylinder, capsule or mesh.
        size: full edges; radius; radius and length; scale of a mesh.
        mesh: URI of the mesh, else empty.
        rgba: colour, if stated.
    """

    name: str
    pose: Array
    kind: str
    size: tuple[float, ...]
    mesh: str
    rgba: Color | None


@dataclass(frozen=True, slots=True)
class Link:
    """Link with its shapes; `inertial` is None where the file states none."""

    name: str
    inertial: Inertial | None
    visual: tuple[Shape, ...]
    collision: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Joint:
    """Joint.

    Attributes:
        pose: of the child in the parent at angle zero, shape (4, 4) [m].
        axis: unit vector in the child, shape (3,).
        range: lower and upper limit [rad or m]; infinite for a continuous joint.
        effort, speed: limits [N m, rad/s]; nan where the file states none.
        damping, friction: [N m s/rad, N m].
        mimic: joint, multiplier and offset, if it mimics one.
    """

    name: str
    type: str
    parent: str
    child: str
    pose: Array
    axis: Array
    range: tuple[float, float]
    effort: float
    speed: float
    damping: float
    friction: float
    mimic: tuple[str, float, float] | None


class ElementReader:
    """Elements of one file as links and joints; its errors name file and element."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def _numbers(
        self, element: Element | None, key: str, default: str, owner: str
    ) -> tuple[float, ...]:
        text = default if element is None else element.get(key, default)
        expected = len(default.split())
        try:
            values = tuple(float(word) for word in text.split())
        except ValueError:
            values = ()
        if len(values) != expected or (text != default and any(isnan(v) for v in values)):
            plural = "a number" if expected == 1 else f"{expected} numbers"
            raise ModelError(f"{self.file}: {owner}: {key}, got '{text}'; expected {plural}")
        return values

    def _pose(self, element: Element, owner: str) -> Array:
        origin = element.find("origin")
        pose = np.eye(4)
        pose[:3, 3] = self._numbers(origin, "xyz", "0 0 0", owner)
        angles = self._numbers(origin, "rpy", "0 0 0", owner)
        if not all(isfinite(v) for v in (*angles, *pose[:3, 3])):
            raise ModelError(f"{self.file}: {owner}: origin is not finite")
        pose[:3, :3] = Rotation.from_euler("xyz", angles).as_matrix()
        return pose

    def color(self, material: Element | None) -> Color | None:
        """Return the colour of a material, if it states one."""
        color = material.find("color") if material is not None else None
        return None if color is None else self._numbers(color, "rgba", "1 1 1 1", "material")

    def link(self, element: Element, colors: dict[str, Color | None]) -> Link:
        """Read a link; `colors` has those of the materials that the file defines by name.

        Raises:
            ModelError: a number is invalid, or the inertia is not positive.
        """
        name = element.get("name", "")
        owner = f"link '{name}'"

        def shapes(tag: str) -> tuple[Shape, ...]:
            read = (self._shape(e, colors, f"{owner}, {tag}") for e in element.findall(tag))
            return tuple(shape for shape in read if shape is not None)

        return Link(name, self._inertial(element, owner), shapes("visual"), shapes("collision"))

    def _inertial(self, link: Element, owner: str) -> Inertial | None:
        element = link.find("inertial")
        if element is None:
            return None
        (mass,) = self._numbers(element.find("mass"), "value", "nan", owner)
        tensor = element.find("inertia")

        def moment(key: str) -> float:
            return self._numbers(tensor, key, "0", owner)[0]

        xx, yy, zz = (moment(key) for key in ("ixx", "iyy", "izz"))
        xy, xz, yz = (moment(key) for key in ("ixy", "ixz", "iyz"))
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if not (mass >= 0.0 and mass < inf and np.isfinite(local).all()):
            raise ModelError(f"{self.file}: {owner}: mass, got {mass:g} kg; expected 0 or more")
        moments = np.linalg.eigvalsh(local)
        if moments[0] < -1e-6 * max(abs(moments)) - 1e-12:
            values = " ".join(f"{m:.3g}" for m in moments)
            raise ModelError(
                f"{self.file}: {owner}: inertia is not positive, got principal moments {values} "
                "kg m²; expected positive ones: check the signs of ixy, ixz and iyz"
            )
        pose = self._pose(element, owner)
        return Inertial(mass, pose[:3, 3], pose[:3, :3] @ local @ pose[:3, :3].T)

    def _shape(self, element: Element, colors: dict[str, Color | None], owner: str) -> Shape | None:
        geometry = element.find("geometry")
        if geometry is None or not len(geometry):
            return None
        body = geometry[0]
        keys = {
            "box": {"size": "nan nan nan"},
            "sphere": {"radius": "nan"},
            "cylinder": {"radius": "nan", "length": "nan"},
            "capsule": {"radius": "nan", "length": "nan"},
            "mesh": {"scale": "1 1 1"},
        }.get(body.tag)
        if keys is None:
            raise ModelError(
                f"{self.file}: {owner}: geometry <{body.tag}>; expected box, sphere, cylinder, "
                "capsule or mesh"
            )
        size = tuple(v for k, d in keys.items() for v in self._numbers(body, k, d, owner))
        if not all(isfinite(v) and v != 0.0 and (v > 0.0 or body.tag == "mesh") for v in size):
            raise ModelError(
                f"{self.file}: {owner}: size of the {body.tag}, got {size}; expected positive sizes"
            )
        material = element.find("material")
        rgba = self.color(material)
        if rgba is None and material is not None:
            rgba = colors.get(material.get("name", ""))
        mesh = body.get("filename", "") if body.tag == "mesh" else ""
        pose = self._pose(element, owner)
        return Shape(element.get("name", ""), pose, body.tag, size, mesh, rgba)

    def joint(self, element: Element) -> Joint:
        """Read a joint.

        Raises:
            ModelError: a number is invalid, or limits are missing or exchanged.
        """
        name, kind = element.get("name", ""), element.get("type", "")
        owner = f"joint '{name}'"

        def end(tag: str) -> str:
            child = element.find(tag)
            return "" if child is None else child.get("link", "")

        axis = np.array(self._numbers(element.find("axis"), "xyz", "1 0 0", owner))
        length = float(np.linalg.norm(axis))
        if kind not in ("fixed", "floating") and not 1e-6 < length < inf:
            raise ModelError(f"{self.file}: {owner}: axis, got {axis}; expected a direction")
        limit, dynamics, mimic = (element.find(tag) for tag in ("limit", "dynamics", "mimic"))

        def of(key: str, default: str, at: Element | None = limit) -> float:
            return self._numbers(at, key, default, owner)[0]

        limits = (of("lower", "0"), of("upper", "0"))
        if kind == "continuous":
            limits = (-inf, inf)
        elif kind == "revolute" and limit is None:
            raise ModelError(
                f"{self.file}: {owner}: no limits; expected <limit lower= upper= effort= "
                "velocity=/>, or the type continuous"
            )
        elif limits[0] > limits[1]:
            raise ModelError(
                f"{self.file}: {owner}: lower limit above the upper one, got {limits[0]:g} .. "
                f"{limits[1]:g}; expected lower <= upper"
            )
        for key in ("damping", "friction"):
            value = of(key, "0", dynamics)
            if not 0.0 <= value < inf:
                raise ModelError(f"{self.file}: {owner}: {key}, got {value:g}; expected >= 0")
        pose = self._pose(element, owner)
        if np.abs(pose[:3, 3]).max() > MAX_OFFSET:
            raise ModelError(
                f"{self.file}: {owner}: origin, got {pose[:3, 3]} m; expected at most "
                f"{MAX_OFFSET:g} m from the parent link"
            )
        follows = None
        if mimic is not None:
            multiplier, offset = of("multiplier", "1", mimic), of("offset", "0", mimic)
            follows = (mimic.get("joint", ""), multiplier, offset)
        return Joint(
            name=name,
            type=kind,
            parent=end("parent"),
            child=end("child"),
            pose=pose,
            axis=axis / max(length, 1e-9),
            range=limits,
            effort=of("effort", "nan"),
            speed=of("velocity", "nan"),
            damping=of("damping", "0", dynamics),
            friction=of("friction", "0", dynamics),
            mimic=follows,
        )
