"""True motion of robot and movers, from which videos are drawn."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.run.run import Run

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Motion:
    """Motion of robot and movers.

    Attributes:
        time: time of each row (n,) [s].
        qpos: configurations of the robot, MuJoCo order (n, nq).
        movers: positions in W (n, movers, 2) [m].
    """

    time: Array
    qpos: Array
    movers: Array

    def __len__(self) -> int:
        return len(self.time)


def motion_of(run: Run, movers: int) -> Motion:
    """Return the motion of a run with a number of `movers`, the last of the obstacles."""
    obstacles = run.records["obstacle_positions"]
    return Motion(
        time=run.records["time"],
        qpos=run.records["qpos"],
        movers=obstacles[:, obstacles.shape[1] - movers :],
    )


def rows_at(time: Array, wanted: Array | list[float]) -> NDArray[np.intp]:
    """Return the index of the last row not after each `wanted` time (m,), at least 0."""
    index: NDArray[np.intp] = np.searchsorted(time, np.asarray(wanted) + 1e-9, side="right") - 1
    return np.maximum(index, 0)
