import re
from xml.etree import ElementTree

import mujoco
import pytest

from hsr8.errors import ModelError
from hsr8.robots.loaded import build_robot
from hsr8.robots.mjcf import read_mjcf
from tests.hsr8.robots.robot_parts import described, part, setting
from tests.hsr8.robots.small_humanoid import SmallHumanoid

BALL = """
<body name="ball" pos="1 0 1"><joint name="roll" type="hinge"/><geom size="0.1"/></body>
"""
FREE_BALL = '<body pos="1 0 1"><freejoint/><geom size="0.1"/></body>'


@pytest.fixture
def read(tmp_path):
    """Write a changed robot and read it."""

    def read_changed(change, foot=""):
        root = SmallHumanoid(actuator="").element()
        change(root)
        file = tmp_path / "small.xml"
        file.write_text(ElementTree.tostring(root, "unicode"))
        return read_mjcf(file, foot).compile()

    return read_changed


def option(**values):
    return lambda root: root.find("option").attrib.update(values)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (option(timestep="0"), "option: timestep, got 0 s; expected at least 1e-05"),
        (option(timestep="nan"), "option: timestep, got nan s"),
        (
            setting("joint", "l_knee", range="nan nan"),
            "joint 'l_knee': range, got nan nan; expecte",
        ),
        (
            setting("joint", "l_knee", damping="inf"),
            "joint 'l_knee': damping, got inf; expected fi",
        ),
        (
            setting("joint", "l_knee", damping="-1"),
            "joint 'l_knee': damping, got -1; expected >= 0",
        ),
        (setting("joint", "l_knee", stiffness="-1"), "'l_knee': stiffness, got -1; expected >= 0"),
        (
            setting("body", "torso", pos="inf 0 0"),
            "body 'torso': pos, got inf 0 0; expected finite",
        ),
        (setting("body", "torso", pos="0 0 1e9"), "body 'torso': 1e+09 m from the body that carr"),
    ],
)
def test_numbers_that_are_not_those_of_a_robot_are_refused(read, change, reason):
    with pytest.raises(ValueError, match=re.escape(reason)):
        read(change)


def names(model):
    bodies = [model.body(b).name for b in range(model.nbody)]
    return bodies, [model.joint(j).name for j in range(model.njnt)]


def test_parts_without_a_name_get_one(read):
    def remove_names(root):
        for tag in ("body", "joint"):
            for element in list(root.iter(tag))[::2]:
                element.attrib.pop("name", None)
        part(root, "body", "torso").set("name", "body_1")

    bodies, joints = names(read(remove_names))
    assert len({*bodies}) == len(bodies)
    assert len({*joints}) == len(joints)
    assert "body_1" in bodies
    assert "unnamed_body_1" in bodies
    assert all(bodies)
    assert all(joints)


def test_names_of_the_file_remain(read):
    assert names(read(lambda root: None)) == names(
        mujoco.MjModel.from_xml_string(SmallHumanoid(actuator="").xml())
    )


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize("ball", [BALL, FREE_BALL])
def test_other_moving_bodies_are_left_out(read, ball, first):
    def add(root):
        root.find("worldbody").insert(0 if first else 1, ElementTree.fromstring(ball))
        if ball == BALL:
            sensor = ElementTree.SubElement(root, "sensor")
            ElementTree.SubElement(sensor, "jointpos", joint="roll")
            ElementTree.SubElement(root.find("actuator"), "motor", joint="roll")

    model = read(add)
    assert names(model) == names(read(lambda root: None))
    assert (model.nu, model.nsensor) == (0, 0)


def test_the_robot_is_that_of_the_foot(read):
    def twin(root):
        other = SmallHumanoid(actuator="", name=lambda side, name: f"b{side}_{name}").element()
        for body in other.iter("body"):
            body.set("name", "b_" + body.get("name"))
        for joint in other.iter("freejoint"):
            joint.set("name", "b_root")
        root.find("worldbody").append(other.find("worldbody").find("body"))

    assert "base" in names(read(twin))[0]
    bodies, _ = names(read(twin, "b_bl_knee_link"))
    assert "b_base" in bodies
    assert "base" not in bodies


def test_a_leg_too_weak_for_the_robot_is_refused(tmp_path):
    (tmp_path / "robot.xml").write_text(SmallHumanoid(mass=15).xml())
    with pytest.raises(
        ModelError, match="knee': too weak to carry the robot on one leg, got a max"
    ):
        build_robot(described(SmallHumanoid()), tmp_path / "robot.toml")
