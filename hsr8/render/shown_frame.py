"""Camera frames as the dashboard and the maps show them."""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.recorder.frame_row import FRAME
from hsr8.recorder.recorded import FrameSampler
from hsr8.recorder.run.run import Run
from hsr8.recorder.table import Table

Array = NDArray[np.float64]
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class ShownTrack:
    """A believed obstacle.

    Attributes:
        id: number of the track.
        label: colour class.
        position: in W [m].
        velocity: [m/s].
        covariance: xx, xy, yy of its position [m²].
        radius: [m].
        motion: static, moving or unknown.
        visible: seen in this frame.
    """

    id: int
    label: str
    position: tuple[float, float]
    velocity: tuple[float, float]
    covariance: tuple[float, float, float]
    radius: float
    motion: str
    visible: bool


@dataclass(frozen=True, slots=True)
class Box:
    """Detection in the image.

    Attributes:
        label: colour class, of a beacon ``top/bottom``.
        box: left, top, right, bottom [pixel].
        distance: [m].
    """

    label: str
    box: tuple[int, int, int, int]
    distance: float


@dataclass(frozen=True, slots=True)
class ShownFrame:
    """Belief and decisions of one camera frame.

    Attributes:
        time: when the frame reached the robot [s].
        truth: true x, y, heading of the robot [m, m, rad].
        pose: believed x, y, heading [m, m, rad].
        covariance: xx, xy, yy of the believed position [m²].
        gaze: measured pan and tilt of the head [rad].
        fov: horizontal field of view [rad].
        target: destination in W [m].
        passed: via points passed.
        velocity: decided (vx, vy, wz) [m/s, m/s, rad/s].
        situation: result of velocity modification.
        psi: partial evaluations lm, sf, ob, way.
        lost: localization reports being lost.
        tracks: believed obstacles.
        virtual_obstacles: x, y, radius of each [m].
        captured: when the image was taken [s].
        look: chosen pan and tilt [rad].
        boxes: detections.
        gaze_map: in 255 shades, left and up of the head at left and up (tilts, pans); None without
            a map.
    """

    time: float
    truth: tuple[float, float, float]
    pose: tuple[float, float, float]
    covariance: tuple[float, float, float]
    gaze: tuple[float, float]
    fov: float
    target: tuple[float, float]
    passed: int
    velocity: tuple[float, float, float]
    situation: str
    psi: tuple[float, float, float, float]
    lost: bool
    tracks: tuple[ShownTrack, ...]
    virtual_obstacles: tuple[tuple[float, float, float], ...]
    captured: float
    look: tuple[float, float]
    boxes: tuple[Box, ...]
    gaze_map: NDArray[np.uint8] | None


def shown_frames(run: Run, times: Array) -> tuple[ShownFrame, ...]:
    """Return the latest camera frame at each of the times (m,) [s]; empty if the run has none.

    Times with the same frame have the same object.
    """
    frames, records = run.frames, run.records
    if not len(frames):
        return ()
    rows, index = np.unique(frames.at(times), return_inverse=True)
    chosen = frames.take(rows)
    robot = records["robot"][records.at(chosen["time"])]
    shown = _shown(chosen, robot, _gaze_maps(frames, rows))
    return tuple(shown[k] for k in index.tolist())


def shown_frame(frame: FrameRecord, robot: Array) -> ShownFrame:
    """Return one camera frame with the true pose (3,) of the robot."""
    frames = Table.from_objects("frames", FRAME, [FrameSampler().sample(frame)])
    return _shown(frames, robot[None], _gaze_maps(frames, np.array([0])))[0]


def _shown(
    frames: Table, robot: Array, gaze_maps: list[NDArray[np.uint8] | None]
) -> list[ShownFrame]:
    """Return camera frames, each with the true pose of the robot (n, 3)."""
    tracks, boxes, virtual = _tracks(frames), _boxes(frames), _virtual(frames)
    columns = {name: frames[name].tolist() for name in _PLAIN}
    covariance = frames["pose_covariance"][:, (0, 0, 1), (0, 1, 1)].tolist()
    fov = frames["fov"][:, 0].tolist()
    shown = []
    for k, truth in enumerate(robot.tolist()):
        row = {name: values[k] for name, values in columns.items()}
        shown.append(
            ShownFrame(
                time=row["time"],
                truth=tuple(truth),
                pose=tuple(row["pose"]),
                covariance=tuple(covariance[k]),
                gaze=tuple(row["head"]),
                fov=fov[k],
                target=tuple(row["target"]),
                passed=row["via_points"],
                velocity=tuple(row["velocity"]),
                situation=row["situation"],
                psi=tuple(row["psi"]),
                lost=row["lost"],
                tracks=tracks[k],
                virtual_obstacles=virtual[k],
                captured=row["captured"],
                look=tuple(row["gaze"]),
                boxes=boxes[k],
                gaze_map=gaze_maps[k],
            )
        )
    return shown


_PLAIN = (
    *("time", "pose", "head", "target", "via_points", "velocity", "situation", "psi", "lost"),
    *("captured", "gaze"),
)


def _gaze_maps(frames: Table, rows: NDArray[np.intp]) -> list[NDArray[np.uint8] | None]:
    """Return the latest gaze map at each of the `rows`."""
    made, maps = frames.present("gaze_map")
    latest = np.searchsorted(made, rows, side="right") - 1
    return [maps[k][::-1, ::-1] if k >= 0 else None for k in latest.tolist()]


def _tracks(frames: Table) -> list[tuple[ShownTrack, ...]]:
    items = frames["tracks"]
    columns = (
        items["id"],
        items["label"],
        items["position"],
        items["velocity"],
        items["covariance"][:, (0, 0, 1), (0, 1, 1)],
        items["radius"],
        items["motion"],
        items["visible"],
    )
    tracks = [
        ShownTrack(id_, label, (x, y), (vx, vy), (xx, xy, yy), radius, motion, visible)
        for id_, label, (x, y), (vx, vy), (xx, xy, yy), radius, motion, visible in zip(
            *(column.tolist() for column in columns), strict=True
        )
    ]
    return _split(tracks, items.counts)


def _boxes(frames: Table) -> list[tuple[Box, ...]]:
    items = frames["detections"]
    columns = (items[name].tolist() for name in ("label", "box", "distance"))
    rows = zip(*columns, strict=True)
    return _split([Box(label, tuple(box), distance) for label, box, distance in rows], items.counts)


def _virtual(frames: Table) -> list[tuple[tuple[float, float, float], ...]]:
    items = frames["virtual_obstacles"]
    circles = zip(items["position"].tolist(), items["radius"].tolist(), strict=True)
    return _split([(x, y, radius) for (x, y), radius in circles], items.counts)


def _split(items: list[T], counts: NDArray[np.intp]) -> list[tuple[T, ...]]:
    """Return the items of each row."""
    ends = np.cumsum(counts).tolist()
    return [tuple(items[end - n : end]) for end, n in zip(ends, counts.tolist(), strict=True)]
