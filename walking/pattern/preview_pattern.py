"""Pattern generator by preview control."""

from collections.abc import Sequence

from walking.arrays import Point
from walking.parameters import PatternParameters
from walking.pattern.lipm import Lipm
from walking.pattern.pattern import TrackingGenerator
from walking.pattern.pendulum import PendulumState
from walking.pattern.preview import preview_gains
from walking.pattern.ramps import ZmpRamp
from walking.pattern.support import SupportRegion


class PreviewGenerator(TrackingGenerator):
    """Kajita's preview controller.

    The preview sum over a piecewise-linear reference is closed form in running sums of the gains:
    the reference is not sampled.

    Args:
        lipm: pendulum.
        parameters: horizon and weight.
    """

    def __init__(self, lipm: Lipm, parameters: PatternParameters) -> None:
        self._lipm = lipm
        self._gains = preview_gains(lipm, parameters)

    def advance(
        self, state: PendulumState, ramps: Sequence[ZmpRamp], region: SupportRegion
    ) -> None:
        lipm, gains = self._lipm, self._gains
        ahead_x, ahead_y = self._preview(ramps)
        px = state.zmp_x * (1.0 - gains.zmp) + ahead_x
        py = state.zmp_y * (1.0 - gains.zmp) + ahead_y
        px -= gains.position * state.x + gains.velocity * state.vx
        py -= gains.position * state.y + gains.velocity * state.vy
        state.step(lipm, (px, py), region)

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> Point:
        # With a weight on the ZMP rate, preview control deviates from the DCM of the footholds.
        return state.dcm(self._lipm.omega)

    def _preview(self, ramps: Sequence[ZmpRamp]) -> Point:
        """Return Σ_j f_j p_ref(j) over the horizon, and with its last point beyond."""
        sums, moments = self._gains.sums, self._gains.moments
        horizon = len(sums) - 1
        x = y = 0.0
        start, end_x, end_y = 0, ramps[-1].bx, ramps[-1].by
        for ramp in ramps:
            stop = min(start + ramp.ticks, horizon)
            weight = sums[stop] - sums[start]
            slope = (moments[stop] - moments[start] - start * weight) / ramp.ticks
            x += weight * ramp.ax + slope * (ramp.bx - ramp.ax)
            y += weight * ramp.ay + slope * (ramp.by - ramp.ay)
            start = stop
            if stop == horizon:
                end_x, end_y = ramp.bx, ramp.by
                break
        rest = self._gains.total - sums[start]
        return x + rest * end_x, y + rest * end_y
