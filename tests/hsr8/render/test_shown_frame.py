from itertools import pairwise

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.recorder.run.run_reader import open_run
from hsr8.render.shown_frame import shown_frames


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("runs")
    options = ["--body", "kinematic", "--camera", "analytic", "--duration", "2"]
    entry(
        [
            "run",
            "quick",
            *options,
            "--set",
            "navigation.gaze.mode=integrated",
            "--quiet",
            "--out",
            str(out),
        ]
    )
    return open_run(out)


def test_each_time_has_the_latest_frame(run):
    times = np.linspace(0.0, 3.0, 61)
    arrived = run.frames["time"]
    for time, frame in zip(times, shown_frames(run, times), strict=True):
        assert frame.time == max(arrived[arrived <= time + 1e-9], default=arrived[0])


def test_each_frame_has_the_latest_gaze_map(run):
    maps = list(run.frames["gaze_map"])
    assert 0 < sum(made is not None for made in maps) < len(maps)
    for row, frame in enumerate(shown_frames(run, run.frames["time"])):
        made = [m for m in maps[: row + 1] if m is not None]
        assert np.array_equal(frame.gaze_map, made[-1][::-1, ::-1] if made else None)


def test_frames_do_not_depend_on_the_other_times(run):
    every = {frame.time: frame for frame in shown_frames(run, run.frames["time"])}
    for time in run.frames["time"][::7].tolist():
        (alone,) = shown_frames(run, np.array([time]))
        assert np.array_equal(alone.gaze_map, every[time].gaze_map)
        assert (alone.tracks, alone.detections) == (every[time].tracks, every[time].detections)
        assert (alone.pose, alone.truth) == (every[time].pose, every[time].truth)


def test_times_with_the_same_frame_share_it(run):
    shown = shown_frames(run, np.linspace(0.0, 2.0, 201))
    assert all((a is b) == (a.time == b.time) for a, b in pairwise(shown))
