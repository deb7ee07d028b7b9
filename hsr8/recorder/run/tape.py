"""Tape: the exact setpoints of every control tick and a hash of the world every second.

The file holds one guarded payload, a block, per second: number of the first tick, number of joints,
hashes of world and robot before it, and the setpoints of each tick as little-endian doubles. The
last block of a finished run has no ticks, only the final hashes. Physics driven by these
setpoints must reproduce the hashes.
"""

import hashlib
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.files.binary import guarded, read_payloads
from hsr8.recorder.files.writing import GrowingFile

Array = NDArray[np.float64]

MAGIC = b"HSR8TAP2"
HASH = 16  # bytes of a hash
_FIRST = struct.Struct("<qi")


@dataclass(frozen=True, slots=True)
class Block:
    """One second of a run.

    Attributes:
        tick: number of its first control tick.
        world: hash of the state of the world before it, hexadecimal.
        robot: hash of world and belief before it.
        setpoints: of each tick (n, joints) [rad].
    """

    tick: int
    world: str
    robot: str
    setpoints: Array


class TapeWriter:
    """Writer of the tape of a run.

    Args:
        path: file to create.
        joints: number of joints.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, joints: int) -> None:
        self._joints = joints
        self._file = GrowingFile(path, MAGIC)
        self._payload = b""
        self._rows: list[bytes] = []

    def mark(self, tick: int, world: bytes, robot: bytes) -> None:
        """Begin a block before control tick `tick`.

        Args:
            tick: its number.
            world: complete state of the world.
            robot: belief of the robot.
        """
        if self._rows:
            self._write()
        state = hashlib.blake2b(world, digest_size=HASH)
        self._payload = _FIRST.pack(tick, self._joints) + state.digest()
        state.update(robot)
        self._payload += state.digest()

    def add(self, setpoints: Array) -> None:
        """Append one control tick (joints,) [rad]."""
        self._rows.append(setpoints.tobytes())

    def close(self) -> None:
        """Write the last block and close the file."""
        try:
            self._write()
        finally:
            self._file.close()

    def _write(self) -> None:
        if not self._payload:
            return
        self._file.write(guarded(self._payload + b"".join(self._rows)))
        self._file.flush()
        self._payload = b""
        self._rows.clear()


def read_tape(path: Path, *, whole: bool) -> list[Block]:
    """Read a tape.

    Args:
        path: the file.
        whole: require a complete last block, which a killed run may lack.

    Raises:
        UsageError: the file is missing, damaged or not a tape.
    """
    blocks: list[Block] = []
    for where, payload in read_payloads(path, MAGIC, file="tape", payload="block", whole=whole):
        try:
            block = _block(payload)
        except (struct.error, ValueError) as error:
            raise UsageError(f"{path}: damaged {where}") from error
        joints, first = (b.setpoints.shape[1] for b in (block, (*blocks, block)[0]))
        if joints != first:
            raise UsageError(
                f"{path}: damaged {where}: number of joints, got {joints}; expected {first}"
            )
        blocks.append(block)
    return blocks


def _block(payload: bytes) -> Block:
    """Return the block of a payload; a ValueError or `struct.error` means that it is damaged."""
    tick, joints = _FIRST.unpack_from(payload)
    if tick < 0 or joints < 1:
        raise ValueError
    offset = _FIRST.size
    world, robot = payload[offset : offset + HASH], payload[offset + HASH : offset + 2 * HASH]
    rows = np.frombuffer(payload, "<f8", offset=offset + 2 * HASH).astype(np.float64)
    return Block(tick, world.hex(), robot.hex(), rows.reshape(-1, joints))
