"""The motion of a run, exact and small: what videos are drawn from afterwards.

One file of rows of little-endian doubles: time [s], qpos of the robot, then x, y of every
mover [m], behind a header with the numbers of each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.recorder.files.headed_file import HeadedWriter, read_headed

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
    """Appends rows to a trajectory file.

    Args:
        path: file to create, or to go on with.
        nq: length of qpos.
        movers: number of movers.

    Raises:
        RecordingFailed: here and in every method, it cannot be written.
    """

    def __init__(self, path: Path, nq: int, movers: int) -> None:
        self._file = HeadedWriter(path, MAGIC, {"nq": nq, "movers": movers})

    def extend(
        self, times: Sequence[float], qpos: Sequence[Array], movers: Sequence[Array]
    ) -> None:
        """Add n rows: times [s], configurations (nq,), places of the movers (movers, 2) [m]."""
        n = len(times)
        columns = np.reshape(times, (n, 1)), np.array(qpos), np.reshape(movers, (n, -1))
        self._file.write(np.hstack(columns, dtype="<f8").tobytes())

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
    header, content = read_headed(path, MAGIC, "trajectory file")
    try:
        nq, movers = int(header["nq"]), int(header["movers"])
    except (ValueError, TypeError, KeyError) as error:
        raise UsageError(f"{path} has no whole header") from error
    if nq < 0 or movers < 0:
        raise UsageError(f"{path} has no whole header")
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
    """Index of the last row not after each wanted time (m,); the first row before that."""
    index: NDArray[np.intp] = np.searchsorted(time, np.asarray(wanted) + 1e-9, side="right") - 1
    return np.maximum(index, 0)
