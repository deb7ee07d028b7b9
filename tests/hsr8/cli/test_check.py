import json

import cv2
import pytest

from hsr8.cli.check import main
from hsr8.cli.options import Check


def test_json_holds_world_and_certificate(capsys):
    assert main(Check("course", seed=4, json=True)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["seed"] == 4
    assert [o["moves"] for o in summary["obstacles"]] == [False] * 12 + [True] * 4
    assert len(summary["waypoints"]) == 5
    assert len(summary["beacons"]) == 6
    assert summary["certified"]
    assert summary["certified_clearance_m"] >= 0.02
    assert summary["certified_length_m"] > summary["straight_length_m"] - 5 * 0.15
    assert summary["rejected_worlds"] == 0
    assert summary["straight_length_m"] > 5 * 1.2 - 0.1


@pytest.mark.parametrize("name", ["course", "paper", "walk", "fig4c"])
def test_people_get_a_table(capsys, name):
    assert main(Check(name)) == 0
    assert "certificate" in capsys.readouterr().out


def test_settings_change_the_world(capsys):
    assert main(Check("course", set=(("world.n_static=3", "world.n_moving=0"),), json=True)) == 0
    assert len(json.loads(capsys.readouterr().out)["obstacles"]) == 3


def test_an_image_is_drawn(tmp_path, capsys):
    path = tmp_path / "world.png"
    assert main(Check("quick", image=path)) == 0
    assert cv2.imread(str(path)).shape == (900, 900, 3)


def test_columns_have_their_units(capsys):
    main(Check("quick"))
    said = capsys.readouterr().out
    for unit in ("x [m]", "radius [m]", "speed [m/s]"):
        assert unit in said


def test_the_printed_command_makes_the_checked_run(capsys):
    main(Check("quick", set=(("world.n_static=3",),)))
    command = capsys.readouterr().out.splitlines()[-1]
    assert command == "run it: hsr8 run quick --seed 2 --set world.n_static=3"


@pytest.mark.parametrize(
    ("settings", "wanted"),
    [
        (["command.vx=0.3"], "0.3 m/s forward"),
        (["command.footstep={forward=0.05}"], "footsteps of 0.05 m"),
        (["command.random={stop_fraction=0.2}"], "drawn every 0.5 to 2 s, 20% stops"),
        (["disturbance.random={}"], "5 stretches, 32 s"),
        (['fault=[{kind="push",start=1,magnitude=1}]'], "push at 1 s"),
        (["disturbance.random={}"], "drawn, 0.2 to 0.8 N s on torso_link"),
    ],
)
def test_commands_and_pushes_are_shown(settings, wanted, capsys):
    assert main(Check("walk", set=(tuple(settings),))) == 0
    assert wanted in capsys.readouterr().out
