"""What a pattern generator does: it moves the pendulum as the footholds ask.

All of them are given the same piecewise-linear reference of the ZMP, anew in every control tick,
so a foothold may move at any time. Two track any reference, late where they must; the others, of
`paper_pattern` and `robust_pattern`, are selective: they tell which references they can follow
with the ZMP in the soles.
"""

from collections.abc import Sequence
from typing import Protocol

from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class PatternGenerator(Protocol):
    """Moves the pendulum one tick along the reference.

    Attributes:
        selective: whether there are references that `admits` turns down.
    """

    selective: bool

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        """Whether the pendulum can go over to a reference with the ZMP in the soles.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: where the ZMP may be in this tick.
        """

    def advance(
        self,
        state: PendulumState,
        ramps: Sequence[ZmpRamp],
        region: SupportRegion,
    ) -> None:
        """Advance `state` in place; its ZMP never leaves `region`.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: where the ZMP may be.
        """

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
        """DCM [m] that the generator holds for right in the tick of a reference."""

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        """Whether the plan under way can be carried on under a reference."""

    def forget(self) -> None:
        """Give up the plan under way: the pendulum has been moved."""


class TrackingGenerator:
    """What generators have in common that take any reference and are late where they must."""

    selective = False

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        """Always: a reference that asks too much is tracked late."""
        return True

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        """Always: there is no plan but the reference."""
        return True

    def forget(self) -> None:
        """Nothing is remembered."""
