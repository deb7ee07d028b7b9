"""Runs as a dataset for robot learning: LeRobotDataset v3.0, one episode per run.

A sample is a recorded image with the belief and the decision of its frame; in runs without images
every camera frame is a sample.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.recording.run import Run
from hsr8.recording.table import Table

Array = NDArray[np.float32]
Image = NDArray[np.uint8]
Statistics = dict[str, Any]

VERSION = "v3.0"
CAMERA = "observation.images.head"
FILE = "chunk-{chunk_index:03d}/file-{file_index:03d}"
FIRST = FILE.format(chunk_index=0, file_index=0)  # the only file of each part
CODEC = "libx264"
CODEC_OPTIONS = {"preset": "veryfast", "crf": "21", "g": "10", "threads": "1"}
QUANTILES = {f"q{percent:02d}": percent / 100.0 for percent in (1, 10, 50, 90, 99)}
PIXEL_STEP = 4  # of the pixels in the statistics, in both directions
NUMBERS = ("timestamp", "frame_index", "episode_index", "index", "task_index")


@dataclass(frozen=True, slots=True, eq=False)
class _Episode:
    """Samples of one run.

    Attributes:
        run: the run.
        task: name of its scenario.
        joints: names of the joints of the robot.
        period: interval between samples [s].
        values: numbers of each sample by feature (n, ...).
        images: JPEG of each sample; None in a run without images.
        size: height and width of the images [pixel].
    """

    run: Run
    task: str
    joints: tuple[str, ...]
    period: Fraction
    values: dict[str, Array]
    images: Sequence[bytes] | None
    size: tuple[int, int]

    @property
    def format(self) -> dict[str, Any]:
        """Properties that are equal in all episodes of a dataset, by name."""
        return {
            "joints": ", ".join(self.joints),
            "images": "none" if self.images is None else f"{self.size[1]} x {self.size[0]}",
            "sample period": f"{float(self.period):g} s",
        }


def write_lerobot(runs: Sequence[Run], folder: Path) -> int:
    """Write runs as a dataset and return the number of samples.

    Args:
        runs: one or more runs of one robot and camera.
        folder: new folder.

    Raises:
        UsageError: a run cannot be read, has no camera frames or differs from the first.
        OSError: the folder cannot be written.
    """
    episodes = [_episode(run) for run in runs]
    for episode in episodes[1:]:
        for name, expected in episodes[0].format.items():
            if (got := episode.format[name]) != expected:
                raise UsageError(
                    f"--lerobot: {episode.run.folder}: other {name}, got {got}; expected "
                    f"{expected} as in {episodes[0].run.folder}"
                )
    tasks = sorted({episode.task for episode in episodes})
    for part in ("meta/episodes", "data"):
        (folder / part / FIRST).parent.mkdir(parents=True)
    images = _video(folder, episodes) if episodes[0].images is not None else []
    numbers = _data(folder, episodes, tasks)
    statistics = [
        {key: _statistics(values) for key, values in episode.items()} for episode in numbers
    ]
    merged = {key: _statistics(np.concatenate([n[key] for n in numbers])) for key in numbers[0]}
    if images:
        for features, pixels in zip(statistics, images, strict=True):
            features[CAMERA] = pixels
        merged[CAMERA] = _merged_statistics(images)
    _meta(folder, episodes, tasks, statistics)
    atomic.write_json(folder / "meta/stats.json", merged)
    return sum(len(episode.values["action"]) for episode in episodes)


def _episode(run: Run) -> _Episode:
    frames, images, scenario = run.frames, run.images, run.scenario()
    step, rows = 1, np.arange(len(frames))
    if len(images):
        steps = np.diff(images["index"])
        step = int(steps[0]) if len(steps) else 1
        if (steps != step).any():
            raise UsageError(
                f"--lerobot: {run.folder}: images are missing; expected a constant rate"
            )
        rows = np.searchsorted(frames["index"], images["index"])
    if not len(rows):
        raise UsageError(f"--lerobot: {run.folder}: no camera frames")
    return _Episode(
        run=run,
        task=str(run.manifest.get("scenario", scenario.name)),
        joints=run.ticks.names("joint_position"),
        period=Fraction(step * scenario.camera.period_ms, 1000),
        values=_values(run.ticks, frames, rows),
        images=images["jpeg"].tolist() if len(images) else None,
        size=(scenario.camera.height, scenario.camera.width),
    )


def _values(ticks: Table, frames: Table, rows: NDArray[np.intp]) -> dict[str, Array]:
    """Return the numbers of the frames `rows` (n,) by feature; missing ones become 0."""
    pose, variance = frames["pose"][rows], frames["pose_covariance"][rows]
    ahead = frames["target"][rows] - pose[:, :2]
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    target = np.stack([c * ahead[:, 0] + s * ahead[:, 1], c * ahead[:, 1] - s * ahead[:, 0]], 1)
    values = {
        "observation.state": ticks["joint_position"][ticks.at(frames["time"][rows])],
        "observation.pose": pose,
        "observation.pose_sigma": np.sqrt(np.diagonal(variance, axis1=1, axis2=2)),
        "observation.target": target,
        "observation.head": frames["head"][rows],
        "action": np.hstack([frames["velocity"][rows], frames["gaze"][rows]]),
    }
    return {key: np.nan_to_num(value).astype(np.float32) for key, value in values.items()}


def _names(joints: tuple[str, ...]) -> dict[str, list[str]]:
    """Return the names of the elements of every vector."""
    return {
        "observation.state": list(joints),
        "observation.pose": ["x", "y", "heading"],
        "observation.pose_sigma": ["x", "y", "heading"],
        "observation.target": ["x", "y"],
        "observation.head": ["pan", "tilt"],
        "action": ["vx", "vy", "wz", "pan", "tilt"],
    }


def _data(
    folder: Path, episodes: Sequence[_Episode], tasks: list[str]
) -> list[dict[str, NDArray[Any]]]:
    """Write the numbers, one row group per episode, and return them by episode and feature."""
    start, result = 0, []
    writer: pq.ParquetWriter | None = None
    for number, episode in enumerate(episodes):
        count = len(episode.values["action"])
        frame_index = np.arange(count)
        columns: dict[str, NDArray[Any]] = {
            **episode.values,
            "timestamp": (frame_index * float(episode.period)).astype(np.float32),
            "frame_index": frame_index,
            "episode_index": np.full(count, number),
            "index": start + frame_index,
            "task_index": np.full(count, tasks.index(episode.task)),
        }
        table = pa.table({key: _column(value) for key, value in columns.items()})
        writer = writer or pq.ParquetWriter(folder / "data" / f"{FIRST}.parquet", table.schema)
        writer.write_table(table)
        result.append(columns)
        start += count
    assert writer is not None
    writer.close()
    return result


def _column(values: NDArray[Any]) -> pa.Array:
    if values.ndim == 1:
        return pa.array(values)
    return pa.FixedSizeListArray.from_arrays(pa.array(values.ravel()), values.shape[1])


def _video(folder: Path, episodes: Sequence[_Episode]) -> list[Statistics]:
    """Write the images of all episodes as one video and return the statistics of each."""
    rate, result = 1 / episodes[0].period, []
    file = folder / "videos" / CAMERA / f"{FIRST}.mp4"
    file.parent.mkdir(parents=True)
    with av.open(str(file), "w") as container:
        stream = container.add_stream(CODEC, rate=rate, options=CODEC_OPTIONS)
        stream.height, stream.width = episodes[0].size
        stream.pix_fmt = "yuv420p"
        for episode in episodes:
            pixels = []
            for image in _decoded(episode):
                container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="rgb24")))
                pixels.append(image[::PIXEL_STEP, ::PIXEL_STEP].reshape(-1, 3))
            result.append(_pixel_statistics(np.concatenate(pixels), len(pixels)))
        container.mux(stream.encode())
    return result


def _decoded(episode: _Episode) -> Iterator[Image]:
    for jpeg in episode.images or ():
        image = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
        assert image is not None
        yield cv2.cvtColor(image, cv2.COLOR_BGR2RGB)


def _statistics(values: NDArray[Any]) -> Statistics:
    """Return the statistics of a feature (n, ...), for each of its elements."""
    numbers = np.asarray(values, np.float64).reshape(len(values), -1)
    quantiles = np.quantile(numbers, [*QUANTILES.values()], axis=0)
    return {
        "min": numbers.min(axis=0).tolist(),
        "max": numbers.max(axis=0).tolist(),
        "mean": numbers.mean(axis=0).tolist(),
        "std": numbers.std(axis=0).tolist(),
        "count": [len(numbers)],
        **dict(zip(QUANTILES, quantiles.tolist(), strict=True)),
    }


def _pixel_statistics(pixels: Image, count: int) -> Statistics:
    """Return the statistics of each colour, from 0 to 1, of some images.

    Args:
        pixels: pixels of the images (n, 3).
        count: number of the images.

    Returns:
        Statistics of shape (3, 1, 1), and `count`.
    """
    statistics = _statistics(pixels / np.float32(255.0))
    shaped = {key: [[[v]] for v in values] for key, values in statistics.items()}
    return {**shaped, "count": [count]}


def _merged_statistics(parts: Sequence[Statistics]) -> Statistics:
    """Return the statistics of all images; quantiles are means of those of the episodes."""
    counts = np.array([part["count"][0] for part in parts])
    stacks = {key: np.array([part[key] for part in parts]) for key in parts[0] if key != "count"}
    weights = counts / counts.sum()
    mean = {key: np.tensordot(weights, values, 1) for key, values in stacks.items()}
    second = np.tensordot(weights, stacks["std"] ** 2 + stacks["mean"] ** 2, 1)
    exact = {
        "min": stacks["min"].min(axis=0),
        "max": stacks["max"].max(axis=0),
        "std": np.sqrt(np.maximum(second - mean["mean"] ** 2, 0.0)),
    }
    merged = {key: value.tolist() for key, value in (mean | exact).items()}
    return {**merged, "count": [int(counts.sum())]}


def _meta(
    folder: Path,
    episodes: Sequence[_Episode],
    tasks: list[str],
    statistics: Sequence[dict[str, Statistics]],
) -> None:
    """Write the description of the dataset, its tasks and its episodes."""
    first, rows, start = episodes[0], [], 0
    for number, (episode, features) in enumerate(zip(episodes, statistics, strict=True)):
        end = start + len(episode.values["action"])
        row: dict[str, Any] = {
            "episode_index": number,
            "tasks": [episode.task],
            "length": end - start,
            "dataset_from_index": start,
            "dataset_to_index": end,
            **_file_indices("data"),
            **_file_indices("meta/episodes"),
        }
        if episode.images is not None:
            row |= _file_indices(f"videos/{CAMERA}")
            row[f"videos/{CAMERA}/from_timestamp"] = float(start * episode.period)
            row[f"videos/{CAMERA}/to_timestamp"] = float(end * episode.period)
        for key, parts in features.items():
            row |= {f"stats/{key}/{name}": value for name, value in parts.items()}
        rows.append(row)
        start = end
    pq.write_table(pa.Table.from_pylist(rows), folder / "meta/episodes" / f"{FIRST}.parquet")
    pq.write_table(_task_table(tasks), folder / "meta/tasks.parquet")
    fps = 1 / first.period
    info = {
        "codebase_version": VERSION,
        "robot_type": first.run.scenario().robot.model,
        "total_episodes": len(episodes),
        "total_frames": start,
        "total_tasks": len(tasks),
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": int(fps) if fps.denominator == 1 else float(fps),
        "splits": {"train": f"0:{len(episodes)}"},
        "data_path": f"data/{FILE}.parquet",
        "video_path": None if first.images is None else f"videos/{{video_key}}/{FILE}.mp4",
        "features": _features(first, float(fps)),
    }
    atomic.write_json(folder / "meta/info.json", info)


def _file_indices(part: str) -> dict[str, int]:
    """Return the indices of the file `FIRST` with a part of an episode."""
    return {f"{part}/chunk_index": 0, f"{part}/file_index": 0}


def _features(episode: _Episode, fps: float) -> dict[str, Any]:
    features: dict[str, Any] = {
        key: {"dtype": "float32", "shape": [len(names)], "names": names}
        for key, names in _names(episode.joints).items()
    }
    if episode.images is not None:
        height, width = episode.size
        features[CAMERA] = {
            "dtype": "video",
            "shape": [height, width, 3],
            "names": ["height", "width", "channels"],
            "info": {
                "video.height": height,
                "video.width": width,
                "video.codec": "h264",
                "video.pix_fmt": "yuv420p",
                "video.is_depth_map": False,
                "video.fps": fps,
                "video.channels": 3,
                "has_audio": False,
            },
        }
    for key in NUMBERS:
        kind = "float32" if key == "timestamp" else "int64"
        features[key] = {"dtype": kind, "shape": [1], "names": None}
    return features


def _task_table(tasks: list[str]) -> pa.Table:
    """Return the tasks as pandas stores a frame with the task as its index."""
    columns = [
        {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": numpy}
        for name, kind, numpy in (("task_index", "int64", "int64"), ("task", "unicode", "object"))
    ]
    about = {
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [{**column, "metadata": None} for column in columns],
        "pandas_version": "2.0.0",
    }
    table = pa.table({"task_index": pa.array(range(len(tasks)), pa.int64()), "task": tasks})
    return table.replace_schema_metadata({"pandas": json.dumps(about)})
