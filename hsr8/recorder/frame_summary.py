"""One camera frame as a line of JSON: what the dashboard of a video shows."""

import json
from dataclasses import dataclass
from typing import Any

from hsr8.recorder.record import FrameRecord
from hsr8.world.truth import Truth
from navigation.belief import Track

_MOTIONS = ("static", "moving", "unknown")


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
class FrameSummary:
    """What one camera frame led to, without image and maps.

    Attributes:
        time: capture time [s].
        truth: true x, y, heading of the robot [m, m, rad].
        pose: believed x, y, heading [m, m, rad].
        covariance: xx, xy, yy of the believed position [m²].
        gaze: measured pan and tilt of the head [rad].
        fov: horizontal field of view [rad].
        target: destination in W [m].
        passed: via points passed.
        velocity: forward, left, turn decided [m/s, m/s, rad/s].
        situation: what velocity modification found.
        psi: partial evaluations lm, sf, ob, way.
        lost: localization has noticed that it is lost.
        tracks: believed obstacles.
        virtual_obstacles: x, y, radius of each [m].
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


def to_line(frame: FrameRecord, truth: Truth) -> str:
    """`frame` as one line of JSON, without the newline."""
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
        "tracks": [_track(track) for track in belief.tracks],
        "virtual": [_rounded([*o.position.tolist(), o.radius]) for o in motion.virtual_obstacles],
    }
    return json.dumps(line, separators=(",", ":"))


def from_line(line: str) -> FrameSummary:
    """Inverse of `to_line`, up to rounding."""
    row = json.loads(line)
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
                id=number,
                label=label,
                position=(x, y),
                velocity=(vx, vy),
                covariance=(xx, xy, yy),
                radius=radius,
                motion=_MOTIONS[motion],
                visible=bool(visible),
            )
            for number, label, x, y, vx, vy, xx, xy, yy, radius, motion, visible in row["tracks"]
        ),
        virtual_obstacles=tuple((x, y, radius) for x, y, radius in row["virtual"]),
    )


def _track(track: Track) -> list[Any]:
    return [
        track.id,
        track.label,
        *_rounded([*track.position.tolist(), *track.velocity.tolist()]),
        *_covariance(track.covariance.tolist()),
        round(track.radius, 4),
        _MOTIONS.index(track.motion),
        int(track.visible),
    ]


def _covariance(rows: list[list[float]]) -> list[float]:
    return [round(rows[0][0], 7), round(rows[0][1], 7), round(rows[1][1], 7)]


def _rounded(values: list[float]) -> list[float]:
    return [round(value, 4) for value in values]
