"""Exact inputs of the belief and the decisions, with fingerprints of their outputs.

The file holds one guarded payload per camera frame. Numbers are little-endian doubles as they were
computed: estimator and planners with the same inputs must reproduce the same bits.
"""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.decisions import DecisionContext
from hsr8.errors import UsageError
from hsr8.frame_record import FrameRecord
from hsr8.recorder.files.binary import guarded, read_payloads
from hsr8.recorder.files.writing import GrowingFile
from hsr8.recorder.fingerprints import (
    DECISIONS,
    FINGERPRINT,
    decision_fingerprints,
    fingerprints,
)
from navigation.observation import CameraView, Frame, Observation

Array = NDArray[np.float64]

MAGIC = b"HSR8MEA3"
_COUNT = struct.Struct("<H")
_VIEW = 9 + 3 + 5  # doubles of a camera view
_FIXED = 1 + 3 + 9 + _VIEW  # doubles of a frame without its observations
_CONTEXT = 1 + 3 + _VIEW  # doubles of the input of a decision
_STEP = struct.Struct("<q?")
_OBSERVATION = struct.Struct("<10d")
_KINDS = ("obstacle", "beacon")


@dataclass(frozen=True, slots=True)
class Measurement:
    """Inputs of one camera frame and fingerprints of the outputs.

    Attributes:
        frame: input of the estimator.
        context: input of the decisions.
        fresh: whether no earlier decision was in force.
        fingerprints: of the belief after the frame, one per channel.
        decision: of the decisions, one per decision channel.
    """

    frame: Frame
    context: DecisionContext
    fresh: bool
    fingerprints: tuple[bytes, ...]
    decision: tuple[bytes, ...]


class MeasurementWriter:
    """Writer of the measurements of a run.

    Args:
        path: file to create.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._file = GrowingFile(path, MAGIC)

    def add(self, frame: FrameRecord) -> None:
        """Append a camera frame."""
        payload = _packed(frame.measured) + _packed_context(frame.context, frame.decision.fresh)
        estimate = fingerprints(frame.estimate)
        known = estimate if frame.belief is frame.estimate else None
        payload += b"".join(decision_fingerprints(frame.decision, known))
        payload += b"".join(estimate)
        self._file.write(guarded(payload))

    def flush(self) -> None:
        """Pass all content to the operating system."""
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_measurements(path: Path, *, whole: bool) -> list[Measurement]:
    """Read the measurements of a run.

    Args:
        path: the file.
        whole: require a complete last frame, which a killed run may lack.

    Raises:
        UsageError: the file is missing, damaged or of another kind.
    """
    frames: list[Measurement] = []
    for where, payload in read_payloads(
        path, MAGIC, file="file of measurements", payload="frame", whole=whole
    ):
        try:
            frames.append(_unpacked(payload))
        except (ValueError, IndexError, struct.error) as error:
            raise UsageError(f"{path}: damaged {where}: {error}") from error
    return frames


def _packed(frame: Frame) -> bytes:
    fixed = np.concatenate(
        [
            [frame.time],
            frame.odometry,
            frame.motion_covariance.ravel(),
            *_view_numbers(frame.view),
        ],
        dtype="<f8",
    )
    parts = [fixed.tobytes(), _COUNT.pack(len(frame.observations))]
    for o in frame.observations:
        label = o.label.encode()
        flags = _KINDS.index(o.kind) | o.cut << 1 | o.occluded << 2
        (xx, xy), (yx, yy) = o.covariance.tolist()
        numbers = (o.distance, o.bearing, xx, xy, yx, yy, o.radius, o.radius_sigma)
        content = _OBSERVATION.pack(*numbers, *o.by_radius.tolist())
        parts.append(bytes((flags, len(label))) + label + content)
    return b"".join(parts)


def _packed_context(context: DecisionContext, fresh: bool) -> bytes:
    numbers = np.concatenate(
        [[context.time], context.odometry, *_view_numbers(context.view)], dtype="<f8"
    )
    return numbers.tobytes() + _STEP.pack(context.step_count, fresh)


def _view_numbers(view: CameraView) -> tuple[Array, ...]:
    angles = (view.pan, view.tilt, view.horizontal_fov, view.vertical_fov, view.yaw_sigma)
    return view.rotation.ravel(), view.position, np.array(angles)


def _view(numbers: Array) -> CameraView:
    rotation, position, angles = np.split(numbers, [9, 12])
    return CameraView(rotation.reshape(3, 3), position, *angles.tolist())


def _unpacked(payload: bytes) -> Measurement:
    numbers = np.frombuffer(payload, "<f8", _FIXED).astype(np.float64)
    time, odometry, motion, view = np.split(numbers, [1, 4, 13])
    offset = 8 * _FIXED
    (count,) = _COUNT.unpack_from(payload, offset)
    offset += _COUNT.size
    observations = []
    for _ in range(count):
        flags, length = payload[offset], payload[offset + 1]
        offset += 2 + length
        label = payload[offset - length : offset].decode()
        distance, bearing, *rest = _OBSERVATION.unpack_from(payload, offset)
        covariance, (radius, radius_sigma), by_radius = rest[:4], rest[4:6], rest[6:]
        offset += _OBSERVATION.size
        observations.append(
            Observation(
                kind="beacon" if flags & 1 else "obstacle",
                label=label,
                distance=distance,
                bearing=bearing,
                covariance=np.reshape(covariance, (2, 2)),
                radius=radius,
                radius_sigma=radius_sigma,
                by_radius=np.array(by_radius),
                cut=bool(flags & 2),
                occluded=bool(flags & 4),
            )
        )
    frame = Frame(
        time=float(time[0]),
        odometry=odometry,
        motion_covariance=motion.reshape(3, 3),
        view=_view(view),
        observations=tuple(observations),
    )
    numbers = np.frombuffer(payload, "<f8", _CONTEXT, offset).astype(np.float64)
    offset += 8 * _CONTEXT
    step_count, fresh = _STEP.unpack_from(payload, offset)
    offset += _STEP.size
    context = DecisionContext(float(numbers[0]), numbers[1:4], _view(numbers[4:]), step_count)
    prints = [payload[k : k + FINGERPRINT] for k in range(offset, len(payload), FINGERPRINT)]
    decided, believed = prints[: len(DECISIONS)], prints[len(DECISIONS) :]
    return Measurement(frame, context, fresh, tuple(believed), tuple(decided))
