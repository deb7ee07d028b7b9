import json
import shutil
import tomllib
from datetime import UTC, datetime

import pytest

from hsr8.cli.main import entry
from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import find_description
from hsr8.trials.calibration import Measured
from hsr8.version import VERSION

MEASURED = Measured(
    speed={"vx": 0.2, "vx_backward": 0.1, "vy": 0.05, "wz": 0.8, "combined": 1.0, "reach": 1.0},
    turn_delay=0.4,
    lag=0.02,
    forward_noise=0.001,
    lateral_noise=0.002,
    tilt_sigma=0.003,
    roll_sigma=0.004,
    yaw_sigma=0.005,
    height_sigma=0.006,
)


@pytest.fixture
def file(tmp_path, monkeypatch):
    """A copy of the default robot's description; the measurement takes no time."""

    def calibrate(robot, report):
        assert robot.description.calibration is None
        report("vx 0.200: error 1.0%, tilt 0.3 deg")
        return MEASURED, ["vy: 12% of the rehearsed 0.4: l_knee at its maximum torque"]

    monkeypatch.setattr("hsr8.cli.robot_calibrate.calibrate", calibrate)
    monkeypatch.chdir(tmp_path)
    return shutil.copy(find_description("hsr8"), tmp_path / "mine.toml")


def test_the_description_receives_date_version_and_command(file, capsys):
    before = file.read_text()
    assert entry(["robot", "calibrate", "mine.toml"]) == 0
    printed = capsys.readouterr()
    assert printed.err == "trial   1   vx 0.200: error 1.0%, tilt 0.3 deg\n"
    for word in (
        "vy: 12% of the rehearsed 0.4: l_knee at",
        "vx [m/s]",
        "wz [rad/s]",
        "0.8",
        "turn delay [s]",
        "mine.toml",
    ):
        assert word in printed.out
    assert file.read_text().startswith(before.rstrip())
    calibration = read_description(file).calibration
    assert calibration.version == VERSION
    assert calibration.command == "hsr8 robot calibrate mine.toml"
    assert datetime.fromisoformat(calibration.date).date() <= datetime.now(UTC).date()
    assert calibration.speed.model_dump() == MEASURED.speed
    assert calibration.height_sigma == 0.006


def test_a_second_calibration_replaces_the_first(file, capsys):
    assert entry(["robot", "calibrate", "mine.toml", "--quiet"]) == 0
    once = file.read_text()
    assert entry(["robot", "calibrate", "mine.toml", "--quiet"]) == 0
    assert file.read_text() == once
    assert capsys.readouterr() == ("", "")


def test_a_shipped_robot_is_written_to_another_file(file, tmp_path, capsys):
    shipped = find_description("hsr8")
    before = shipped.read_bytes()
    assert entry(["robot", "calibrate", "hsr8", "--out", "new.toml", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["calibration"]["lag"] == 0.02
    assert shipped.read_bytes() == before
    written = tomllib.loads((tmp_path / "new.toml").read_text())
    assert written["calibration"]["command"] == "hsr8 robot calibrate hsr8"
    assert written["model"] == "hsr8/hsr8.xml"


def test_a_description_that_cannot_be_written_needs_another_file(file, monkeypatch, capsys):
    monkeypatch.setattr("hsr8.cli.robot_calibrate.os.access", lambda *_: False)
    assert entry(["robot", "calibrate", "mine.toml"]) == 2
    assert "cannot be written; expected --out FILE with a new file" in capsys.readouterr().err


def test_nothing_is_overwritten(file, tmp_path, capsys):
    (tmp_path / "old.toml").write_text("mine")
    assert entry(["robot", "calibrate", "mine.toml", "--out", "old.toml"]) == 2
    assert "--out old.toml: exists; expected a new name" in capsys.readouterr().err
    assert (tmp_path / "old.toml").read_text() == "mine"
