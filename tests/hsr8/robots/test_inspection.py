from xml.etree import ElementTree

import pytest

from hsr8.robots.inspection import inspect, load_inspected, touching_parts
from tests.hsr8.robots.robot_parts import part
from tests.hsr8.robots.small_humanoid import SmallHumanoid


@pytest.fixture
def loaded(tmp_path):
    """Write a changed robot and load it with its guessed description."""

    def load(change=lambda root: None, flip=False):
        root = SmallHumanoid(arm="prpp", flip=flip).element()
        change(root)
        file = tmp_path / "small.xml"
        file.write_text(ElementTree.tostring(root, "unicode"))
        return load_inspected(inspect(str(file)))

    return load


def findings(inspection, role):
    return [finding for finding in inspection.findings if finding.role == role]


def wide(root, size="0.06 0.1 0.04"):
    """Let the arms collide with the pelvis."""
    pelvis = part(root, "body", "base").find("geom")
    pelvis.attrib.update(size=size, contype="1", conaffinity="1")
    for side in "lr":
        hand = part(root, "body", f"{side}_elbow3_pitch_link").find("geom")
        hand.attrib.update(contype="1", conaffinity="1")


def test_a_robot_without_need_is_not_changed(loaded):
    inspection, robot = loaded()
    assert inspection.description == robot.description
    assert (inspection.description.posture, inspection.description.servo) == ({}, None)
    assert not findings(inspection, "posture") + findings(inspection, "servo")


@pytest.mark.parametrize("flip", [False, True])
def test_arms_that_touch_the_body_are_spread(loaded, flip):
    inspection, robot = loaded(wide, flip)
    posture = inspection.description.posture
    assert set(posture) == {"l_shoulder_roll", "r_shoulder_roll"}
    assert posture["l_shoulder_roll"] > 0.1
    assert posture["r_shoulder_roll"] == (1.0 if flip else -1.0) * posture["l_shoulder_roll"]
    (finding,) = findings(inspection, "posture")
    assert finding.reason == "the arms touch the body at zero angles"
    assert robot.description.posture == posture


def test_soft_servos_are_replaced_by_the_rule(loaded):
    def soften(root):
        for servo in root.iter("position"):
            servo.attrib.update(kp="5", kv="0.2")

    inspection, robot = loaded(soften)
    assert inspection.description.servo == "rule"
    (finding,) = findings(inspection, "servo")
    assert "of the stiffness that holds it upright" in finding.reason
    assert robot.model.stiffening == 1.0


def test_arms_that_touch_the_legs_while_walking_are_moved(loaded, monkeypatch):
    def close(root):
        for side, sign in (("l", 1.0), ("r", -1.0)):
            hand = part(root, "body", f"{side}_elbow3_pitch_link").find("geom")
            hand.attrib.update(contype="1", conaffinity="1")
            thigh = part(root, "body", f"{side}_hip_pitch_link").find("geom")
            thigh.attrib.update(contype="1", conaffinity="1")
            part(root, "body", f"{side}_shoulder_pitch_link").set("pos", f"0 {sign * 0.104} 0.04")

    monkeypatch.setattr("hsr8.robots.inspection.touching_parts", touching_parts)
    inspection, robot = loaded(close)
    (finding,) = (f for f in inspection.findings if f.role == "posture")
    assert finding.reason == "the arms touch the legs while walking"
    assert not touching_parts(robot)
