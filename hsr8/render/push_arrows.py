"""Pushes of a run as arrows of visible length."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.render.motion import Motion
from hsr8.render.walking_table import WalkingTable

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
        tip: from the base of the robot along the axes of W (3,) [m].
        vector: from tail to tip (3,) [m].
    """

    begin: float
    impulse: float
    tip: Array
    vector: Array


def push_arrows(
    table: WalkingTable, motion: Motion, size: float = 1.0, weight: float = 1.0
) -> tuple[PushArrow, ...]:
    """Return the arrows of all pushes of a run.

    Args:
        table: of the run.
        motion: of the run.
        size: height of the robot relative to the default robot [1].
        weight: of the robot relative to the default robot [1].
    """
    arrows = []
    pushed = np.flatnonzero(table["push_impulse"] > 0.0)
    firsts = np.unique(table["push_begin"][pushed], return_index=True)[1]
    for row in pushed[firsts].tolist():
        force = np.array([table[f"push_f{axis}"][row] for axis in "xyz"])
        point = np.array([table[f"push_{axis}"][row] for axis in "xyz"])
        newtons = float(np.linalg.norm(force))
        length = size * min(MAX_LENGTH, max(MIN_LENGTH, LENGTH * newtons / weight))
        arrows.append(
            PushArrow(
                begin=float(table["push_begin"][row]),
                impulse=float(table["push_impulse"][row]),
                tip=point - GAP * size / newtons * force - motion.qpos[row, :3],
                vector=length / newtons * force,
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
