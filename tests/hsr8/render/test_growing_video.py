"""A video that is drawn during the run has the frames of one that is drawn after it."""

import shutil
import signal
import subprocess
import sys
import time as clock

import av
import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.recorder.run.run_reader import open_run
from hsr8.recorder.stream import CHECKSUMS
from hsr8.render.run_images import RunImages

pytestmark = [pytest.mark.gl, pytest.mark.timeout(300)]
FAST = ["--body", "kinematic", "--camera", "analytic"]
SMALL = ["--size", "192x108", "--quiet"]


def frames(path):
    with av.open(str(path)) as video:
        return np.array([frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)])


def rendered_afterwards(run, tmp_path):
    assert entry(["render", str(run.path), "--out", str(tmp_path / "after.mp4"), "--quiet"]) == 0
    return frames(tmp_path / "after.mp4")


@pytest.mark.parametrize(
    ("scenario", "duration"), [("paper", "1.2"), ("quick", "0.5"), ("walk", "0.5")]
)
def test_a_video_of_a_run_equals_one_of_its_records(tmp_path, scenario, duration, capsys):
    words = ["run", scenario, *FAST, "--duration", duration, "--video"]
    assert entry([*words, "--out", str(tmp_path / "runs")]) <= 1
    run = open_run(tmp_path / "runs")
    assert str(run.path / "video.mp4") in capsys.readouterr().out
    during, after = frames(run.path / "video.mp4"), rendered_afterwards(run, tmp_path)
    assert np.array_equal(during, after)
    assert (run.path / "video.png").read_bytes() == (tmp_path / "after.png").read_bytes()


def test_an_interrupted_run_leaves_the_video_of_its_records(tmp_path):
    words = ["--body", "full", "--camera", "analytic", "--video", "--quiet"]
    command = [sys.executable, "-m", "hsr8", "run", "paper", *words, "--out", str(tmp_path)]
    process = subprocess.Popen(command)
    while not any(f.stat().st_size > 50_000 for f in tmp_path.rglob("records.arrows")):
        assert process.poll() is None
        clock.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert process.wait() == 130
    run = open_run(tmp_path)
    during = frames(run.path / "video.mp4")
    assert np.array_equal(during, rendered_afterwards(run, tmp_path))
    assert len(during) == round(run.records["time"][-1] * 25)


def test_a_killed_run_leaves_the_video_of_its_records(tmp_path):
    """The second process gets a SIGTERM when the first one ends."""
    entry(["run", "paper", *FAST, "--quiet", "--duration", "6", "--out", str(tmp_path / "runs")])
    folder = open_run(tmp_path / "runs").path
    manifest, scenario = folder / "manifest.json", folder / "scenario.toml"
    manifest.write_text(manifest.read_text().replace('"completed"', '"running"'))
    assert open_run(folder).running
    scenario.write_text(scenario.read_text().replace("duration = 6.0", "duration = 60.0"))
    options = ["--follow", "--camera", "head", *SMALL]
    command = [sys.executable, "-m", "hsr8", "render", str(folder), *options]
    process = subprocess.Popen(command)
    while not [*folder.glob(".*.part/video.mp4")]:
        assert process.poll() is None
        clock.sleep(0.1)
    process.terminate()
    assert process.wait() == 0
    assert len(frames(folder / "video.mp4")) == 6 * 25
    assert not [*folder.glob("*.part")]


def test_a_run_without_records_has_no_video(tmp_path, capsys):
    words = ["run", "quick", *FAST, "--quiet", "--duration", "1", "--out", str(tmp_path / "runs")]
    entry(words)
    run = open_run(tmp_path / "runs")
    shutil.copytree(run.path, tmp_path / "copy")
    (tmp_path / "copy" / "records.arrows").unlink()
    manifest = tmp_path / "copy" / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"timeout"', '"error"'))
    assert entry(["render", str(tmp_path / "copy"), "--follow", *SMALL]) == 2
    assert "no motion" in capsys.readouterr().err
    assert not list((tmp_path / "copy").glob("video*"))


def test_images_that_later_records_would_change_are_not_ready(tmp_path):
    entry(["run", "quick", *FAST, "--quiet", "--duration", "2", "--out", str(tmp_path)])
    run = open_run(tmp_path)
    for stop, ready in ((2.0, True), (2.1, False)):
        times = np.arange(0.0, stop, 0.04)
        with RunImages(run, times, (64, 64), fps=25, speed=1.0, fine=False) as images:
            assert (images.ready == len(times)) is ready
            assert images.recorded == run.seconds["time"][-1]


def test_images_drawn_while_a_batch_is_written_are_those_of_the_whole_run(tmp_path):
    """The rows of a batch become readable one table after the other."""
    entry(["run", "paper", *FAST, "--quiet", "--duration", "2", "--out", str(tmp_path)])
    run, times = open_run(tmp_path), np.arange(0.0, 2.0, 0.1)
    with RunImages(run, times, (192, 108), fps=1, speed=1.0, fine=False) as images:
        whole = [*map(images.camera("dashboard"), range(len(times)))]
    manifest, checksums = run.path / "manifest.json", run.path / CHECKSUMS
    manifest.write_text(manifest.read_text().replace('"completed"', '"running"'))
    lines = checksums.read_text().splitlines(keepends=True)
    tables = [line.split()[0] for line in lines]
    batch = tables.index("seconds") + 1
    checksums.write_text("".join(lines[:batch]))
    drawn = []
    with RunImages(open_run(run.path), times, (192, 108), fps=1, speed=1.0, fine=False) as images:
        draw = images.camera("dashboard")
        for end in range(batch, len(lines)):
            checksums.write_text("".join(lines[:end]))
            images.update(open_run(run.path))
            for index in range(len(drawn), images.ready):
                drawn.append(draw(index))
                assert np.array_equal(drawn[index], whole[index]), (tables[end - 1], index)
    assert len(drawn) == len(times)
