"""Dataset of runs: rows, episodes and statistics agree with the tables; images are in order."""

import json

import av
import cv2
import numpy as np
import pyarrow.parquet as pq
import pytest

from hsr8.cli.main import entry

FILE = "chunk-000/file-000"


def read(folder):
    """Return the description, the samples and the episodes of a dataset."""
    info = json.loads((folder / "meta/info.json").read_text())
    first = {"chunk_index": 0, "file_index": 0}
    data = pq.read_table(folder / info["data_path"].format(**first))
    episodes = pq.read_table(folder / f"meta/episodes/{FILE}.parquet").to_pylist()
    return info, data, episodes


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("exports") / "dataset"
    assert entry(["export", str(run.path), str(run.path), "--lerobot", str(path)]) == 0
    return path


def array(data, key):
    return np.array(data[key].to_pylist())


def test_samples_are_the_camera_frames(run, folder):
    info, data, episodes = read(folder)
    n = len(run.frames)
    assert info["total_frames"] == len(data) == 2 * n
    assert info["fps"] == pytest.approx(1000 / 60)
    assert np.array_equal(array(data, "index"), np.arange(2 * n))
    assert np.array_equal(array(data, "frame_index"), [*range(n)] * 2)
    assert np.array_equal(array(data, "episode_index"), np.repeat([0, 1], n))
    expected = np.tile(run.frames["pose"], (2, 1)).astype(np.float32)
    assert np.array_equal(array(data, "observation.pose").astype(np.float32), expected)
    action = np.hstack([run.frames["velocity"], run.frames["gaze"]]).astype(np.float32)
    assert np.array_equal(array(data, "action")[:n].astype(np.float32), action)
    assert array(data, "timestamp")[:n] == pytest.approx(0.06 * np.arange(n))
    spans = [(e["dataset_from_index"], e["dataset_to_index"]) for e in episodes]
    assert spans == [(0, n), (n, 2 * n)]


def test_every_feature_has_its_shape_and_statistics(folder):
    info, data, episodes = read(folder)
    statistics = json.loads((folder / "meta/stats.json").read_text())
    assert set(info["features"]) == set(data.column_names) == set(statistics)
    for key, feature in info["features"].items():
        values = array(data, key).reshape(len(data), -1)
        assert list(values.shape[1:]) == feature["shape"]
        assert feature["names"] is None or len(feature["names"]) == values.shape[1]
        assert statistics[key]["mean"] == pytest.approx(values.mean(axis=0), abs=1e-6)
        assert episodes[1][f"stats/{key}/max"] == values[len(data) // 2 :].max(axis=0).tolist()


def test_tasks_have_the_task_as_index(folder):
    tasks = pq.read_table(folder / "meta/tasks.parquet")
    assert tasks.to_pylist() == [{"task_index": 0, "task": "quick"}]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]


@pytest.mark.gl
def test_the_video_has_an_image_for_every_sample(illustrated, tmp_path, capsys):
    folder = tmp_path / "dataset"
    assert entry(["export", str(illustrated.path), "--lerobot", str(folder)]) == 0
    info, data, episodes = read(folder)
    assert len(data) == len(illustrated.images) > 1
    with av.open(str(folder / f"videos/observation.images.head/{FILE}.mp4")) as video:
        frames = [*video.decode(video=0)]
    assert len(frames) == len(data)
    assert [f.time for f in frames] == pytest.approx(array(data, "timestamp"), abs=1e-4)
    for frame, jpeg in zip(frames, illustrated.images["jpeg"], strict=True):
        image = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
        error = frame.to_ndarray(format="bgr24").astype(float) - image
        assert np.abs(error).mean() < 6.0
    assert episodes[0]["videos/observation.images.head/to_timestamp"] == pytest.approx(
        len(data) / info["fps"]
    )


@pytest.mark.gl
def test_runs_that_differ_are_refused(run, illustrated, tmp_path, capsys):
    folder = tmp_path / "dataset"
    assert entry(["export", str(run.path), str(illustrated.path), "--lerobot", str(folder)]) == 2
    assert "other images, got 320 x 240; expected none as in" in capsys.readouterr().err
    assert not folder.exists()
