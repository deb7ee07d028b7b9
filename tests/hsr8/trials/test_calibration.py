from dataclasses import asdict
from functools import partial
from itertools import product

import numpy as np
import pytest

from hsr8.errors import ModelError
from hsr8.robots.file.description import MIN_SPEED, Calibration
from hsr8.robots.loaded import load_robot
from hsr8.trials import calibration, robot_check
from hsr8.trials.commands import random_commands
from hsr8.trials.robot_check import WalkResult, check_robot


@pytest.fixture
def quick(monkeypatch):
    """Short walks, the rehearsed speeds along each axis, and a check that passes."""
    values = {"STEADY_TIME": 0.6, "RANDOM_TIME": 0.6, "INTERVAL": 0.5, "RANDOM_SEEDS": range(1)}
    for name, value in {**values, "SMALLEST": 1.0}.items():
        monkeypatch.setattr(calibration, name, value)
    monkeypatch.setattr(calibration, "check_robot", lambda _robot: ([], []))
    return monkeypatch


def test_commands_at_the_corners_use_the_whole_envelope():
    envelope = {"vx": 0.2, "vx_backward": 0.1, "vy": 0.08, "wz": 0.8}
    commands = random_commands(envelope, 1.0, 3, stops=0.0, corners=1.0)
    velocities = np.array([commands(0.5 * k).velocity for k in range(200)])
    assert {*map(tuple, velocities.tolist())} == {*product((0.2, -0.1), (0.08, -0.08), (0.8, -0.8))}


def test_a_short_calibration_of_the_default_robot(monkeypatch):
    """The envelope is within the limits, and close to them; the robot passes its check."""
    for name, value in (
        ("STEADY_TIME", 3.9),
        ("RANDOM_TIME", 2.0),
        ("INTERVAL", 1.0),
        ("MAX_ERROR", 0.2),
        ("RANDOM_SEEDS", range(1)),
        ("check_robot", partial(check_robot, duration=1.0)),
    ):
        monkeypatch.setattr(calibration, name, value)
    monkeypatch.setattr(robot_check, "RANDOM_SEEDS", range(1))
    lines = []
    robot = load_robot("hsr8")
    measured, warnings = calibration.calibrate(robot, lines.append)
    assert warnings == []
    limits = robot.parameters.limits
    for axis in calibration.AXES:
        assert 0.5 * getattr(limits, axis) < measured.speed[axis] <= getattr(limits, axis)
    assert [line.split()[0] for line in lines[:1]] == ["vx"]
    assert lines[-2].endswith("0 falls in 1 walks")
    assert lines[-1].endswith(": passed")
    assert 0.0 <= measured.lag < 0.05
    assert 0.0 < measured.turn_delay < 1.0
    assert 0.0 < measured.tilt_sigma < 0.02
    stated = {"date": "2026-01-01", "version": "0", "command": "none", **asdict(measured)}
    assert Calibration.model_validate(stated).lag == measured.lag


def test_a_speed_far_below_the_rehearsed_one_is_a_warning(quick):
    """Half of the speed falls short: no walk is exact enough for the limits."""
    for name, value in (("MAX_TILT", 0.0), ("SMALLEST", 0.5), ("SHRINK", 0.4)):
        quick.setattr(calibration, name, value)
    _, warnings = calibration.calibrate(load_robot("hsr8"))
    assert [warning.split(":")[0] for warning in warnings] == list(calibration.AXES)
    assert warnings[0].startswith("vx: 40% of the rehearsed 0.55: ")


def checked_up_to(limit, robot):
    """Result of a check that a robot fails at a higher forward speed than the limit [m/s]."""
    speed = robot.parameters.limits.vx
    fell = speed > limit
    return [WalkResult("random 1", speed, fell, None, 0.0, None, "l_knee at a limit")], []


def test_the_speeds_are_reduced_until_the_robot_passes_its_check(quick):
    """First their combination is; the lateral reach is narrowed for each."""
    quick.setattr(calibration, "check_robot", partial(checked_up_to, 0.4))
    quick.setattr(calibration, "SHRINK", 0.8)
    lines = []
    measured, warnings = calibration.calibrate(load_robot("hsr8"), lines.append)
    assert measured.speed["vx"] == pytest.approx(0.8**2 * 0.55, abs=1e-3)
    checks = [line.rsplit(": ", 1)[1] for line in lines if line.startswith("check in ")]
    assert checks == [*["fell, l_knee at a limit"] * 5, "passed"]
    assert measured.speed["combined"] == 1.0
    assert measured.speed["reach"] == 1.0
    assert warnings == []


def test_a_robot_too_slow_for_navigation_is_refused(quick):
    """No description may state such speeds."""
    quick.setattr(calibration, "check_robot", partial(checked_up_to, 0.0))
    quick.setattr(calibration, "SHRINK", 0.05)
    message = f"expected at least {MIN_SPEED}: l_knee at a limit"
    with pytest.raises(ModelError, match=message):
        calibration.calibrate(load_robot("hsr8"))
