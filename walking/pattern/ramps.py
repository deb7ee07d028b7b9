"""ZMP reference: piecewise linear, as a table for kernels."""

from collections.abc import Sequence
from typing import overload

import numpy as np

from walking.arrays import Array, Point
from walking.foothold import Foothold
from walking.value import comparable_value


@comparable_value
class ZmpRamp:
    """Linear segment of the ZMP reference.

    Attributes:
        ticks: duration in control ticks [1].
        ax, ay: ZMP at the start [m].
        bx, by: ZMP at the end [m].
        feet: unloading and loading foot, in single support twice the support foot.
    """

    ticks: int
    ax: float
    ay: float
    bx: float
    by: float
    feet: tuple[Foothold, Foothold]


class Ramps(Sequence[ZmpRamp]):
    """ZMP reference: sequence of ramps.

    Args:
        table: rows of ticks | ax, ay, bx, by [m] | unloading and loading foot, see `Foothold.row`
            (n, 13).
    """

    __slots__ = ("table",)

    def __init__(self, table: Array) -> None:
        self.table = table

    def __len__(self) -> int:
        return len(self.table)

    @overload
    def __getitem__(self, index: int) -> ZmpRamp: ...
    @overload
    def __getitem__(self, index: slice) -> "Ramps": ...
    def __getitem__(self, index: int | slice) -> "ZmpRamp | Ramps":
        if isinstance(index, slice):
            return Ramps(self.table[index])
        ticks, ax, ay, bx, by, *feet = self.table[index].tolist()
        first = second = Foothold(feet[3] > 0.0, *feet[:3])
        if feet[7] != feet[3]:
            second = Foothold(feet[7] > 0.0, *feet[4:7])
        return ZmpRamp(int(ticks), ax, ay, bx, by, (first, second))

    @property
    def goal(self) -> Point:
        """ZMP at the end of the first ramp [m]."""
        x, y = self.table[0, 3:5].tolist()
        return x, y


def table_of(ramps: Sequence[ZmpRamp]) -> Array:
    """Return the table of a reference, see `Ramps` (n, 13)."""
    if isinstance(ramps, Ramps):
        return ramps.table
    rows = []
    for ramp in ramps:
        one, two = ramp.feet
        feet = (one.x, one.y, one.yaw, one.left, two.x, two.y, two.yaw, two.left)
        rows.append((ramp.ticks, ramp.ax, ramp.ay, ramp.bx, ramp.by, *feet))
    return np.array(rows, dtype=float)
