from dataclasses import replace

import pytest

from hsr8.robots.loaded import build_robot, load_robot
from hsr8.trials.robot_check import (
    DIRECTIONS,
    FRACTION,
    JointUse,
    WalkResult,
    check_robot,
    reasons,
)
from tests.hsr8.robots.robot_parts import described
from tests.hsr8.robots.small_humanoid import SmallHumanoid

GOOD = WalkResult("left", 0.1, fell=False, error=0.01, tilt=0.2, drift=None)
JOINT = JointUse("l_knee", 0.4, 0.5, 0.6, saturated=0.0, stopped=0.0, one_leg=0.3)


@pytest.fixture(scope="module")
def checked():
    reported = []
    walks, joints = check_robot(load_robot("hsr8"), reported.append, duration=3.8)
    assert reported == walks
    return walks, joints


def test_the_default_robot_stands_and_walks_in_every_direction(checked):
    walks, joints = checked
    assert [walk.direction for walk in walks] == list(DIRECTIONS)
    assert not reasons(walks, joints)
    limits = load_robot("hsr8").parameters.limits
    assert walks[1].speed == pytest.approx(FRACTION * limits.vx)
    assert walks[0].drift < 0.001
    assert all(walk.error < 0.02 for walk in walks[1:])
    assert all(walk.tilt < 1.0 for walk in walks)


def test_the_joints_are_sorted_by_their_use(checked):
    _, joints = checked
    assert {joint.joint for joint in joints} == set(load_robot("hsr8").model.names)
    assert [j.worst() for j in joints] == sorted((j.worst() for j in joints), reverse=True)
    legs = [joint for joint in joints if joint.one_leg is not None]
    assert len(legs) == 12
    for joint in legs:
        assert 0.0 < joint.torque <= 1.0
        assert 0.0 < joint.range < 1.0
        assert joint.one_leg < 0.5
        assert joint.saturated == joint.stopped == 0.0


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({}, None),
        ({"fell": True}, "left: fell"),
        ({"error": 0.3}, "left: velocity error 30%"),
        ({"error": None}, None),
    ],
)
def test_falls_and_wrong_velocities_are_reasons(change, reason):
    assert replace(GOOD, **change).reason() == reason
    assert reasons([replace(GOOD, **change)], [JOINT]) == ([reason] if reason else [])


def test_a_leg_too_weak_for_the_robot_is_a_reason():
    (reason,) = reasons([GOOD], [replace(JOINT, one_leg=1.2)])
    assert reason == "l_knee: 120% of its torque to carry the robot on one leg"


def test_limits_that_are_unknown_do_not_count():
    assert replace(JOINT, speed=None, range=None).worst() == 0.4


def test_a_robot_that_cannot_stand_does_not_walk(tmp_path):
    """Ankles far too soft for the weight, as in models meant for learned policies."""
    xml = SmallHumanoid().xml().replace('kp="300" kv="5"', 'kp="1" kv="0.05"')
    (tmp_path / "soft.xml").write_text(xml)
    robot = build_robot(described(SmallHumanoid(), model="soft.xml"), tmp_path / "soft.toml")
    walks, joints = check_robot(robot, duration=3.8)
    assert reasons(walks, joints) == ["stand: fell"]
