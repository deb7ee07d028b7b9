"""Rehearsal of a walk without physics."""

from dataclasses import replace

import pytest

from hsr8.robots.walk.rehearsal import rehearse, within_joints
from walking.body.robot_model import RobotModel
from walking.command import VelocityCommand
from walking.parameters import WalkingParameters

DEFAULTS = WalkingParameters()


@pytest.fixture(scope="module")
def other(robot):
    """Builds HSR-VIII with factors on the numbers of its leg joints."""

    def build(**factors):
        changes = {}
        for name, factor in factors.items():
            values = getattr(robot.tree, name).copy()
            values[:12] *= factor
            changes[name] = values
        model = RobotModel(replace(robot.tree, **changes))
        model.stand(DEFAULTS.pattern.pelvis_height, DEFAULTS.gait.half_stance)
        return model

    return build


def test_the_demand_is_relative_to_the_limits_of_the_joints(other):
    command = VelocityCommand(0.2, 0.0, 0.0)
    usual = rehearse(other(), DEFAULTS, command)
    slow, weak = (
        rehearse(other(speed=0.5), DEFAULTS, command),
        rehearse(other(effort=0.7), DEFAULTS, command),
    )
    assert usual.met
    assert slow.speed == pytest.approx(2.0 * usual.speed, rel=0.03)
    assert weak.torque == pytest.approx(usual.torque / 0.7)
    assert slow.room == usual.room


def test_a_faster_walk_demands_more(robot):
    commands = [VelocityCommand(v, 0.0, 0.0) for v in (0.1, 0.3, 0.5)]
    speeds = [rehearse(robot, DEFAULTS, command).speed for command in commands]
    assert speeds == sorted(speeds)


def test_mirrored_walks_demand_the_same(robot):
    left, right = (rehearse(robot, DEFAULTS, VelocityCommand(0.1, s * 0.1, 0.0)) for s in (1, -1))
    assert left.speed == pytest.approx(right.speed, rel=1e-6)
    assert left.torque == pytest.approx(right.torque, rel=1e-6)


def test_slow_joints_lower_the_swing_and_the_speed_limits(other):
    slow = other(speed=0.1)
    fitted, notes = within_joints(slow, DEFAULTS)
    assert fitted.gait.swing_height < DEFAULTS.gait.swing_height
    assert fitted.limits.vx < DEFAULTS.limits.vx
    assert rehearse(slow, fitted, VelocityCommand(fitted.limits.vx, 0.0, 0.0)).met
    assert any("swing_height" in note and "speed of" in note for note in notes)
    assert any("vx" in note and "speed of" in note for note in notes)


def test_known_limits_replace_the_search(robot):
    fitted, _ = within_joints(robot, DEFAULTS, {"vx": 0.11})
    assert fitted == replace(DEFAULTS, limits=replace(DEFAULTS.limits, vx=0.11))
