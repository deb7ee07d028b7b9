"""A small humanoid as an MJCF text, generated so that tests need no robot's files.

10 kg, legs of 0.40 m; joints of a limb are letters from the trunk outwards: y yaw, r roll, p pitch.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

WORDS = {"y": "yaw", "r": "roll", "p": "pitch"}
AXES = {"y": (0.0, 0.0, 1.0), "r": (1.0, 0.0, 0.0), "p": (0.0, 1.0, 0.0)}
SIDES = {"l": 1.0, "r": -1.0}
RANGES = {  # of the left side [rad]
    "hip_yaw": (-0.8, 0.9),
    "hip_roll": (-0.4, 0.7),
    "hip_pitch": (-1.7, 0.6),
    "knee": (0.0, 2.2),
    "ankle_pitch": (-1.0, 0.8),
    "ankle_roll": (-0.5, 0.6),
}
ARM_RANGE = (-2.0, 2.0)
Name = Callable[[str, str], str]


def plain_name(side: str, part: str) -> str:
    """``l_knee``, ``head_yaw``."""
    return f"{side}_{part}" if side else part


@dataclass(frozen=True)
class SmallHumanoid:
    """Choices of the robot.

    Attributes:
        hip, ankle: three and two joints of the leg; with five joints in all it cannot walk.
        waist, head, arm: joints above the base; none for no such part.
        name: of joints and bodies from side and part; bodies get the suffix ``_link``.
        flip: whether the axes on the right are reversed.
        oblique: turn of the yaw and roll axes of the hip about the pitch axis [rad].
        offset: of the hip joints from each other, forward and down [m].
        limited: whether joints have ranges.
        actuator: position, motor, or none.
        free: whether the base has a free joint.
        mass: factor on all masses [1].
    """

    hip: str = "yrp"
    ankle: str = "pr"
    waist: str = ""
    head: str = "yp"
    arm: str = "prp"
    name: Name = plain_name
    flip: bool = False
    oblique: float = 0.0
    offset: float = 0.0
    limited: bool = True
    actuator: str = "position"
    free: bool = True
    mass: float = 1.0

    def xml(self) -> str:
        """MJCF text."""
        return ElementTree.tostring(self.element(), encoding="unicode")

    def element(self) -> Element:
        """Root element of the MJCF, for changes."""
        return _Builder(self).mujoco

    def leg(self, side: str) -> list[str]:
        """Names of the joints of a leg."""
        parts = [f"hip_{WORDS[c]}" for c in self.hip] + ["knee"]
        parts += [f"ankle_{WORDS[c]}" for c in self.ankle]
        return [self.name(side, part) for part in parts]

    def feet(self) -> tuple[str, str]:
        """Names of the bodies of the feet."""
        left, right = (f"{self.leg(side)[-1]}_link" for side in "lr")
        return left, right


class _Builder:
    def __init__(self, robot: SmallHumanoid) -> None:
        self.robot = robot
        self.mujoco = Element("mujoco", model="small")
        SubElement(self.mujoco, "compiler", angle="radian", autolimits="true")
        SubElement(self.mujoco, "option", timestep="0.0025")
        world = SubElement(self.mujoco, "worldbody")
        self.actuators = SubElement(self.mujoco, "actuator")
        base = self.body(world, "base", (0.0, 0.0, 0.46), 2.0)
        if robot.free:
            base.insert(0, Element("freejoint", name="root"))
        SubElement(base, "geom", type="box", size="0.06 0.08 0.04", mass="0", contype="0")
        for side, sign in SIDES.items():
            self.leg(base, side, sign)
        trunk = base
        for c in robot.waist:
            trunk = self.joint(trunk, "", f"waist_{WORDS[c]}", c, (0.0, 0.0, 0.04), 0.3)
        trunk = self.body(trunk, "torso", (0.0, 0.0, 0.06), 3.0)
        SubElement(
            trunk, "geom", type="box", size="0.05 0.07 0.1", pos="0 0 0.1", mass="0", contype="0"
        )
        for side, sign in SIDES.items() if robot.arm else ():
            self.arm(trunk, side, sign)
        self.head(trunk)

    def leg(self, parent: Element, side: str, sign: float) -> None:
        offset = (self.robot.offset, 0.0, -self.robot.offset)
        position = (0.0, sign * 0.06, -0.02)
        for c in self.robot.hip:
            parent = self.joint(parent, side, f"hip_{WORDS[c]}", c, position, 0.2, hip=True)
            position = offset
        part = (0.0, 0.0, -0.20)
        parent.find("inertial").set("pos", "0 0 -0.1")
        self.capsule(parent, part)
        parent = self.joint(parent, side, "knee", "p", part, 0.4)
        self.capsule(parent, part)
        for c in self.robot.ankle:
            parent = self.joint(parent, side, f"ankle_{WORDS[c]}", c, part, 0.2)
            part = (0.0, 0.0, 0.0)
        foot = {"type": "box", "size": "0.08 0.04 0.01", "pos": "0.02 0 -0.03", "mass": "0"}
        parent.find("inertial").set("pos", "0.01 0 -0.02")
        SubElement(parent, "geom", name=self.robot.name(side, "sole"), **foot)

    def arm(self, parent: Element, side: str, sign: float) -> None:
        position = (0.0, sign * 0.11, 0.18)
        for k, c in enumerate(self.robot.arm):
            part = f"shoulder_{WORDS[c]}" if k < 2 else f"elbow{k}_{WORDS[c]}"
            parent = self.joint(parent, side, part, c, position, 0.2)
            position = (0.0, 0.0, 0.0) if k == 0 else (0.0, 0.0, -0.12)
        self.capsule(parent, (0.0, 0.0, -0.1))

    def head(self, parent: Element) -> None:
        position = (0.0, 0.0, 0.24)
        for c in self.robot.head:
            parent = self.joint(parent, "", f"head_{WORDS[c]}", c, position, 0.15)
            position = (0.0, 0.0, 0.03)
        if self.robot.head:
            camera = {"pos": "0.04 0 0.03", "xyaxes": "0 -1 0 0 0 1"}
            SubElement(parent, "camera", name=self.robot.name("", "eye"), **camera)
            SubElement(parent, "geom", type="sphere", size="0.05", mass="0", contype="0")

    def joint(
        self,
        parent: Element,
        side: str,
        part: str,
        letter: str,
        position: tuple[float, float, float],
        mass: float,
        *,
        hip: bool = False,
    ) -> Element:
        """Add a body with a joint and its actuator."""
        robot, name = self.robot, self.robot.name(side, part)
        body = self.body(parent, name + "_link", position, mass)
        x, y, z = AXES[letter]
        if hip and letter != "p":
            c, s = cos(robot.oblique), sin(robot.oblique)
            x, z = c * x + s * z, c * z - s * x
        right = side == "r"
        lower, upper = RANGES.get(part, ARM_RANGE)
        if right and letter != "p":
            lower, upper = -upper, -lower
        if right and robot.flip:
            x, y, z, lower, upper = -x, -y, -z, -upper, -lower
        joint = Element("joint", name=name, axis=f"{x} {y} {z}", armature="0.01", damping="0.1")
        if robot.limited:
            joint.set("range", f"{lower} {upper}")
        body.insert(0, joint)
        if robot.actuator == "position":
            gains = {"kp": "300", "kv": "5", "forcerange": "-60 60"}
            SubElement(self.actuators, "position", name=name, joint=name, **gains)
        elif robot.actuator == "motor":
            SubElement(self.actuators, "motor", name=name, joint=name, ctrlrange="-60 60")
        return body

    def body(
        self, parent: Element, name: str, position: tuple[float, float, float], mass: float
    ) -> Element:
        body = SubElement(parent, "body", name=name, pos=" ".join(map(str, position)))
        mass *= self.robot.mass
        inertia = " ".join([str(2e-3 * mass)] * 3)
        SubElement(body, "inertial", pos="0 0 0", mass=str(mass), diaginertia=inertia)
        return body

    def capsule(self, body: Element, end: tuple[float, float, float]) -> None:
        x, y, z = end
        SubElement(
            body,
            "geom",
            type="capsule",
            size="0.02",
            fromto=f"0 0 0 {x} {y} {z}",
            mass="0",
            contype="0",
            conaffinity="0",
        )
