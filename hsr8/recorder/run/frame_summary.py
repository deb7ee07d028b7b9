"""Summary of a camera frame as a line of JSON, for the dashboard of a video."""

import base64
import json
import zlib
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.world.truth.truth import Truth
from navigation.belief.belief import Track

_MOTIONS = ("static", "moving", "unknown")
_NUMBERS = "%.4f,%.4f,%.4f,%.4f,%.7f,%.7f,%.7f,%.4f"
_quoted = cache(json.dumps)
_encode = json.JSONEncoder(separators=(",", ":")).encode


@dataclass(frozen=True, slots=True)
class TrackSummary:
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
class GazeMapSummary:
    """Gaze map in 255 shades of its maximum.

    Attributes:
        rows, columns: cells of tilt, from below, and of pan, from the right.
        shades: one byte a cell, row by row.
    """

    rows: int
    columns: int
    shades: bytes

    def image(self) -> NDArray[np.uint8]:
        """Return the shades (rows, columns) with left and up of the head at left and up."""
        cells = np.frombuffer(self.shades, np.uint8).reshape(self.rows, self.columns)
        return cells[::-1, ::-1]


@dataclass(frozen=True, slots=True)
class FrameSummary:
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
        gaze_map: None without a map.
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
    tracks: tuple[TrackSummary, ...]
    virtual_obstacles: tuple[tuple[float, float, float], ...]
    captured: float
    look: tuple[float, float]
    boxes: tuple[Box, ...]
    gaze_map: GazeMapSummary | None


def to_line(frame: FrameRecord, truth: Truth, *, new_map: bool = True) -> str:
    """Return `frame` as one line of JSON, without the newline.

    Args:
        frame: to write.
        truth: of that time.
        new_map: include the gaze map; otherwise that of the previous line applies.
    """
    belief, gaze, motion = frame.belief, frame.gaze, frame.motion
    line: dict[str, Any] = {
        "t": round(frame.time, 4),
        "truth": _rounded(truth.robot.tolist()),
        "pose": _rounded(belief.pose.tolist()),
        "cov": _covariance(belief.pose_covariance.tolist()),
        "gaze": _rounded([belief.view.pan, belief.view.tilt]),
        "fov": round(belief.view.horizontal_fov, 4),
        "target": _rounded(frame.task.target.tolist()),
        "passed": frame.task.index,
        "v": _rounded(motion.velocity.tolist()),
        "situation": motion.situation,
        "psi": _rounded([gaze.psi_lm, gaze.psi_sf, gaze.psi_ob, gaze.psi_way]),
        "lost": int(belief.lost),
        "virtual": [_rounded([*o.position.tolist(), o.radius]) for o in motion.virtual_obstacles],
        "seen": round(frame.measured.time, 4),
        "look": _rounded([gaze.pan, gaze.tilt]),
        "blobs": [[d.label, *d.box, round(d.distance, 2)] for d in frame.detections],
    }
    if new_map:
        line["gm"] = _packed(gaze.gaze_map)
    tracks = ",".join([_track(track) for track in belief.tracks])
    return f'{_encode(line)[:-1]},"tracks":[{tracks}]}}'


def from_line(line: str, before: FrameSummary | None = None) -> FrameSummary:
    """Read a line of `to_line`.

    Args:
        line: to read.
        before: summary of the previous line.
    """
    row = json.loads(line)
    kept = None if before is None else before.gaze_map
    return FrameSummary(
        time=row["t"],
        truth=tuple(row["truth"]),
        pose=tuple(row["pose"]),
        covariance=tuple(row["cov"]),
        gaze=tuple(row["gaze"]),
        fov=row["fov"],
        target=tuple(row["target"]),
        passed=row["passed"],
        velocity=tuple(row["v"]),
        situation=row["situation"],
        psi=tuple(row["psi"]),
        lost=bool(row["lost"]),
        tracks=tuple(
            TrackSummary(
                id, label, (x, y), (vx, vy), (xx, xy, yy), r, _MOTIONS[motion], bool(visible)
            )
            for id, label, x, y, vx, vy, xx, xy, yy, r, motion, visible in row["tracks"]
        ),
        virtual_obstacles=tuple((x, y, radius) for x, y, radius in row["virtual"]),
        captured=row["seen"],
        look=tuple(row["look"]),
        boxes=tuple(
            Box(label, (left, top, right, bottom), distance)
            for label, left, top, right, bottom, distance in row["blobs"]
        ),
        gaze_map=_unpacked(row["gm"]) if "gm" in row else kept,
    )


def _track(track: Track) -> str:
    """Return a track as JSON, faster than the encoder, because most numbers are in tracks."""
    (xx, xy, *_), (_, yy, *_), *_ = track.covariance.tolist()
    x, y = track.position.tolist()
    vx, vy = track.velocity.tolist()
    numbers = _NUMBERS % (x, y, vx, vy, xx, xy, yy, track.radius)
    if "n" in numbers:
        numbers = numbers.replace("nan", "NaN").replace("inf", "Infinity")
    motion, visible = _MOTIONS.index(track.motion), int(track.visible)
    return f"[{track.id},{_quoted(track.label)},{numbers},{motion},{visible}]"


def _packed(gaze_map: NDArray[np.float64]) -> list[Any] | None:
    """Return shape and shades, None for a gaze without a map."""
    top = float(gaze_map.max(initial=0.0))
    if gaze_map.size <= 1:
        return None
    shades = np.round(gaze_map * (255.0 / top if top > 0.0 else 0.0)).astype(np.uint8)
    return [*shades.shape, base64.b85encode(zlib.compress(shades.tobytes(), 1)).decode()]


def _unpacked(packed: list[Any] | None) -> GazeMapSummary | None:
    if packed is None:
        return None
    rows, columns, text = packed
    try:
        shades = zlib.decompress(base64.b85decode(text))
    except zlib.error as error:
        raise ValueError(str(error)) from error
    if len(shades) != rows * columns:
        raise ValueError(f"a gaze map of {len(shades)} cells, not {rows} x {columns}")
    return GazeMapSummary(rows, columns, shades)


def _covariance(rows: list[list[float]]) -> list[float]:
    return [round(rows[0][0], 7), round(rows[0][1], 7), round(rows[1][1], 7)]


def _rounded(values: list[float]) -> list[float]:
    return [round(value, 4) for value in values]
