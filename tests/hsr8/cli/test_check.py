import json

import cv2
import pytest

from hsr8.cli.check import main
from hsr8.cli.options import Check


def test_json_holds_world_and_certificate(capsys):
    assert main(Check("course", seed=4, json=True)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["seed"] == 4
    assert [o["motion"] for o in summary["obstacles"]] == [None] * 12 + ["shuttle"] * 4
    assert len(summary["via_points_m"]) == 4
    assert len(summary["goal_m"]) == 2
    assert len(summary["beacons"]) == 6
    assert summary["certified"]
    assert summary["certified_clearance_m"] >= 0.02
    assert summary["certified_length_m"] > summary["straight_length_m"] - 5 * 0.15
    assert summary["rejected_worlds"] == 0
    assert summary["straight_length_m"] > 5 * 1.2 - 0.1


@pytest.mark.parametrize("name", ["paper", "walk"])
def test_a_table_is_printed(capsys, name):
    assert main(Check(name)) == 0
    assert "certified" in capsys.readouterr().out


def test_settings_change_the_world(capsys):
    assert main(Check("course", set=(("world.n_static=3", "world.n_moving=0"),), json=True)) == 0
    assert len(json.loads(capsys.readouterr().out)["obstacles"]) == 3


def test_an_image_is_drawn(tmp_path, capsys):
    path = tmp_path / "world.png"
    assert main(Check("quick", image=path)) == 0
    height, width, _ = cv2.imread(str(path)).shape
    assert width == 900
    assert height > 900  # title and legend


def test_the_printed_command_makes_the_checked_run(capsys):
    main(Check("quick", set=(("world.n_static=3",),)))
    command = capsys.readouterr().out.splitlines()[-1]
    assert command == "run it      hsr8 run quick --set world.n_static=3 --seed 2"


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        (["command.footstep={forward=0.05}"], "forward 0.05"),
        (['fault=[{kind="push",start=1,magnitude=1}]'], "kind push, start 1"),
    ],
)
def test_commands_and_pushes_are_shown(settings, expected, capsys):
    assert main(Check("walk", set=(tuple(settings),))) == 0
    assert expected in " ".join(capsys.readouterr().out.replace("│", "").split())
