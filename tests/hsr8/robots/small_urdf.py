"""A small humanoid as a URDF text, generated so that tests need no robot's files.

9 kg, legs of 0.40 m; positions are those at zero angles with x forward and z up, whatever the
frames of the links.
"""

import warnings
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.spatial.transform import Rotation

from hsr8.robots.file.description import RobotDescription, checked
from hsr8.robots.loaded import LoadedRobot, RawRobot, build_robot, read_robot

WORDS = {"y": "yaw", "r": "roll", "p": "pitch"}
AXES = {"y": (0.0, 0.0, 1.0), "r": (1.0, 0.0, 0.0), "p": (0.0, 1.0, 0.0)}
SIDES = {"l": 1.0, "r": -1.0}
FEET = ("l_foot", "r_foot")


@dataclass(frozen=True)
class SmallUrdf:
    """Choices of the robot.

    Attributes:
        hip, ankle: joints of the leg from the trunk outwards: y yaw, r roll, p pitch.
        offset: of the hip joints from each other, forward and down [m].
        root: turn of the root link against forward, left, up.
        seed: of random frames and inertias of all other links; None for plain ones.
        waist, arms: whether there are these joints.
    """

    hip: str = "yrp"
    ankle: str = "pr"
    offset: float = 0.0
    root: Rotation = field(default_factory=Rotation.identity)
    seed: int | None = None
    waist: bool = True
    arms: bool = True

    def element(self) -> Element:
        """Root element of the URDF file, for changes."""
        return _Builder(self).robot

    def legs(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of the joints of both legs, hip first."""
        hip, ankle = ([WORDS[c] for c in part] for part in (self.hip, self.ankle))
        names = [*(f"hip_{n}" for n in hip), "knee", *(f"ankle_{n}" for n in ankle)]
        left, right = (tuple(f"{side}_{name}" for name in names) for side in SIDES)
        return left, right


def write(robot: Element, folder: Path) -> Path:
    """Write a URDF file."""
    file = folder / "small.urdf"
    file.write_text(ElementTree.tostring(robot, encoding="unicode"))
    return file


def describe(**keys: object) -> RobotDescription:
    """Description with the feet of the small robot."""
    return checked({"model": "small.urdf", "feet": FEET, **keys}, "small.toml")


def raw(robot: Element, folder: Path, **keys: object) -> RawRobot:
    """Write a URDF file and read it with its description."""
    write(robot, folder)
    return read_robot(describe(**keys), folder / "small.toml")


def built(robot: Element, folder: Path, **keys: object) -> LoadedRobot:
    """Write a URDF file and load it with its description."""
    write(robot, folder)
    return build_robot(describe(**keys), folder / "small.toml")


def joint(robot: Element, name: str) -> Element:
    """Joint of a URDF file by name."""
    return next(e for e in robot.findall("joint") if e.get("name") == name)


def link(robot: Element, name: str) -> Element:
    """Link of a URDF file by name."""
    return next(e for e in robot.findall("link") if e.get("name") == name)


class _Builder:
    def __init__(self, choice: SmallUrdf) -> None:
        self.choice = choice
        self.random = None if choice.seed is None else np.random.default_rng(choice.seed)
        self.robot = Element("robot", name="small")
        self.frames: dict[str, tuple[Rotation, np.ndarray]] = {}
        self.link("pelvis", None, (0.0, 0.0, 0.0), mass=2.0, box=(0.10, 0.16, 0.08))
        self.link("imu", "pelvis", (0.02, 0.01, 0.03), mass=0.05)
        for side, y in SIDES.items():
            self.leg(side, y)
        self.trunk()

    def leg(self, side: str, y: float) -> None:
        parent, at = "pelvis", np.array([0.0, 0.06 * y, 0.0])
        step = np.array([self.choice.offset, 0.0, -self.choice.offset])
        for k, c in enumerate(self.choice.hip):
            name = f"{side}_hip_{WORDS[c]}"
            self.link(f"{name}_link", parent, at + k * step, name, AXES[c], mass=0.3)
            parent = f"{name}_link"
        at = at + (len(self.choice.hip) - 1) * step + (0.0, 0.0, -0.2)
        knee = f"{side}_knee"
        shank = {"mass": 0.5, "box": (0.04, 0.04, 0.1)}
        self.link(f"{knee}_link", parent, at, knee, AXES["p"], limits=(-0.1, 2.2), **shank)
        parent, at = f"{knee}_link", at - (0.0, 0.0, 0.2)
        for c in self.choice.ankle:
            name = f"{side}_ankle_{WORDS[c]}"
            self.link(f"{name}_link", parent, at, name, AXES[c], mass=0.2)
            parent = f"{name}_link"
        sole = {"mass": 0.2, "box": (0.16, 0.08, 0.02), "center": (0.02, 0.005 * y, 0.0)}
        self.link(f"{side}_foot", parent, at - (0.0, 0.0, 0.03), **sole)

    def trunk(self) -> None:
        joint = ("waist", AXES["y"]) if self.choice.waist else ()
        self.link("chest", "pelvis", (0.0, 0.0, 0.1), *joint, mass=2.0, box=(0.1, 0.16, 0.2))
        self.link("neck", "chest", (0.0, 0.0, 0.25), "head_yaw", AXES["y"], mass=0.1)
        head = {"mass": 0.3, "box": (0.08, 0.08, 0.1)}
        self.link("head", "neck", (0.0, 0.0, 0.28), "head_pitch", AXES["p"], **head)
        self.link("camera", "head", (0.05, 0.0, 0.33))
        for side, y in SIDES.items() if self.choice.arms else ():
            for name, axis, z in (("shoulder", "p", 0.2), ("elbow", "p", 0.05)):
                above = "chest" if name == "shoulder" else f"{side}_shoulder_link"
                at, joint = (0.0, 0.12 * y, z), f"{side}_{name}"
                self.link(f"{joint}_link", above, at, joint, AXES[axis], mass=0.2)

    def turn(self, name: str) -> Rotation:
        if name == "pelvis":
            return self.choice.root
        if self.random is None:
            return Rotation.identity()
        return Rotation.random(rng=self.random)

    def link(
        self,
        name: str,
        parent: str | None,
        at: tuple[float, float, float] | np.ndarray,
        joint: str | None = None,
        axis: tuple[float, float, float] = (1.0, 0.0, 0.0),
        *,
        mass: float = 0.0,
        box: tuple[float, float, float] | None = None,
        center: tuple[float, float, float] = (0.0, 0.0, 0.0),
        limits: tuple[float, float] = (-1.5, 1.5),
    ) -> None:
        turn, at = self.turn(name), np.array(at)
        self.frames[name] = turn, at
        element = SubElement(self.robot, "link", name=name)
        if mass:
            self.inertial(element, mass)
        for tag in ("visual", "collision") if box else ():
            shape = SubElement(element, tag)
            _origin(shape, turn.inv().apply(center), turn.inv())
            SubElement(SubElement(shape, "geometry"), "box", size=_text(box))
        if parent is None:
            return
        parent_turn, parent_at = self.frames[parent]
        kind = "fixed" if joint is None else "revolute"
        element = SubElement(self.robot, "joint", name=joint or f"{name}_fixed", type=kind)
        _origin(element, parent_turn.inv().apply(at - parent_at), parent_turn.inv() * turn)
        SubElement(element, "parent", link=parent)
        SubElement(element, "child", link=name)
        if joint is not None:
            SubElement(element, "axis", xyz=_text(turn.inv().apply(axis)))
            lower, upper = (str(v) for v in limits)
            SubElement(element, "limit", lower=lower, upper=upper, effort="40", velocity="8")
            SubElement(element, "dynamics", damping="0.1", friction="0.05")

    def inertial(self, element: Element, mass: float) -> None:
        inertial = SubElement(element, "inertial")
        edges = np.full(3, 0.08)
        if self.random is None:
            _origin(inertial, np.zeros(3), Rotation.identity())
        else:
            mass *= self.random.uniform(0.5, 1.5)
            edges = self.random.uniform(0.03, 0.15, 3)
            com = self.random.uniform(-0.03, 0.03, 3)
            _origin(inertial, com, Rotation.random(rng=self.random))
        SubElement(inertial, "mass", value=repr(float(mass)))
        squares = edges**2
        moments = mass / 12.0 * (squares.sum() - squares)
        keys = dict(zip(("ixx", "iyy", "izz"), map(repr, moments.tolist()), strict=True))
        SubElement(inertial, "inertia", keys | dict.fromkeys(("ixy", "ixz", "iyz"), "0"))


def _origin(element: Element, xyz: np.ndarray, turn: Rotation) -> None:
    SubElement(element, "origin", xyz=_text(xyz), rpy=_text(_angles(turn)))


def _angles(turn: Rotation) -> np.ndarray:
    """Roll, pitch and yaw; at a pitch of a quarter turn one of them is free."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return turn.as_euler("xyz")


def _text(numbers: object) -> str:
    return " ".join(repr(float(v)) for v in numbers)  # type: ignore[attr-defined]
