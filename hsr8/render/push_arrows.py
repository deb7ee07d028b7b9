"""The pushes of a run as arrows in the picture, long enough to be seen."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.run.trajectory import Trajectory
from hsr8.recorder.run.walking_table import WalkingTable

Array = NDArray[np.float64]
Arrow = tuple[Array, Array]

SHOWN = 0.5  # an arrow is seen for so long, in video time [s]
LENGTH = 0.02  # of an arrow per newton, while a push may be weak or strong [m/N]
SHORTEST, LONGEST = 0.15, 0.40  # [m]
GAP = 0.07  # an arrow ends so far from where it acts: at the skin, not inside the body [m]


@dataclass(frozen=True, slots=True)
class SeenPush:
    """One push.

    Attributes:
        begin: [s].
        impulse: [N s].
        tip: of its arrow, from the base of the robot along the axes of W (3,) [m].
        vector: its arrow (3,) [m].
    """

    begin: float
    impulse: float
    tip: Array
    vector: Array


def pushes_of(table: WalkingTable, trajectory: Trajectory) -> tuple[SeenPush, ...]:
    """All pushes that the table of a run tells of."""
    found = []
    seen = np.unique(table["push_begin"][table["push_impulse"] > 0.0], return_index=True)[1]
    rows = np.flatnonzero(table["push_impulse"] > 0.0)[seen]
    for row in rows.tolist():
        force = np.array([table[f"push_f{axis}"][row] for axis in "xyz"])
        point = np.array([table[f"push_{axis}"][row] for axis in "xyz"])
        newtons = float(np.linalg.norm(force))
        length = min(LONGEST, max(SHORTEST, LENGTH * newtons))
        found.append(
            SeenPush(
                begin=float(table["push_begin"][row]),
                impulse=float(table["push_impulse"][row]),
                tip=point - GAP / newtons * force - trajectory.qpos[row, :3],
                vector=length / newtons * force,
            )
        )
    return tuple(found)


def arrows_at(pushes: tuple[SeenPush, ...], time: float, base: Array, speed: float) -> list[Arrow]:
    """Tail and tip (3,) [m] of the arrows seen at `time`, the base of the robot being at `base`."""
    shown = SHOWN * speed
    return [
        (base + push.tip - push.vector, base + push.tip)
        for push in pushes
        if 0.0 <= time - push.begin < shown
    ]
