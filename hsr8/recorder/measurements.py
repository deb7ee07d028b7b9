"""All that reached the belief, exactly, with fingerprints of what came of it.

A file of frames behind a magic word. Each frame has its length and checksum before it, so
a damaged one is named and a killed run loses its last at most. Numbers are little-endian
doubles as they were computed: the estimator fed with them again must give the same bits.
"""

import hashlib
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.record import TickRecord
from navigation.belief import Belief
from navigation.observation import CameraView, Frame, Observation

Array = NDArray[np.float64]

MAGIC = b"HSR8MEA1"
CHANNELS = ("pose", "pose covariance", "tracks", "local map", "state")
FINGERPRINT = 8  # bytes per channel
_GUARD = struct.Struct("<II")
_COUNT = struct.Struct("<H")
_FIXED = 1 + 3 + 9 + 9 + 3 + 5  # doubles of a frame apart from its observations
_SEEN = 8  # doubles of an observation
_KINDS = ("obstacle", "beacon")


@dataclass(frozen=True, slots=True)
class Measured:
    """One recorded frame.

    Attributes:
        frame: what reached the belief.
        fingerprints: of the belief after it, one per channel.
    """

    frame: Frame
    fingerprints: tuple[bytes, ...]


class MeasurementWriter:
    """Appends the measurements of every camera frame to a file.

    Args:
        path: file to create.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("wb")
        self._file.write(MAGIC)

    def on_record(self, record: TickRecord) -> None:
        """Append the camera frame, if there is one."""
        if record.frame is not None:
            payload = _packed(record.frame.measured)
            payload += b"".join(fingerprints(record.frame.estimate))
            self._file.write(_GUARD.pack(len(payload), zlib.crc32(payload)) + payload)

    def flush(self) -> None:
        """Hand everything to the operating system."""
        self._file.flush()

    def close(self) -> None:
        """Finish the file."""
        self._file.close()


def fingerprints(belief: Belief) -> tuple[bytes, ...]:
    """Digest of each channel of a belief, in the order of `CHANNELS`."""
    tracks = hashlib.blake2b(digest_size=FINGERPRINT)
    for t in belief.tracks:
        told = f"{t.id} {t.label} {t.motion} {t.hits} {t.visible}"
        tracks.update(told.encode() + struct.pack("<4d", t.radius, t.radius_sigma, t.age, t.reach))
        for part in (t.position, t.velocity, t.covariance, t.last_seen):
            tracks.update(part.tobytes())
        if t.particles is not None:
            for part in (t.particles.positions, t.particles.velocities, t.particles.weights):
                tracks.update(part.tobytes())
    state = f"{belief.seen_beacons} {belief.lost} {belief.filter_faults}"
    return (
        _digest(belief.pose.tobytes()),
        _digest(belief.pose_covariance.tobytes()),
        tracks.digest(),
        _digest(belief.local_map.tobytes()),
        _digest(state.encode()),
    )


def read_measurements(path: Path, *, whole: bool) -> list[Measured]:
    """Read a file of measurements.

    Args:
        path: the file.
        whole: whether its last frame must be complete; that of a killed run need not be.

    Raises:
        UsageError: it is missing, damaged, or no such file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"cannot read the measurements {path}: {error.strerror}") from error
    if not content.startswith(MAGIC):
        raise UsageError(f"{path} is no file of measurements of this version of hsr8")
    frames: list[Measured] = []
    place = len(MAGIC)
    while place < len(content):
        payload = content[place + _GUARD.size :]
        length, checksum = 0, 0
        if len(content) - place >= _GUARD.size:
            length, checksum = _GUARD.unpack_from(content, place)
        if length == 0 or len(payload) < length:
            if whole:
                raise UsageError(f"{path} is cut off in frame {len(frames)}, at byte {place}")
            break
        payload = payload[:length]
        if zlib.crc32(payload) != checksum:
            raise UsageError(f"{path} is damaged in frame {len(frames)}, at byte {place}")
        frames.append(_unpacked(payload))
        place += _GUARD.size + length
    return frames


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=FINGERPRINT).digest()


def _packed(frame: Frame) -> bytes:
    view = frame.view
    angles = (view.pan, view.tilt, view.horizontal_fov, view.vertical_fov, view.yaw_sigma)
    numbers = np.concatenate(
        [
            [frame.time],
            frame.odometry,
            frame.motion_covariance.ravel(),
            view.rotation.ravel(),
            view.position,
            angles,
        ],
        dtype="<f8",
    )
    parts = [numbers.tobytes(), _COUNT.pack(len(frame.observations))]
    for o in frame.observations:
        label = o.label.encode()
        flags = _KINDS.index(o.kind) | o.cut << 1 | o.occluded << 2
        values = (o.distance, o.bearing, *o.covariance.ravel().tolist(), o.radius, o.radius_sigma)
        parts.append(bytes((flags, len(label))) + label + np.array(values, "<f8").tobytes())
    return b"".join(parts)


def _unpacked(payload: bytes) -> Measured:
    numbers = np.frombuffer(payload, "<f8", _FIXED).astype(np.float64)
    time, odometry, motion, rotation, position, angles = np.split(numbers, [1, 4, 13, 22, 25])
    place = 8 * _FIXED
    (count,) = _COUNT.unpack_from(payload, place)
    place += _COUNT.size
    observations = []
    for _ in range(count):
        flags, length = payload[place], payload[place + 1]
        place += 2 + length
        label = payload[place - length : place].decode()
        values = np.frombuffer(payload, "<f8", _SEEN, place).astype(np.float64)
        place += 8 * _SEEN
        distance, bearing, radius, radius_sigma = values[[0, 1, 6, 7]].tolist()
        observations.append(
            Observation(
                kind="beacon" if flags & 1 else "obstacle",
                label=label,
                distance=distance,
                bearing=bearing,
                covariance=values[2:6].reshape(2, 2),
                radius=radius,
                radius_sigma=radius_sigma,
                cut=bool(flags & 2),
                occluded=bool(flags & 4),
            )
        )
    frame = Frame(
        time=float(time[0]),
        odometry=odometry,
        motion_covariance=motion.reshape(3, 3),
        view=CameraView(rotation.reshape(3, 3), position, *angles.tolist()),
        observations=tuple(observations),
    )
    prints = tuple(
        payload[place + FINGERPRINT * i : place + FINGERPRINT * (i + 1)]
        for i in range(len(CHANNELS))
    )
    return Measured(frame, prints)
