"""Each robot that cannot walk is refused by one message: element, reason, remedy."""

import pytest

from hsr8.errors import ModelError
from hsr8.robots.key_mistake import KeyMistake
from tests.hsr8.robots.robot_parts import (
    SOURCE,
    adding,
    checked_roles,
    compiled,
    described,
    part,
    removing,
    setting,
)
from tests.hsr8.robots.small_humanoid import SmallHumanoid

BACKWARD = {f"{side}_knee": ("joint", {"range": "-2.2 0"}) for side in "lr"}
RULE = {"servo": "rule"}


def turned(quat):
    """Turn of the whole robot in its base."""

    def change(root):
        base = part(root, "body", "base")
        inner = base.makeelement("body", {"name": "inner", "quat": quat})
        for child in list(base):
            if child.tag != "freejoint":
                base.remove(child)
                inner.append(child)
        base.append(inner)

    return change


def all_of(*changes):
    def change(root):
        for one in changes:
            one(root)

    return change


def refused(robot, description, *changes):
    model = compiled(robot, *changes)
    with pytest.raises(ModelError) as caught:
        checked_roles(model, description)
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
        ({}, [turned("0 0 0 1")], ["the knees bend backward", "expected x forward"]),
        ({**EXCHANGED}, [turned("0 0 0 1")], ["joint 'r_knee': the knee cannot bend", "exchanged"]),
        ({}, [turned("0.7071 0 0 0.7071")], ["x is not forward", "(-1.00, 0.00, 0.00)"]),
        ({}, [turned("0.7071 0 0.7071 0")], ["body 'base': z is not up", "turn its frame"]),
        ({"zero": {"l_hip_pitch": -1.6, "r_hip_pitch": -1.6}}, [], ["z is not up"]),
        # the legs
        (
            {},
            [setting("joint", "l_hip_roll", axis="0 1 0")],
            ["'l_hip_yaw' to 'l_ankle_roll', 4 joints pitch", "expected hip, knee and ankle"],
        ),
        ({}, [setting("joint", "l_knee", range="-2.2 0.1")], ["'l_knee': the knee cannot bend"]),
        ({}, [setting("joint", "r_hip_pitch", range="0 1")], ["'r_hip_pitch': the hip cannot"]),
        ({}, [setting("joint", "r_ankle_pitch", range="-.2 1")], ["'r_ankle_pitch': the ankle"]),
        (
            {},
            [setting("body", "r_knee_link", pos="0.02 0 -0.2")],
            ["joint 'r_knee': not the mirror image of 'l_knee'", "20.0 mm apart; expected at most"],
        ),
        (
            {},
            [setting("joint", "r_hip_roll", axis="1 0.1 0")],
            ["joint 'r_hip_roll': not the mirror image", "axes differ by 5.7 deg"],
        ),
        (
            {},
            [setting("joint", "r_hip_yaw", range="-0.5 0.5")],
            ["joint 'r_hip_yaw': not the mirror image", "ranges differ by 0.40 rad"],
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
            {"head": ("head_yaw", "head_pitch")},
            [setting("joint", "head_pitch", axis="1 0 0")],
            ["head: tilt joint 'head_pitch' does not pitch"],
        ),
        (
            {"shoulders": ("l_shoulder_roll", "r_shoulder_roll")},
            [],
            ["shoulders: joint 'l_shoulder_roll' does not pitch", "name the joint that does"],
        ),
        (
            {"shoulders": ("r_shoulder_pitch", "l_shoulder_pitch")},
            [],
            ["shoulders: joints 'r_shoulder_pitch' and 'l_shoulder_pitch' do not", "exchanged"],
        ),
        (
            {"shoulders": ("head_pitch", "r_shoulder_pitch")},
            [],
            ["shoulders: joints 'head_pitch' and", "got masses 0.00 and -0.11 m to the left of th"],
        ),
        (
            {"head": ("head_yaw", "l_shoulder_pitch")},
            [],
            ["head: joints 'head_yaw' and 'l_shoulder_pitch' move different parts; expected"],
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
        (
            {"camera": {"body": "torso", "position": (0.0, 0.0, 1.0)}},
            [],
            ["camera.position: far from the body, got 1.00 m; expected at most 0.80"],
        ),
        (
            {"shoulders": ("l_hip_pitch", "r_hip_pitch")},
            [],
            ["shoulders: joint 'l_hip_pitch' belongs to a leg; expected a joint above the legs"],
        ),
        (
            {"head": ("l_hip_yaw", "head_pitch")},
            [],
            ["head: pan joint 'l_hip_yaw' belongs to a leg"],
        ),
        (
            {"posture": {"l_shoulder_roll": 2.5}},
            [],
            ["posture.l_shoulder_roll: outside the range", "got 2.5 rad; expected -2 to 2"],
        ),
        ({"zero": {"l_knee": -0.5}}, [], ["zero.l_knee: outside the range of the joint"]),
        ({"posture": {"l_knee": 0.5}}, [], ["posture.l_knee: a joint of the leg", "leave it out"]),
        (
            {"head": ("head_yaw", "head_pitch"), "posture": {"head_yaw": 0.5}},
            [],
            ["posture.head_yaw: a joint of the head"],
        ),
        # closed chains and couplings
        (
            {},
            [adding('<equality><weld name="rod" body1="l_knee_link" body2="torso"/></equality>')],
            ["equality 'rod': closed chain, a weld ties 'l_knee_link' and 'torso'", "remove it"],
        ),
        (
            {},
            [adding('<equality><connect body1="base" anchor="0 0 0"/></equality>')],
            ["equality '#0': closed chain, a connect ties 'base' and the world"],
        ),
        (
            {},
            [
                adding(
                    '<equality><joint name="rod" joint1="l_knee" joint2="l_hip_roll"/></equality>'
                )
            ],
            ["equality 'rod': couples joint 'l_hip_roll' of a leg"],
        ),
        (
            RULE,
            [
                adding(
                    '<tendon><fixed name="belt"><joint joint="l_knee" coef="1"/></fixed></tendon>'
                ),
                lambda root: root.find("actuator").append(
                    root.makeelement("motor", {"tendon": "belt"})
                ),
            ],
            ["tendon 'belt': drives joint 'l_knee' of a leg", 'servo = "rule"'],
        ),
        # actuators
        (
            {},
            [removing("position", "l_knee")],
            ["joint 'l_knee': no actuators", 'servo = "rule"'],
        ),
        (
            {"head": ("head_yaw", "head_pitch")},
            [removing("position", "head_yaw")],
            ["joint 'head_yaw': no actuators"],
        ),
        (
            {},
            [
                lambda root: root.find("actuator").append(
                    root.makeelement("position", {"joint": "l_knee", "kp": "1"})
                )
            ],
            ["joint 'l_knee': 2 actuators; expected one position servo"],
        ),
        (
            {},
            [setting("position", "l_knee", gear="50")],
            ["actuator 'l_knee' of joint 'l_knee': gear, got 50; expected 1"],
        ),
        (
            {},
            [setting("position", "l_knee", forcerange="1 60")],
            ["actuator 'l_knee': forcerange, got 1 60; expected 0 in it"],
        ),
        (
            {},
            [
                removing("position", "l_elbow2_pitch"),
                lambda root: root.find("actuator").append(
                    root.makeelement("motor", {"joint": "l_elbow2_pitch", "name": "m"})
                ),
            ],
            ["actuator 'm' of joint 'l_elbow2_pitch': not a position servo"],
        ),
    ],
)
def test_a_robot_that_cannot_walk_is_refused(keys, changes, parts):
    robot = SmallHumanoid()
    message = refused(robot, described(robot, **keys), *changes)
    for text in parts:
        assert text in message


def test_without_ranges_both_causes_of_exchanged_sides_are_named():
    robot = SmallHumanoid(limited=False)
    message = refused(robot, described(robot, **EXCHANGED))
    assert "exchanged" in message
    assert "backward" in message


def test_joints_without_limits_are_accepted():
    robot = SmallHumanoid(limited=False)
    checked_roles(compiled(robot), described(robot))


@pytest.mark.parametrize("actuator", ["motor", ""])
def test_torque_motors_are_refused_only_where_own_servos_are_requested(actuator):
    robot = SmallHumanoid(actuator=actuator)
    model = compiled(robot)
    for keys in ({}, RULE, {"servo": {"compliance": 0.2}}):
        checked_roles(model, described(robot, **keys))
    message = refused(robot, described(robot, servo="own"))
    assert "l_hip_yaw" in message
    assert 'servo = "rule"' in message


def test_a_negative_inertia_is_refused():
    robot = SmallHumanoid()
    model = compiled(robot)
    model.body_inertia[model.body("torso").id, 1] = -1e-3
    with pytest.raises(ModelError, match="body 'torso': inertia is not positive"):
        checked_roles(model, described(robot))
    model = compiled(robot)
    model.body_mass[model.body("torso").id] = -1.0
    with pytest.raises(ModelError, match="body 'torso': mass, got -1 kg"):
        checked_roles(model, described(robot))


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
    checked_roles(compiled(robot, adding(section)), described(robot))


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
    checked_roles(compiled(robot, *turns, *shift), described(robot, zero=zero))
