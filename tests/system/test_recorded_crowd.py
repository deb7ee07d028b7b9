"""A run among recorded movers, its records, and its repetition without the track file."""

import json
import shutil

import numpy as np
import pytest

import hsr8
from hsr8.recording.verification import recompute
from hsr8.scenario.layers import BUILT_IN
from hsr8.scenario.track_file import recorded_tracks

SETTINGS = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 3.0}
KEYS = 'scale = 0.35\ntime_scale = 2.5\nstart = 20.0\nend = "repeat"\n'


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Run of a scenario whose track file is deleted afterwards."""
    folder = tmp_path_factory.mktemp("crowd")
    shutil.copy(BUILT_IN / "pedestrians.csv", folder / "people.csv")
    file = folder / "mine.toml"
    file.write_text(
        'extends = "course"\n[world]\nn_static = 2\nn_moving = 0\n[[world.mover]]\n'
        f'motion = "track"\nfile = "people.csv"\n{KEYS}'
    )
    hsr8.run(file, seed=3, settings=SETTINGS, out=folder / "runs")
    (folder / "people.csv").unlink()
    return hsr8.open_run(folder / "runs")


def test_the_recorded_positions_are_those_of_the_file(run):
    tracks = recorded_tracks(run.scenario().world.mover[0].data)
    times = run.records["time"]
    positions = run.records["obstacle_positions"]
    velocities = run.records["obstacle_velocities"]
    compared = 0
    for column, track in enumerate(tracks, start=2):
        for t, point in zip(track.times, track.points, strict=True):
            row = int(np.argmin(np.abs(times - 2.5 * (t - 20.0))))
            if abs(times[row] - 2.5 * (t - 20.0)) < 1e-9:
                assert positions[row, column] == pytest.approx(0.35 * np.array(point), abs=1e-9)
                compared += 1
    assert compared > 10
    moved = np.diff(positions[:, 2:], axis=0) / 0.02
    mean = 0.5 * (velocities[1:, 2:] + velocities[:-1, 2:])
    walks = velocities[:, 2:].any(axis=2)
    walks = walks[1:] & walks[:-1]
    assert walks.sum() > 500
    assert moved[walks] == pytest.approx(mean[walks], abs=0.005)


def test_a_run_is_verified_and_repeated_without_the_file(run, tmp_path):
    assert all(stage.equal for stage in recompute(run))
    copy = tmp_path / "scenario.toml"
    shutil.copy(run.scenario_file, copy)
    hsr8.run(copy, seed=3, out=tmp_path)
    again = hsr8.open_run(tmp_path)
    assert again.metrics["state_hash"] == run.metrics["state_hash"]
    digest = json.loads((run.path / "manifest.json").read_text())["libraries"]["tracks people.csv"]
    assert again.manifest["libraries"]["tracks people.csv"] == digest
