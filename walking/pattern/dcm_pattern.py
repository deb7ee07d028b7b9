"""A pattern that tracks the DCM of the footholds."""

from collections.abc import Sequence

from walking.parameters import PatternParameters
from walking.pattern.dcm_tracker import DcmTracker, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import TrackingGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class DcmGenerator(TrackingGenerator):
    """Tracks the DCM of the reference by the ZMP.

    Args:
        lipm: pendulum.
        parameters: gain of the DCM error.
    """

    def __init__(self, lipm: Lipm, parameters: PatternParameters) -> None:
        self._lipm = lipm
        self._tracker = DcmTracker(lipm, parameters.dcm_gain)

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
        self._tracker.follow(state, ramps, region)

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
        """The DCM of the footholds: the pendulum is late only after a disturbance."""
        return dcm_reference(self._lipm, ramps)
