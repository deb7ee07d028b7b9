import shutil
from itertools import pairwise

import cv2
import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.recording import run_folder
from hsr8.recording.run import open_run
from hsr8.show.video.run_images import shown_frames
from hsr8.show.video.run_video import VideoOptions, instants, render_run

TIME = 0.02 * np.arange(50 * 100 + 1)  # 100 s


def test_a_short_video_runs_in_real_time():
    times, speed = instants(TIME, VideoOptions(stop=60.0))
    assert speed == 1.0
    assert len(times) == 60 * 25
    np.testing.assert_allclose(np.diff(times), 0.04)


def test_a_long_run_is_sped_up_to_the_maximum_length():
    times, speed = instants(0.02 * np.arange(28011), VideoOptions())
    assert speed == 10.0
    assert len(times) == round(560.2 / 10 * 25)


def test_speed_and_cut_are_obeyed():
    times, speed = instants(TIME, VideoOptions(start=10.0, stop=20.0, speed=0.5, fps=30))
    assert speed == 0.5
    assert len(times) == 600
    assert times[0] == 10.0
    assert times[-1] < 20.0


@pytest.mark.parametrize(
    "options",
    [
        VideoOptions(start=100.0),
        VideoOptions(start=5.0, stop=4.0),
        VideoOptions(start=-1.0),
        VideoOptions(start=200.0),
    ],
)
def test_an_empty_time_range_is_a_usage_error(options):
    with pytest.raises(UsageError, match="ended at 100 s"):
        instants(TIME, options)


def test_a_run_without_records_is_a_usage_error():
    with pytest.raises(UsageError, match="no motion"):
        instants(np.zeros(0), VideoOptions())


@pytest.fixture
def run(quick_run):
    return quick_run


@pytest.mark.gl
@pytest.mark.parametrize("camera", ["dashboard", "follow", "head", "top", "corner", "front"])
def test_every_camera_draws(run, camera, tmp_path):
    done = []
    options = VideoOptions(camera=camera, size=(192, 108), fps=2)
    made = render_run(run, options, tmp_path / "v.mp4", lambda n, total: done.append((n, total)))
    assert made.frames == 2
    assert done == [(k, 2) for k in (1, 2)]
    assert made.video.stat().st_size > 1000
    assert made.thumbnail.read_bytes().startswith(b"\x89PNG")


@pytest.mark.gl
def test_an_interrupted_video_leaves_no_file(run, tmp_path):
    def interrupt(n, _):
        if n == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        render_run(run, VideoOptions(camera="top", size=(64, 64)), tmp_path / "v.mp4", interrupt)
    assert list(tmp_path.glob("*v*")) == []


@pytest.mark.gl
@pytest.mark.parametrize("size", [(1280, 64), (64, 720)])
def test_the_dashboard_fits_every_size(run, size, tmp_path):
    out = tmp_path / "p.png"
    made = render_run(run, VideoOptions(size=size, start=0.5), out, lambda n, total: None)
    assert made.frames == 1
    assert made.thumbnail is None
    assert cv2.imread(str(out)).shape == (size[1], size[0], 3)


@pytest.mark.gl
def test_an_unknown_camera_is_answered_with_known_ones(run, tmp_path):
    with pytest.raises(UsageError, match="dashboard, follow, head, top, corner, front, egocentric"):
        render_run(run, VideoOptions(camera="side"), tmp_path / "v.mp4", lambda n, total: None)
    assert list(tmp_path.glob("*v*")) == []


@pytest.mark.gl
def test_a_trajectory_of_another_scenario_is_a_usage_error(run, tmp_path):
    copy = tmp_path / "run"
    shutil.copytree(run.path, copy)
    scenario = (copy / run_folder.SCENARIO).read_text()
    other = scenario.replace("n_moving = 1", "n_moving = 0")
    assert other != scenario
    (copy / run_folder.SCENARIO).write_text(other)
    with pytest.raises(UsageError, match="does not match"):
        render_run(
            open_run(copy), VideoOptions(size=(64, 64)), tmp_path / "v.mp4", lambda n, total: None
        )


@pytest.fixture(scope="module")
def longer(tmp_path_factory):
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


def test_each_time_has_the_latest_frame(longer):
    times = np.linspace(0.0, 3.0, 61)
    arrived = longer.frames["time"]
    for time, frame in zip(times, shown_frames(longer, times), strict=True):
        assert frame.time == max(arrived[arrived <= time + 1e-9], default=arrived[0])


def test_each_frame_has_the_latest_gaze_map(longer):
    maps = list(longer.frames["gaze_map"])
    assert 0 < sum(made is not None for made in maps) < len(maps)
    for row, frame in enumerate(shown_frames(longer, longer.frames["time"])):
        made = [m for m in maps[: row + 1] if m is not None]
        assert np.array_equal(frame.gaze_map, made[-1][::-1, ::-1] if made else None)


def test_frames_do_not_depend_on_the_other_times(longer):
    every = {frame.time: frame for frame in shown_frames(longer, longer.frames["time"])}
    for time in longer.frames["time"][::7].tolist():
        (alone,) = shown_frames(longer, np.array([time]))
        assert np.array_equal(alone.gaze_map, every[time].gaze_map)
        assert (alone.tracks, alone.detections) == (every[time].tracks, every[time].detections)
        assert (alone.pose, alone.truth) == (every[time].pose, every[time].truth)


def test_times_with_the_same_frame_share_it(longer):
    shown = shown_frames(longer, np.linspace(0.0, 2.0, 201))
    assert all((a is b) == (a.time == b.time) for a, b in pairwise(shown))
