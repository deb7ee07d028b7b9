from dataclasses import replace

import numpy as np
import pytest

from hsr8.robots.loaded import build_robot, load_robot
from hsr8.trials import robot_check
from hsr8.trials.robot_check import (
    DIRECTIONS,
    FRACTION,
    JointUse,
    WalkResult,
    check_robot,
    reasons,
)
from hsr8.trials.walk import Trial
from tests.hsr8.robots.robot_parts import described
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from walking.command import VelocityCommand

SEEDS = range(2)  # of walks under random commands
GOOD = WalkResult("left", 0.1, fell=False, error=0.01, tilt=0.2, drift=None, limit="l_knee weak")
JOINT = JointUse("l_knee", 0.4, 0.5, 0.6, saturated=0.0, stopped=0.0, one_leg=0.3)


@pytest.fixture(scope="module")
def checked():
    reported = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(robot_check, "RANDOM_SEEDS", SEEDS)
        patch.setattr(robot_check, "RANDOM_WALKS", 1.0)
        walks, joints = check_robot(load_robot("hsr8"), reported.append, duration=3.8)
    assert reported == walks
    return walks, joints


def test_the_default_robot_stands_and_walks_in_every_direction(checked):
    walks, joints = checked
    random = [f"random {seed + 1}" for seed in SEEDS]
    assert [walk.direction for walk in walks] == [*DIRECTIONS, *random]
    assert not reasons(load_robot("hsr8"), walks, joints)
    limits = load_robot("hsr8").parameters.limits
    assert walks[1].speed == pytest.approx(FRACTION * limits.vx)
    assert walks[0].drift < 0.001
    steady = walks[1 : len(DIRECTIONS)]
    assert all(walk.error < 0.02 for walk in steady)
    assert all(walk.tilt < 1.0 for walk in steady)


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
        assert joint.saturated < 1e-3
        assert joint.stopped == 0.0


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({}, None),
        ({"fell": True}, "left: fell, l_knee weak"),
        ({"error": 0.3}, "left: velocity error 30%, l_knee weak"),
        ({"error": None}, None),
        ({"tilt": 12.0}, "left: tilt 12 deg, l_knee weak"),
    ],
)
def test_falls_and_wrong_velocities_are_reasons(change, reason):
    assert replace(GOOD, **change).reason() == reason
    robot = load_robot("hsr8")
    remedy = "`hsr8 robot calibrate` finds speeds at which it does not fall"
    others = [remedy] * bool({"fell", "tilt"} & {*change})
    found = reasons(robot, [replace(GOOD, **change)], [JOINT])
    assert found == ([reason, *others] if reason else [])


def test_a_leg_too_weak_for_the_robot_is_a_reason():
    (reason,) = reasons(load_robot("hsr8"), [GOOD], [replace(JOINT, one_leg=1.2)])
    assert reason == "l_knee: 120% of its torque to carry the robot on one leg"


def test_limits_that_are_unknown_do_not_count():
    assert replace(JOINT, speed=None, range=None).worst() == 0.4
    assert replace(JOINT, torque=None, speed=None, range=None).worst() == 0.0


def test_a_robot_that_cannot_stand_does_not_walk(tmp_path):
    """Ankles far too soft for the weight, as in models meant for learned policies."""
    xml = SmallHumanoid().xml().replace('kp="300" kv="5"', 'kp="1" kv="0.05"')
    (tmp_path / "soft.xml").write_text(xml)
    robot = build_robot(described(SmallHumanoid(), model="soft.xml"), tmp_path / "soft.toml")
    walks, joints = check_robot(robot, duration=3.8)
    fall, remedy = reasons(robot, walks, joints)
    assert fall.startswith("stand: fell, ")
    assert remedy == 'the servos of the model do not hold it: state servo = "rule"'


def test_the_joint_at_its_limit_is_named():
    model, n = load_robot("hsr8").model, 1000
    zeros = np.zeros(len(model.names), dtype=int)
    walk = Trial(load_robot("hsr8")).walk(VelocityCommand(), 0.1)
    knee, ankle = (model.names.index(name) for name in ("l_knee", "r_ankle_roll"))

    def limited(**changes):
        saturation = replace(walk.saturation, torque_ticks=zeros, stop_ticks=zeros, **changes)
        return replace(walk, saturation=saturation, poses=np.zeros((n, 3))).limit(model)

    assert limited() == "no joint at a limit"
    speeds = np.zeros(len(zeros))
    speeds[ankle] = 0.95 * model.tree.speed[ankle]
    assert limited(peak_speed=speeds) == "r_ankle_roll at 95% of its maximum speed of 60 rad/s"
    stops = zeros.copy()
    stops[knee] = 340
    saturation = replace(walk.saturation, torque_ticks=zeros, stop_ticks=stops)
    stopped = replace(walk, saturation=saturation, poses=np.zeros((n, 3)))
    assert stopped.limit(model) == "l_knee at the end of its range for 34% of the walk"
    torques = zeros.copy()
    torques[ankle] = 500
    saturation = replace(walk.saturation, torque_ticks=torques, stop_ticks=stops)
    weak = replace(walk, saturation=saturation, poses=np.zeros((n, 3)))
    text = "r_ankle_roll at its maximum torque of 6 N m for 50% of the walk"
    assert weak.limit(model) == text
