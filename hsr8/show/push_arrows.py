"""Pushes as arrows of visible length, for videos."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.recording.derived import pushes_of
from hsr8.recording.table import Table

Array = NDArray[np.float64]


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

    def shown(self, time: float, speed: float) -> bool:
        """Return whether it is visible at `time` [s] in a video with a speed [1]."""
        return 0.0 <= time - self.begin < SHOWN * speed

    def at(self, base: Array) -> Arrow:
        """Return tail and tip (3,) [m] with the robot at `base`."""
        return base + self.tip - self.vector, base + self.tip


def push_arrows(records: Table, size: float = 1.0, weight: float = 1.0) -> tuple[PushArrow, ...]:
    """Return the arrows of all pushes of a run.

    Args:
        records: table of records.
        size: height of the robot relative to the default robot [1].
        weight: weight of the robot relative to the default robot [1].
    """
    arrows = []
    for push in pushes_of(records):
        newtons = float(np.linalg.norm(push.force))
        length = size * min(MAX_LENGTH, max(MIN_LENGTH, LENGTH * newtons / weight))
        base = records["qpos"][push.row, :3]
        arrows.append(
            PushArrow(
                begin=push.begin,
                impulse=push.impulse,
                tip=push.point - GAP * size / newtons * push.force - base,
                vector=length / newtons * push.force,
            )
        )
    return tuple(arrows)
