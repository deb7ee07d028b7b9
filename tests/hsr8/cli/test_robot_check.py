import json

import pytest

from hsr8.cli.main import entry
from hsr8.trials.robot_check import JointUse, WalkResult

STAND = WalkResult("stand", 0.0, fell=False, error=None, tilt=0.1, drift=0.001, limit="none")
TURN = WalkResult("turn left", 0.5, fell=False, error=0.01, tilt=0.4, drift=None, limit="none")
FALL = WalkResult("left", -0.1, fell=True, error=None, tilt=40.0, drift=None, limit="l_knee weak")
REASONS = [
    "left: fell, l_knee weak",
    "`hsr8 robot calibrate` finds speeds at which it does not fall",
]
JOINT = JointUse("l_knee", 0.4, None, 0.6, saturated=0.01, stopped=0.0, one_leg=0.3)


@pytest.fixture
def walking(monkeypatch):
    """Let the robot walk with given results."""

    def set_results(*results):
        def check(robot, report):
            for result in results:
                report(result)
            return list(results), [JOINT]

        monkeypatch.setattr("hsr8.cli.robot_check.check_robot", check)

    return set_results


def test_a_robot_that_walks(walking, capsys):
    walking(STAND, TURN)
    assert entry(["robot", "check", "hsr8"]) == 0
    printed = capsys.readouterr()
    for word in ("0.500 rad/s", "1.0%", "l_knee", "60.0%", "hsr8 stands and walks"):
        assert word in printed.out
    assert printed.err == "stand       tilt 0.1 deg\nturn left   tilt 0.4 deg\n"


def test_a_robot_that_falls(walking, capsys):
    walking(STAND, FALL)
    assert entry(["robot", "check", "hsr8"]) == 1
    printed = capsys.readouterr()
    assert printed.out.endswith("\n".join([*REASONS, ""]))
    assert "left        fell" in printed.err


def test_json_and_quiet(walking, capsys):
    walking(FALL)
    assert entry(["robot", "check", "hsr8", "--json", "--quiet"]) == 1
    printed = capsys.readouterr()
    result = json.loads(printed.out)
    assert (result["passed"], result["reasons"]) == (False, REASONS)
    assert result["walks"][0]["direction"] == "left"
    assert result["joints"][0] == {
        "joint": "l_knee",
        "torque": 0.4,
        "speed": None,
        "range": 0.6,
        "saturated": 0.01,
        "stopped": 0.0,
        "one_leg": 0.3,
    }
    assert printed.err == ""
    walking(STAND)
    assert entry(["robot", "check", "hsr8", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
