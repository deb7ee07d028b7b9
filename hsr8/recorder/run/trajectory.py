"""Trajectory: the exact motion of robot and movers, from which videos are drawn.

The file holds rows of little-endian doubles: time [s], qpos of the robot, then x, y of every
mover [m]. Its header gives the number of each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.files.binary import head, read_rows
from hsr8.recorder.files.writing import GrowingFile

Array = NDArray[np.float64]

MAGIC = b"HSR8TRJ1"


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
    """Writer of a trajectory.

    Args:
        path: file to create.
        nq: length of qpos.
        movers: number of movers.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, nq: int, movers: int) -> None:
        self._file = GrowingFile(path, head(MAGIC, {"nq": nq, "movers": movers}))

    def extend(
        self, times: Sequence[float], qpos: Sequence[Array], movers: Sequence[Array]
    ) -> None:
        """Append n rows: times [s], configurations (nq,), mover positions (movers, 2) [m]."""
        n = len(times)
        columns = np.reshape(times, (n, 1)), np.array(qpos), np.reshape(movers, (n, -1))
        self._file.write(np.hstack(columns, dtype="<f8").tobytes())

    def flush(self) -> None:
        """Pass all content to the operating system."""
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_trajectory(path: Path) -> Trajectory:
    """Read a trajectory, also that of a killed run.

    Raises:
        UsageError: the file is missing, damaged or not a trajectory.
    """
    header, content = read_rows(path, MAGIC, "trajectory")
    try:
        nq, movers = int(header["nq"]), int(header["movers"])
    except (ValueError, TypeError, KeyError) as error:
        raise UsageError(f"{path}: incomplete header") from error
    if nq < 0 or movers < 0:
        raise UsageError(f"{path}: incomplete header")
    width = 1 + nq + 2 * movers
    rows = len(content) // (8 * width)
    table = np.frombuffer(content, dtype="<f8", count=rows * width)
    table = table.reshape(rows, width).astype(np.float64)
    return Trajectory(
        time=table[:, 0],
        qpos=table[:, 1 : 1 + nq],
        movers=table[:, 1 + nq :].reshape(rows, movers, 2),
    )


def rows_at(time: Array, wanted: Sequence[float] | Array) -> NDArray[np.intp]:
    """Return the index of the last row not after each `wanted` time (m,), at least 0."""
    index: NDArray[np.intp] = np.searchsorted(time, np.asarray(wanted) + 1e-9, side="right") - 1
    return np.maximum(index, 0)
