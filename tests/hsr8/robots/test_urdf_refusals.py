"""One message for each URDF file that is not a robot."""

from xml.etree.ElementTree import SubElement

import pytest

from hsr8.errors import ModelError
from hsr8.robots.loaded import read_robot
from tests.hsr8.robots.small_urdf import SmallUrdf, built, describe, joint, link, write


def add_joint(robot, kind, parent, child):
    added = SubElement(robot, "joint", name="added", type=kind)
    SubElement(added, "parent", link=parent)
    SubElement(added, "child", link=child)


def set_limit(name, **limits):
    return lambda robot: joint(robot, name).find("limit").attrib.update(limits)


def set_inertia(name, **moments):
    return lambda robot: link(robot, name).find("inertial/inertia").attrib.update(moments)


def set_mass(name, value):
    return lambda robot: link(robot, name).find("inertial/mass").set("value", value)


def add_root(robot):
    SubElement(robot, "link", name="other")


def close_chain(robot):
    add_joint(robot, "fixed", "r_foot", "l_foot")


def ring(robot):
    for parent, child in (("a", "b"), ("b", "a")):
        SubElement(robot, "link", name=child)
        add_joint(robot, "fixed", parent, child)
        robot[-1].set("name", child)


def five_joints(robot):
    for side in "lr":
        joint(robot, f"{side}_ankle_roll").set("type", "fixed")


def bare_foot(robot):
    foot = link(robot, "l_foot")
    for shape in [*foot.findall("visual"), *foot.findall("collision")]:
        foot.remove(shape)


def set_sole(size):
    def change(robot):
        for foot in ("l_foot", "r_foot"):
            for box in link(robot, foot).iter("box"):
                box.set("size", size)

    return change


def no_limits(name):
    return lambda robot: joint(robot, name).remove(joint(robot, name).find("limit"))


def unchanged(_robot):
    pass


@pytest.mark.parametrize(
    ("change", "keys", "element", "remedy"),
    [
        (
            unchanged,
            {"feet": ["l_fot", "r_foot"]},
            "no body 'l_fot'; did you mean 'l_foot'",
            "feet: left foot: the model has",
        ),
        (unchanged, {"servo": "own"}, "URDF file has no servos", "'rule'"),
        (five_joints, {}, "above foot 'l_foot' has 5 hinge joints", "6 hinge joints per leg"),
        (set_limit("l_knee", lower="0", upper="0"), {}, "l_knee: range of zero", "6 hinge joints"),
        (no_limits("l_knee"), {}, "joint 'l_knee': limits are missing", "<limit lower="),
        (close_chain, {}, "link 'l_foot': closed chain", "remove one of the joints"),
        (ring, {}, "closed chain, it is its own ancestor", "expected a tree"),
        (add_root, {}, "2 root links, got pelvis, other", "one link without a parent"),
        (set_inertia("l_knee_link", ixy="1"), {}, "got 1 body with principal moments", "repair_in"),
        (set_mass("l_knee_link", "-1"), {}, "link 'l_knee_link': mass, got -1 kg", "0 or more"),
        (bare_foot, {}, "sole: missing, and foot 'l_ankle_roll_link' has no shape", "{front, back"),
        (set_sole("0.16 0.004 0.02"), {}, "got 160 x 4 mm; expected at least 16 mm", "state sole"),
    ],
)
def test_refusal(change, keys, element, remedy, tmp_path):
    robot = SmallUrdf().element()
    change(robot)
    with pytest.raises(ModelError) as refusal:
        built(robot, tmp_path, **keys)
    message = str(refusal.value)
    assert element in message
    assert remedy in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot", "cannot be read"),
        ("<mujoco/>", "not a URDF file, got the element <mujoco>"),
        (
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:macro/></robot>",
            "a xacro file",
        ),
        ("<robot/>", "0 root links"),
        ("<robot><link name='a'/><link name='a'/></robot>", "link 'a' appears twice"),
    ],
)
def test_file_that_is_not_a_robot(text, reason, tmp_path):
    write(SmallUrdf().element(), tmp_path).write_text(text)
    with pytest.raises(ModelError, match=reason):
        read_robot(describe(), tmp_path / "small.toml")
