"""True motion of robot and movers, and pushes as arrows of visible length, for videos."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.derived import Push
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


Arrow = tuple[Array, Array]

SHOWN = 0.5  # duration of an arrow in video time [s]
# For the default robot; forces are relative to the weight of the robot, lengths to its height.
LENGTH = 0.02  # of an arrow per newton [m/N]
MIN_LENGTH, MAX_LENGTH = 0.15, 0.40  # [m]
GAP = 0.07  # between the tip and the point of action, which is inside the body [m]


@dataclass(frozen=True, slots=True)
class PushArrow:
    """Arrow of one push.

    Attributes:
        begin: start of the push [s].
        impulse: [N s].
        tip: tip relative to the base of the robot along the axes of W (3,) [m].
        vector: vector from tail to tip (3,) [m].
    """

    begin: float
    impulse: float
    tip: Array
    vector: Array


def push_arrows(
    pushes: Sequence[Push], motion: Motion, size: float = 1.0, weight: float = 1.0
) -> tuple[PushArrow, ...]:
    """Return the arrows of all pushes of a run.

    Args:
        pushes: pushes of the run.
        motion: motion of the run.
        size: height of the robot relative to the default robot [1].
        weight: weight of the robot relative to the default robot [1].
    """
    arrows = []
    for push in pushes:
        newtons = float(np.linalg.norm(push.force))
        length = size * min(MAX_LENGTH, max(MIN_LENGTH, LENGTH * newtons / weight))
        arrows.append(
            PushArrow(
                begin=push.begin,
                impulse=push.impulse,
                tip=push.point - GAP * size / newtons * push.force - motion.qpos[push.row, :3],
                vector=length / newtons * push.force,
            )
        )
    return tuple(arrows)


def arrows_at(pushes: tuple[PushArrow, ...], time: float, base: Array, speed: float) -> list[Arrow]:
    """Return tail and tip (3,) [m] of the arrows visible at `time` with the robot at `base`."""
    shown = SHOWN * speed
    return [
        (base + push.tip - push.vector, base + push.tip)
        for push in pushes
        if 0.0 <= time - push.begin < shown
    ]
