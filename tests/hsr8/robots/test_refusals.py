"""Each robot that cannot walk is refused by one message: element, reason, remedy."""

from xml.etree import ElementTree

import mujoco
import pytest

from hsr8.errors import ModelError
from hsr8.robots.checks.refusals import check_roles
from hsr8.robots.file.key_mistake import KeyMistake
from hsr8.robots.model.normal_form import dropped_options
from hsr8.robots.model.tree import driven_joints
from hsr8.robots.parts.roles import find_roles
from tests.hsr8.robots.robot_parts import (
    SOURCE,
    add_toes,
    adding,
    checked_roles,
    described,
    raw,
    removing,
    setting,
)
from tests.hsr8.robots.small_humanoid import SmallHumanoid

RULE = {"servo": "rule"}
RULE_REMEDY = 'or state servo = "rule"'


def refused(robot, description, *changes):
    with pytest.raises(ModelError) as caught:
        checked_roles(raw(robot, description, *changes), description)
    message = str(caught.value)
    assert isinstance(caught.value, KeyMistake) != message.startswith(f"{SOURCE}: ")
    assert "\n" not in message
    return message


EXCHANGED = {"feet": ("r_ankle_roll_link", "l_ankle_roll_link")}


@pytest.mark.parametrize(
    ("keys", "changes", "parts"),
    [
        # the base and the sides
        (EXCHANGED, [], ["feet: 'r_ankle_roll_link'", "left and right are exchanged"]),
        (
            {"zero": {"l_hip_pitch": -1.0, "r_hip_pitch": -1.0}},
            [],
            ["from the feet to the hips is 33 deg from the axes", "straight legs as zero"],
        ),
        (
            {},
            [setting("joint", f"{side}_knee", range="-2.2 0") for side in "lr"],
            ["the knees bend backward; expected forward: such legs are not supported"],
        ),
        # the legs
        (
            {},
            [setting("joint", "l_hip_roll", axis="0 1 0")],
            ["'l_hip_yaw' to 'l_ankle_roll', 4 joints pitch", "expected hip, knee and ankle"],
        ),
        ({}, [setting("joint", "l_knee", range="-0.2 0.6")], ["'l_knee': the knee cannot bend"]),
        (
            {},
            [setting("body", "r_knee_link", pos="0.02 0 -0.2")],
            ["joint 'r_knee': not the mirror image of 'l_knee'", "20 mm apart; expected at most"],
        ),
        (
            {},
            [setting("joint", f"{side}_hip_yaw", axis="1 0 0.01") for side in "lr"],
            ["cannot move its foot in all directions"],
        ),
        # head, shoulders, posture
        (
            {"head": ("head_pitch", "head_yaw")},
            [],
            ["head: pan joint 'head_pitch' does not yaw", "(0.00, 1.00, 0.00)"],
        ),
        (
            {"shoulders": ("r_shoulder_pitch", "l_shoulder_pitch")},
            [],
            ["shoulders: joints 'r_shoulder_pitch' and 'l_shoulder_pitch' do not", "exchanged"],
        ),
        (
            {"head": ("head_yaw", "head_pitch")},
            [setting("joint", "head_pitch", range="0.2 1")],
            ["joint 'head_pitch': the head cannot look ahead, got a range of 0.2 to 1 rad"],
        ),
        (
            {"camera": {"body": "l_knee_link", "position": (0.0, 0.0, 0.0)}},
            [],
            ["camera: body 'l_knee_link' moves with joint 'l_hip_yaw' of a leg or an arm"],
        ),
        # closed chains and couplings
        (
            {},
            [adding('<equality><weld name="rod" body1="l_knee_link" body2="torso"/></equality>')],
            ["equality 'rod': closed chain, a weld ties 'l_knee_link' and 'torso'", "remove it"],
        ),
        # actuators
        (
            {},
            [removing("position", "l_knee")],
            ["joint 'l_knee': no actuators", 'servo = "rule"'],
        ),
        (
            {},
            [setting("position", "l_knee", gear="50")],
            ["actuator 'l_knee' of joint 'l_knee': gear, got 50; expected 1", 'linkage = "serial"'],
        ),
        (
            {},
            [setting("position", "l_knee", timeconst="0.1")],
            ["actuator 'l_knee' of joint 'l_knee': has a state, got dynamics filter", RULE_REMEDY],
        ),
        (
            {"servo": "own"},
            [setting("joint", "l_knee", stiffness="20")],
            ["'l_knee': spring, got a stiffness of 20 N m/rad; expected at most 15", RULE_REMEDY],
        ),
    ],
)
def test_a_robot_that_cannot_walk_is_refused(keys, changes, parts):
    robot = SmallHumanoid()
    message = refused(robot, described(robot, **keys), *changes)
    for text in parts:
        assert text in message


@pytest.mark.parametrize("actuator", ["motor", ""])
def test_torque_motors_are_refused_only_where_own_servos_are_requested(actuator):
    robot = SmallHumanoid(actuator=actuator)
    for keys in ({}, RULE, {"servo": {"compliance": 0.2}}):
        keyed = described(robot, **keys)
        checked_roles(raw(robot, keyed), keyed)
    message = refused(robot, described(robot, servo="own"))
    assert "l_hip_yaw" in message
    assert 'servo = "rule"' in message


@pytest.mark.parametrize(
    "section",
    [
        '<equality><weld body1="l_knee_link" body2="torso" active="false"/></equality>',
        '<equality><joint joint1="l_shoulder_roll" joint2="r_shoulder_roll"/></equality>',
        '<tendon><fixed name="belt"><joint joint="l_knee" coef="1"/></fixed></tendon>',
    ],
)
def test_ties_that_do_not_move_legs_are_accepted(section):
    robot = SmallHumanoid()
    checked_roles(raw(robot, described(robot), adding(section)), described(robot))


def test_zero_angles_straighten_a_robot_that_is_drawn_sitting():
    robot = SmallHumanoid()
    joints = {"hip_pitch": 0.4, "knee": -0.8, "ankle_pitch": 0.4}
    turns = [
        setting("body", f"{side}_{name}_link", quat=f"{1 - angle**2 / 8} 0 {-angle / 2} 0")
        for side in "lr"
        for name, angle in joints.items()
    ]
    shift = [
        setting("joint", f"{side}_{name}", range=f"{-2 + angle} {2 + angle}")
        for side in "lr"
        for name, angle in joints.items()
    ]
    zero = {f"{side}_{name}": angle for side in "lr" for name, angle in joints.items()}
    keys = described(robot, zero=zero)
    checked_roles(raw(robot, keys, *turns, *shift), keys)


@pytest.mark.parametrize("side", "lr")
@pytest.mark.parametrize("flip", [False, True])
def test_mirrored_ranges_that_differ_are_intersected(side, flip):
    robot = SmallHumanoid(flip=flip)
    lower, upper = (0.0, 2.0) if side == "l" or not flip else (-2.0, 0.0)
    change = setting("joint", f"{side}_knee", range=f"{lower} {upper}")
    keys = described(robot)
    read = raw(robot, keys, change)
    roles = find_roles(read.model, keys, read.prepared)
    ranges, notes = check_roles(read.model, roles, keys, SOURCE)
    right = (-2.0, 0.0) if flip else (0.0, 2.0)
    assert ranges == {"l_knee": pytest.approx((0.0, 2.0)), "r_knee": pytest.approx(right)}
    assert notes[0].startswith("ranges of 'l_knee' and 'r_knee' differ by 0.20 rad: the common")


def test_a_servo_in_the_parent_drives_its_joint():
    def in_parent(root):
        for servo in root.iter("position"):
            servo.set("jointinparent", servo.attrib.pop("joint"))

    robot = SmallHumanoid()
    keys = described(robot)
    read = raw(robot, keys, in_parent)
    roles = checked_roles(read, keys)
    assert driven_joints(read.model, roles)[:6] == roles.legs[0]


@pytest.mark.parametrize("hip", ["yrp"])
@pytest.mark.parametrize("ankle", ["pr"])
def test_a_foot_behind_a_toe_joint_is_named(hip, ankle):
    robot = SmallHumanoid(hip=hip, ankle=ankle, actuator="")
    toes = ("l_toe_link", "r_toe_link")
    message = refused(robot, described(robot, feet=toes), add_toes(robot))
    assert "'l_toe_link' is behind the toe joint 'l_toe'; expected the foot itself" in message
    assert repr(robot.feet()[0]) in message


def test_options_of_the_model_that_are_replaced_are_noted(tmp_path):
    def options(root):
        root.find("option").attrib.update(cone="elliptic", impratio="10", gravity="0 0 -3.7")

    root = SmallHumanoid().element()
    options(root)
    spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, "unicode"))
    (note,) = dropped_options(spec)
    assert note.endswith("simulator: cone elliptic, gravity 0 0 -3.7, impratio 10")
    assert not list(dropped_options(mujoco.MjSpec.from_string(SmallHumanoid().xml())))
