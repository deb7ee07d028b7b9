"""DCM of a ZMP reference, and the pattern generator that tracks it."""

from collections.abc import Sequence

from walking.arrays import Point
from walking.parameters import CONTROL_PERIOD
from walking.pattern import zmp_layout_kernel
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import TrackingGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.support import SupportRegion


def dcm_reference(lipm: Lipm, ramps: Sequence[ZmpRamp]) -> Point:
    """Return the DCM from which a reference can be walked for ever: the backward recursion [m].

    Beyond the last ramp the ZMP stays and the DCM rests on it. A reference s seconds ahead has the
    weight ω e^{-ωs}: preview control in the limit of zero weight on the jerk.
    """
    return zmp_layout_kernel.dcm(table_of(ramps), lipm.omega * CONTROL_PERIOD)


class DcmGenerator(TrackingGenerator):
    """Pattern generator that tracks the DCM of the reference by the ZMP.

    Args:
        lipm: pendulum.
        gain: ZMP shift per DCM error, above one [1].
    """

    def __init__(self, lipm: Lipm, gain: float) -> None:
        self._lipm = lipm
        self._gain = gain

    def advance(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        first = ramps[0]
        middle = 0.5 / first.ticks
        x = first.ax + (first.bx - first.ax) * middle
        y = first.ay + (first.by - first.ay) * middle
        self.track(state, dcm_reference(self._lipm, ramps), (x, y), region)

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> Point:
        return dcm_reference(self._lipm, ramps)

    def track(self, state: PendulumState, dcm: Point, zmp: Point, region: SupportRegion) -> None:
        """Advance `state` in place towards a DCM.

        Args:
            state: of the pendulum.
            dcm: reference [m].
            zmp: of the reference [m].
            region: admissible ZMP.
        """
        x, y = state.dcm(self._lipm.omega)
        px = zmp[0] + self._gain * (x - dcm[0])
        py = zmp[1] + self._gain * (y - dcm[1])
        state.step(self._lipm, (px, py), region)
