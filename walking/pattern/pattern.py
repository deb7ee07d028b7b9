"""Protocol of the pattern generators.

All receive a piecewise-linear ZMP reference in every control tick, so footholds may change at any
time. Two track any reference, with delay if necessary. Those of `paper_pattern` and
`robust_pattern` are selective: they admit only references that keep the ZMP inside the soles.
"""

from collections.abc import Sequence
from typing import Protocol

from walking.arrays import Point
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class PatternGenerator(Protocol):
    """Moves the pendulum along a ZMP reference.

    Attributes:
        selective: whether `admits` rejects some references.
    """

    selective: bool

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        """Whether the pendulum can follow a reference with the ZMP inside the soles.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: admissible ZMP in this tick.
        """

    def advance(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        """Advance `state` in place by a tick; its ZMP stays in `region`.

        Args:
            state: of the pendulum.
            ramps: ZMP reference from now on.
            region: admissible ZMP.
        """

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> Point:
        """Return the reference of the DCM [m] for balance feedback."""

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        """Whether the present plan stays feasible under a reference."""

    def forget(self) -> None:
        """Drop the present plan after a jump of the pendulum."""


class TrackingGenerator:
    """Base of generators that track any reference."""

    selective = False

    def admits(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> bool:
        """Return True: an infeasible reference is tracked with delay."""
        return True

    def holds(self, ramps: Sequence[ZmpRamp]) -> bool:
        """Return True."""
        return True

    def forget(self) -> None:
        """Do nothing: there is no plan."""
