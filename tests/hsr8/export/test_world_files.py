import json
import os

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.scenario.loader import load_scenario
from hsr8.world.field.generator import draw_layout

SEED = 3
IRSIM = ["crowd", "circle", "conflict"]


def read_yaml(text):
    """Tables of a file whose values are JSON."""
    table, items = {}, None
    for line in text.splitlines():
        if line.startswith("  - "):
            items.append(json.loads(line[4:]))
        else:
            key, _, value = line.strip().partition(": ")
            if not value:
                items = table[key.rstrip(":")] = []
            else:
                table[key] = json.loads(value) if value[0] in '[{"0123456789-' else value
    return table


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds")

    def export(name):
        file = folder / f"{name}.yaml"
        if not file.exists():
            arguments = ["export", name, "--seed", str(SEED), "--irsim", str(file)]
            assert entry(arguments) == 0
        return file, draw_layout(load_scenario(name, seed=SEED), SEED)

    return export


@pytest.mark.parametrize("name", IRSIM)
def test_irsim_gets_every_object_of_the_world(exported, name):
    file, layout = exported(name)
    table = read_yaml(file.read_text())
    assert (table["width"], table["height"]) == layout.field_size
    (robot,) = table["robot"]
    assert robot["state"] == list(layout.start)
    assert np.array(robot["goal"][0])[:, :2] == pytest.approx(layout.waypoints)
    cylinders = [*layout.static, *layout.beacons, *layout.movers]
    written = [(*o["state"][:2], o["shape"]["radius"]) for o in table["obstacle"]]
    assert np.array(written) == pytest.approx(
        np.array([(*c.position, c.radius) for c in cylinders])
    )


@pytest.mark.parametrize("name", IRSIM)
def test_irsim_loads_the_world_and_movers_follow_their_lanes(exported, name, monkeypatch):
    """Equal motion for 5 s, but for the step that IR-SIM stops at every goal."""
    monkeypatch.setenv("MPLBACKEND", "Agg")
    irsim = pytest.importorskip("irsim")
    file, layout = exported(name)
    world = irsim.make(str(file), display=False, log_level="ERROR")
    movers = world.obstacle_list[-len(layout.movers) :]
    for _ in range(50):
        world.step()
    if name != "circle":
        motion = layout.motion()
        at = np.array([mover.state[:2, 0] for mover in movers])
        departed = np.array([getattr(m, "depart", 0.0) <= 0.0 for m in motion.motions])
        expected = motion.positions(5.0)
        assert np.hypot(*(at - expected)[departed].T).max() < 0.15
    world.end()


def test_a_map_has_the_static_obstacles_and_beacons(tmp_path):
    file = tmp_path / "map.yaml"
    assert entry(["export", "dense", "--seed", str(SEED), "--map", str(file)]) == 0
    table = read_yaml(file.read_text())
    magic, size, depth, pixels = (tmp_path / table["image"]).read_bytes().split(b"\n", 3)
    columns, rows = map(int, size.split())
    assert (magic, depth, len(pixels)) == (b"P5", b"255", columns * rows)
    image = np.frombuffer(pixels, np.uint8).reshape(rows, columns)
    layout = draw_layout(load_scenario("dense", seed=SEED), SEED)
    x0, y0, _ = table["origin"]
    row, column = np.indices(image.shape)
    x = x0 + (column + 0.5) * table["resolution"]
    y = y0 + (rows - row - 0.5) * table["resolution"]
    occupied = np.zeros(image.shape, bool)
    for cylinder in (*layout.static, *layout.beacons):
        cx, cy = cylinder.position
        occupied |= np.hypot(x - cx, y - cy) <= cylinder.radius
    assert (image == np.where(occupied, 0, 254)).all()
    assert occupied.sum() * table["resolution"] ** 2 == pytest.approx(
        sum(np.pi * c.radius**2 for c in (*layout.static, *layout.beacons)), rel=0.05
    )


def test_the_world_of_a_run_is_exported(run, tmp_path):
    file = tmp_path / "run.yaml"
    assert entry(["export", str(run.path), "--irsim", str(file)]) == 0
    (robot,) = read_yaml(file.read_text())["robot"]
    assert robot["state"] == list(draw_layout(run.scenario(), run.seed).start)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--irsim", "w.yaml"], "--irsim: got 0 worlds; expected one"),
        (["quick", "course", "--map", "m.yaml"], "--map: got 2 worlds; expected one"),
        (["nowhere", "--irsim", "w.yaml"], "nowhere"),
        (["pedestrians", "--irsim", "w.yaml"], "--irsim: got recorded movers"),
        (["quick", "--map", "m.png"], "--map m.png"),
    ],
)
def test_mistakes_are_one_error(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert entry(["export", *arguments]) == 2
    assert message in capsys.readouterr().err
    assert os.listdir() == []
