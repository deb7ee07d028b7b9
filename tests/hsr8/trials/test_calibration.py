from dataclasses import asdict
from itertools import product

import numpy as np

from hsr8.robots.description import Calibration
from hsr8.robots.loaded import load_robot
from hsr8.trials import calibration


def test_commands_at_the_corners_use_the_whole_envelope():
    envelope = {"vx": 0.2, "vx_backward": 0.1, "vy": 0.08, "wz": 0.8}
    commands = calibration.random_commands(envelope, 1.0, 3, stops=0.0, corners=1.0)
    velocities = np.array([commands(0.5 * k).velocity for k in range(200)])
    assert {*map(tuple, velocities.tolist())} == {*product((0.2, -0.1), (0.08, -0.08), (0.8, -0.8))}


def test_a_short_calibration_of_the_default_robot(monkeypatch):
    """The envelope is within the limits, and close to them."""
    for name, value in (
        ("STEADY_TIME", 3.9),
        ("RANDOM_TIME", 3.0),
        ("INTERVAL", 1.0),
        ("MAX_ERROR", 0.2),
    ):
        monkeypatch.setattr(calibration, name, value)
    monkeypatch.setattr(calibration, "RANDOM_SEEDS", range(1))
    lines = []
    robot = load_robot("hsr8")
    measured, warnings = calibration.calibrate(robot, lines.append)
    assert warnings == []
    limits = robot.parameters.limits
    for axis in calibration.AXES:
        assert 0.5 * getattr(limits, axis) < measured.speed[axis] <= getattr(limits, axis)
    assert [line.split()[0] for line in lines[:1]] == ["vx"]
    assert lines[-1].endswith("0 falls in 1 walks")
    assert 0.0 <= measured.lag < 0.05
    assert 0.0 < measured.turn_delay < 1.0
    assert 0.0 < measured.tilt_sigma < 0.02
    stated = {"date": "2026-01-01", "version": "0", "command": "none", **asdict(measured)}
    assert Calibration.model_validate(stated).lag == measured.lag


def test_a_speed_far_below_the_rehearsed_one_is_a_warning(monkeypatch):
    """Half of the speed falls short: no walk is exact enough for the limits."""
    for name, value in (("STEADY_TIME", 1.0), ("RANDOM_TIME", 1.0), ("INTERVAL", 0.5)):
        monkeypatch.setattr(calibration, name, value)
    for name, value in (("RANDOM_SEEDS", range(1)), ("MAX_TILT", 0.0), ("SMALLEST", 0.3)):
        monkeypatch.setattr(calibration, name, value)
    _, warnings = calibration.calibrate(load_robot("hsr8"))
    assert [warning.split(":")[0] for warning in warnings] == list(calibration.AXES)
    assert warnings[0].startswith("vx: 27% of the rehearsed 0.55: ")
