import json
import tomllib

import cv2
import pytest

from hsr8.cli.main import entry
from hsr8.robots.file.description import read_description
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.unrehearsed import unrehearsed_robots

FEET = ["l_ankle_roll_link", "r_ankle_roll_link"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with unrehearsed_robots():
        yield tmp_path


def write(folder, robot=None, name="small.xml"):
    file = folder / name
    file.write_text((robot or SmallHumanoid()).xml(), encoding="utf-8")
    return file


def inspect(*words):
    return entry(["robot", "inspect", *map(str, words)])


def test_roles_and_numbers_are_printed(folder, capsys):
    assert inspect(write(folder)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    for text in ("l_ankle_roll_link", "head_yaw", "certain", "mass [kg]", "--write"):
        assert text in printed
    assert [file.name for file in folder.iterdir()] == ["small.xml"]


def test_the_written_description_gives_the_inspected_robot(folder, capsys):
    file, target = write(folder), folder / "robot.toml"
    assert inspect(file, "--json", "--write", target) == 0
    result = json.loads(capsys.readouterr().out)
    guessed, roles = result["robot"], {row["role"]: row for row in result["findings"]}
    assert (roles["feet"]["part"], roles["feet"]["sureness"]) == (", ".join(FEET), "certain")
    assert (result["refusal"], guessed["mass_kg"]) == (None, pytest.approx(9.3))
    text = target.read_text("utf-8")
    assert tomllib.loads(text)["model"] == "small.xml"
    assert tomllib.loads(text)["feet"] == FEET
    assert "# certain: mirrored chains of 6 joints" in text
    assert read_description(target).head == ("head_yaw", "head_pitch")
    assert inspect(target, "--json") == 0
    assert json.loads(capsys.readouterr().out)["robot"] == guessed


def test_a_description_in_another_folder_names_the_whole_path(folder, capsys):
    (folder / "mine").mkdir()
    target = folder / "mine" / "robot.toml"
    file = write(folder)
    assert inspect(file, "--write", target) == 0
    assert tomllib.loads(target.read_text("utf-8"))["model"] == str(file)


@pytest.mark.gl
def test_an_image_is_drawn(folder, capsys):
    assert inspect(write(folder), "--image", "small.png") == 0
    assert cv2.imread("small.png").std() > 10.0


def test_a_refused_robot_leaves_its_description_to_be_corrected(folder, capsys):
    """A knee that cannot bend: the guess succeeds, the robot does not walk."""
    text = SmallHumanoid().xml().replace('range="0.0 2.2"', 'range="-0.2 0.3"')
    file = folder / "stiff.xml"
    file.write_text(text, encoding="utf-8")
    assert inspect(file, "--write", "stiff.toml", "--image", "stiff.png") == 2
    captured = capsys.readouterr()
    assert "the knee cannot bend" in captured.err
    assert captured.err.count("hsr8: ") == 1
    assert "l_ankle_roll_link" in " ".join(captured.out.split())
    assert read_description(folder / "stiff.toml").feet == tuple(FEET)
    assert not (folder / "stiff.png").exists()


def test_a_robot_without_legs_of_six_joints_is_refused(folder, capsys):
    assert inspect(write(folder, SmallHumanoid(ankle="p"))) == 2
    assert "feet: the legs have 5 hinge joints" in capsys.readouterr().err


def test_a_description_is_compared_with_the_guess(folder, capsys):
    file = write(folder)
    head = 'model = "small.xml"\nhead = ["head_yaw", "head_pitch"]\n'
    (folder / "mine.toml").write_text(head + f"feet = {json.dumps(FEET)}\n")
    assert inspect("mine.toml") == 0
    printed = capsys.readouterr().out
    assert printed.startswith(str(file)[:40])
    assert "stated" in printed
    assert printed.endswith("next        hsr8 robot check mine.toml\n")
