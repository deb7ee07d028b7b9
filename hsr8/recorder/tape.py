"""What every servo was told in every control tick, exactly, and a hash of the world each second.

A file of blocks of a second behind a magic word: length and checksum, number of the first
tick, hashes of world and robot before it, then the set-points of each tick as little-endian
doubles. The last block of a finished run has no ticks, only the hashes of its end. Physics fed
with the set-points again must give the same hashes. A killed run loses its last second.
"""

import hashlib
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.writing import writing
from walking.joints import JOINT_NAMES

Array = NDArray[np.float64]

MAGIC = b"HSR8TAP1"
HASH = 16  # bytes of a hash
_GUARD = struct.Struct("<II")
_FIRST = struct.Struct("<q")
_ROW = 8 * len(JOINT_NAMES)


@dataclass(frozen=True, slots=True)
class Block:
    """A second of a run.

    Attributes:
        tick: number of its first control tick.
        world: hash of the state of the world before it, hexadecimal.
        robot: hash of world and belief before it.
        set_points: of each tick (n, 26) [rad].
    """

    tick: int
    world: str
    robot: str
    set_points: Array


class TapeWriter:
    """Writes the tape of a run.

    Args:
        path: file to create, or to go on with.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._folder = path.parent
        with writing(self._folder):
            self._file = path.open("ab")
            if not self._file.tell():
                self._file.write(MAGIC)
        self._payload = b""
        self._rows: list[bytes] = []

    def mark(self, tick: int, world: bytes, robot: bytes) -> None:
        """Begin a block before control tick `tick`.

        Args:
            tick: its number.
            world: everything that determines the world's future.
            robot: digest of what the robot believes.
        """
        self.flush()
        state = hashlib.blake2b(world, digest_size=HASH)
        self._payload = _FIRST.pack(tick) + state.digest()
        state.update(robot)
        self._payload += state.digest()

    def add(self, set_points: Array) -> None:
        """Append one control tick (26,) [rad]."""
        self._rows.append(set_points.tobytes())

    def flush(self) -> None:
        """End the block, if it has any ticks, and hand it to the operating system."""
        if self._rows:
            self._write()

    def close(self) -> None:
        """Finish the file."""
        with writing(self._folder), self._file:
            self._write()

    def _write(self) -> None:
        if not self._payload:
            return
        payload = self._payload + b"".join(self._rows)
        with writing(self._folder):
            self._file.write(_GUARD.pack(len(payload), zlib.crc32(payload)) + payload)
            self._file.flush()
        self._payload = b""
        self._rows.clear()


def read_tape(path: Path, *, whole: bool) -> list[Block]:
    """Read a tape.

    Args:
        path: the file.
        whole: whether its last block must be complete; that of a killed run need not be.

    Raises:
        UsageError: it is missing, damaged, or no tape.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"cannot read the tape {path}: {error.strerror}") from error
    if not content.startswith(MAGIC):
        raise UsageError(f"{path} is no tape of this version of hsr8")
    blocks: list[Block] = []
    place = len(MAGIC)
    while place < len(content):
        start = place + _GUARD.size
        length, checksum = (0, 0)
        if start <= len(content):
            length, checksum = _GUARD.unpack_from(content, place)
        if length == 0 or start + length > len(content):
            if whole:
                raise UsageError(f"{path} is cut off in block {len(blocks)}, at byte {place}")
            break
        payload = content[start : start + length]
        rows = length - _FIRST.size - 2 * HASH
        if zlib.crc32(payload) != checksum or rows < 0 or rows % _ROW:
            raise UsageError(f"{path} is damaged in block {len(blocks)}, at byte {place}")
        blocks.append(_block(payload))
        place = start + length
    return blocks


def _block(payload: bytes) -> Block:
    place = _FIRST.size
    world, robot = payload[place : place + HASH], payload[place + HASH : place + 2 * HASH]
    rows = np.frombuffer(payload, "<f8", offset=place + 2 * HASH).astype(np.float64)
    (tick,) = _FIRST.unpack_from(payload)
    return Block(tick, world.hex(), robot.hex(), rows.reshape(-1, len(JOINT_NAMES)))
