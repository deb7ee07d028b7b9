"""The DCM of a reference, and a pendulum that tracks it."""

from collections.abc import Sequence

from walking.parameters import CONTROL_PERIOD
from walking.pattern import zmp_kernel
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.support import SupportRegion


def dcm_reference(lipm: Lipm, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
    """DCM from which the reference is walked for ever: the recursion run backward.

    Beyond the last ramp the ZMP stays and the DCM rests on it; a reference s seconds ahead
    weighs ω e^{-ωs}, which is preview control in the limit of free jerk.
    """
    return zmp_kernel.dcm(table_of(ramps), lipm.omega * CONTROL_PERIOD)


class DcmTracker:
    """Makes a pendulum track a DCM by its ZMP.

    Args:
        lipm: pendulum.
        gain: ZMP moved per error of the DCM, more than one [1].
    """

    def __init__(self, lipm: Lipm, gain: float) -> None:
        self._lipm = lipm
        self._gain = gain

    def follow(self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion) -> None:
        """Advance `state` along a reference, as near to it as the region lets the ZMP go."""
        first = ramps[0]
        middle = 0.5 / first.ticks
        x = first.ax + (first.bx - first.ax) * middle
        y = first.ay + (first.by - first.ay) * middle
        self.advance(state, dcm_reference(self._lipm, ramps), (x, y), region)

    def advance(
        self,
        state: PendulumState,
        dcm: tuple[float, float],
        zmp: tuple[float, float],
        region: SupportRegion,
    ) -> None:
        """Advance `state` in place; its ZMP never leaves `region`.

        Args:
            state: of the pendulum.
            dcm: to track [m].
            zmp: that goes with it [m].
            region: where the ZMP may be.
        """
        lipm, gain = self._lipm, self._gain
        px = zmp[0] + gain * (state.x + state.vx / lipm.omega - dcm[0])
        py = zmp[1] + gain * (state.y + state.vy / lipm.omega - dcm[1])
        state.step(lipm, (px, py), region)
