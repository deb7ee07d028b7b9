"""The motion of a run, exact and small: what videos are drawn from afterwards.

One file of rows of little-endian doubles: time [s], qpos of the robot, then x, y of every
mover [m]. The file begins with a magic word, the length of a JSON header and that header,
padded so that the rows are aligned. A file cut anywhere loses its last row at most.
"""

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError

Array = NDArray[np.float64]

MAGIC = b"HSR8TRJ1"
_LENGTH = struct.Struct("<Q")


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Motion of robot and movers.

    Attributes:
        time: of each row (n,) [s].
        qpos: of the robot, MuJoCo order (n, nq).
        movers: positions in W (n, movers, 2) [m].
    """

    time: Array
    qpos: Array
    movers: Array

    def __len__(self) -> int:
        return len(self.time)


class TrajectoryWriter:
    """Appends rows to a trajectory file.

    Args:
        path: file to create, or to go on with.
        nq: length of qpos.
        movers: number of movers.
    """

    def __init__(self, path: Path, nq: int, movers: int) -> None:
        header = json.dumps({"nq": nq, "movers": movers}).encode()
        header += b" " * (-len(header) % 8)
        self._file = path.open("ab")
        if not self._file.tell():
            self._file.write(MAGIC + _LENGTH.pack(len(header)) + header)

    def append(self, time: float, qpos: Array, movers: Array) -> None:
        """Add one row."""
        row = np.concatenate(([time], qpos, movers.ravel()), dtype="<f8")
        self._file.write(row.tobytes())

    def flush(self) -> None:
        """Hand everything to the operating system."""
        self._file.flush()

    def close(self) -> None:
        """Finish the file."""
        self._file.close()


def read_trajectory(path: Path) -> Trajectory:
    """Read a trajectory file, also one of a run that was killed.

    Raises:
        UsageError: it is missing, or no trajectory file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"cannot read the trajectory {path}: {error.strerror}") from error
    start = len(MAGIC) + _LENGTH.size
    if len(content) < start or not content.startswith(MAGIC):
        raise UsageError(f"{path} is no trajectory file of this version of hsr8")
    (length,) = _LENGTH.unpack_from(content, len(MAGIC))
    try:
        header = json.loads(content[start : start + length])
        nq, movers = int(header["nq"]), int(header["movers"])
    except (ValueError, TypeError, KeyError) as error:
        raise UsageError(f"{path} has no whole header") from error
    width = 1 + nq + 2 * movers
    first = start + length
    if first > len(content) or nq < 0 or movers < 0:
        raise UsageError(f"{path} has no whole header")
    rows = (len(content) - first) // (8 * width)
    table = np.frombuffer(content, dtype="<f8", count=rows * width, offset=first)
    table = table.reshape(rows, width).astype(np.float64)
    return Trajectory(
        time=table[:, 0],
        qpos=table[:, 1 : 1 + nq],
        movers=table[:, 1 + nq :].reshape(rows, movers, 2),
    )


def rows_at(time: Array, wanted: Sequence[float] | Array) -> NDArray[np.intp]:
    """Index of the last row not after each wanted time (m,); the first row before that."""
    index: NDArray[np.intp] = np.searchsorted(time, np.asarray(wanted) + 1e-9, side="right") - 1
    return np.maximum(index, 0)
