"""Each URDF file that cannot become a robot is refused by one message: element, reason, remedy."""

from xml.etree.ElementTree import SubElement

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError
from hsr8.robots.urdf import convert
from hsr8.robots.urdf_compare import compare_with_file
from tests.hsr8.robots.small_urdf import SmallUrdf, describe, joint, link, write


def add_joint(robot, kind, parent, child):
    added = SubElement(robot, "joint", name="added", type=kind)
    SubElement(added, "parent", link=parent)
    SubElement(added, "child", link=child)


def set_type(name, kind):
    return lambda robot: joint(robot, name).set("type", kind)


def set_limit(name, **limits):
    return lambda robot: joint(robot, name).find("limit").attrib.update(limits)


def set_dynamics(name, **values):
    return lambda robot: joint(robot, name).find("dynamics").attrib.update(values)


def set_origin(name, xyz):
    return lambda robot: joint(robot, name).find("origin").set("xyz", xyz)


def set_inertia(name, **moments):
    return lambda robot: link(robot, name).find("inertial/inertia").attrib.update(moments)


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


def shared_hip(robot):
    for side in "lr":
        joint(robot, f"{side}_ankle_roll").set("type", "fixed")
        joint(robot, f"{side}_hip_yaw").find("parent").set("link", "chest")


def bare_foot(robot):
    foot = link(robot, "l_foot")
    for shape in [*foot.findall("visual"), *foot.findall("collision")]:
        foot.remove(shape)


def set_sole(size, feet=("l_foot", "r_foot")):
    def change(robot):
        for foot in feet:
            for box in link(robot, foot).iter("box"):
                box.set("size", size)

    return change


def mesh_foot(robot):
    for geometry in link(robot, "l_foot").iter("geometry"):
        geometry.remove(geometry[0])
        SubElement(geometry, "mesh", filename="package://small_description/foot.stl")


def no_limits(name):
    return lambda robot: joint(robot, name).remove(joint(robot, name).find("limit"))


def mimic_stranger(robot):
    SubElement(joint(robot, "l_elbow"), "mimic", joint="stranger")


def no_mass(robot):
    for element in robot.findall("link"):
        if element.find("inertial") is not None:
            element.remove(element.find("inertial"))


def unchanged(_robot):
    pass


@pytest.mark.parametrize(
    ("change", "keys", "element", "remedy"),
    [
        (
            unchanged,
            {"feet": ["l_fot", "r_foot"]},
            "no link 'l_fot'; did you mean 'l_foot'",
            "feet: left foot: the model has",
        ),
        (
            unchanged,
            {"head": ["head_yaw", "nod"]},
            "head: the model has no hinge joint 'nod'",
            "one of",
        ),
        (
            unchanged,
            {"shoulders": ["l_sholder", "r_shoulder"]},
            "did you mean 'l_shoulder'",
            "shoulders: the model has no hinge joint",
        ),
        (
            unchanged,
            {"posture": {"wist": 1.0}},
            "posture: the model has no hinge joint 'wist'",
            "'waist'",
        ),
        (
            unchanged,
            {"rigid": ["imu_fixed"]},
            "rigid: the model has no hinge joint 'imu_fixed'",
            "one of",
        ),
        (
            unchanged,
            {"zero": {"r_kne": 1.0}},
            "zero: the model has no hinge joint 'r_kne'",
            "'r_knee'",
        ),
        (
            unchanged,
            {"effort": {"nothing": 1.0}},
            "effort: the model has no hinge joint 'nothing'",
            "one of",
        ),
        (unchanged, {"servo": "own"}, "URDF file has no servos", "'rule'"),
        (
            unchanged,
            {"base": "head"},
            "base: not fixed to the root, got 'head'",
            "leave the key out",
        ),
        (
            unchanged,
            {"camera": "eye"},
            "camera: a URDF file has no cameras, got 'eye'",
            "{body, position, tilt_deg}",
        ),
        (unchanged, {"packages": {"p": "missing"}}, "packages.p: not a folder", "package's folder"),
        (unchanged, {"feet": ["l_foot", "l_ankle_roll_link"]}, "legs share 6 joints", "last link"),
        (
            unchanged,
            {"sole": ["none", "none"]},
            "sole: foot 'l_foot' has no shape or link 'none'",
            "its named shapes",
        ),
        (unchanged, {"zero": {"l_hip_roll": 0.7}}, "zero: the direction", "state in `zero`"),
        (five_joints, {}, "leg of 'l_foot': 5 joints", "six driven joints"),
        (shared_hip, {}, "legs share 1 joints, got waist", "six separate joints"),
        (set_type("l_knee", "prismatic"), {}, "l_knee: prismatic", "six driven joints"),
        (set_limit("l_knee", lower="0", upper="0"), {}, "l_knee: range of zero", "six driven"),
        (
            set_limit("l_knee", lower="1", upper="0"),
            {},
            "joint 'l_knee': lower limit above",
            "1 .. 0",
        ),
        (no_limits("l_knee"), {}, "joint 'l_knee': no limits", "<limit lower="),
        (close_chain, {}, "link 'l_foot': closed chain", "remove one of the joints"),
        (ring, {}, "closed chain, it is its own ancestor", "expected a tree"),
        (set_type("waist", "planar"), {}, "joint 'waist' of type planar", "make it fixed"),
        (set_type("waist", "floating"), {}, "joint 'waist' of type floating", "make it fixed"),
        (add_root, {}, "2 root links, got pelvis, other", "one link without a parent"),
        (
            set_inertia("l_knee_link", ixy="1"),
            {},
            "link 'l_knee_link': inertia is not",
            "the signs",
        ),
        (
            set_inertia("l_knee_link", ixx="1"),
            {},
            "'l_knee_link': inertia of no rigid",
            "<inertia>",
        ),
        (set_inertia("l_knee_link", ixx="x"), {}, "link 'l_knee_link': ixx, got 'x'", "a number"),
        (set_dynamics("l_knee", damping="-1"), {}, "'l_knee': damping, got -1", "expected >= 0"),
        (set_dynamics("l_knee", friction="inf"), {}, "'l_knee': friction, got inf", "expected >="),
        (set_origin("l_knee", "0 0 -9"), {}, "joint 'l_knee': origin, got", "at most 5 m"),
        (no_mass, {}, "l_hip_yaw: moves no mass", "six driven joints"),
        (bare_foot, {}, "sole: foot 'l_foot' has no shape", "state `sole`"),
        (mesh_foot, {}, "mesh not found, got 'package://small_description/foot.stl'", "`packages`"),
        (set_sole("0.16 0.004 0.02"), {}, "sole: foot 'l_foot' has 16.0 x 0.4 cm", "else `sole`"),
        (set_sole("0.16 0.14 0.02", ["l_foot"]), {}, "are not mirror images", "state `sole`"),
        (mimic_stranger, {}, "joint 'l_elbow': mimic, got 'stranger'", "another joint"),
        (set_limit("head_yaw", effort="x"), {}, "joint 'head_yaw': effort, got 'x'", "a number"),
        (
            set_type("l_shoulder", "prismatic"),
            {"shoulders": ["l_shoulder", "r_shoulder"]},
            "shoulders: joint 'l_shoulder' cannot move: prismatic",
            "leave the key out",
        ),
    ],
)
def test_refusal(change, keys, element, remedy, tmp_path):
    robot = SmallUrdf().element()
    change(robot)
    file = write(robot, tmp_path)
    with pytest.raises(ModelError) as refusal:
        convert(file, describe(**keys), tmp_path)
    message = str(refusal.value)
    assert element in message
    assert remedy in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot", "cannot be read"),
        ("<mujoco/>", "not a URDF file, got the element <mujoco>"),
        ("<robot><xacro:macro/></robot>", "cannot be read"),
        (
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:macro/></robot>",
            "a xacro file",
        ),
        ("<robot/>", "0 root links"),
        ("<robot><link name='a'/><link name='a'/></robot>", "link 'a' appears twice"),
    ],
)
def test_file_that_is_not_a_robot(text, reason, tmp_path):
    file = tmp_path / "small.urdf"
    file.write_text(text)
    with pytest.raises(ModelError, match=reason):
        convert(file, describe(), tmp_path)


def test_missing_file(tmp_path):
    with pytest.raises(ModelError, match="cannot be read"):
        convert(tmp_path / "missing.urdf", describe(), tmp_path)


@pytest.mark.parametrize(
    ("tamper", "quantity"),
    [
        (lambda m: np.multiply(m.body_mass, 1.00001, out=m.body_mass), "mass changed"),
        (lambda m: np.add(m.body_ipos, (1e-3, 0, 0), out=m.body_ipos), "CoM changed"),
        (lambda m: m.body_pos.__setitem__((m.body("l_elbow_link").id, 1), 0.02), "'l_elbow' ch"),
        (lambda m: m.jnt_axis.__setitem__(m.joint("l_knee").id, (0, -1, 0)), "changed in conv"),
    ],
)
def test_a_model_that_differs_from_its_file_is_refused(tamper, quantity, tmp_path):
    file = write(SmallUrdf().element(), tmp_path)
    model = convert(file, describe(), tmp_path).spec.compile()
    compare_with_file(model, file, "pelvis", np.eye(3), {})
    tamper(model)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    with pytest.raises(ModelError, match=quantity):
        compare_with_file(model, file, "pelvis", np.eye(3), {})


def test_a_root_that_is_not_turned_by_quarters_is_refused(tmp_path):
    root = Rotation.from_euler("z", 30, degrees=True)
    file = write(SmallUrdf(root=root).element(), tmp_path)
    with pytest.raises(ModelError, match=r"30 deg from its axes; expected at most 5 deg"):
        convert(file, describe(), tmp_path)
