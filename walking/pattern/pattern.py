"""The ZMP pattern: what the footholds ask of the pendulum, and the pendulum that obeys.

Both generators preview the same piecewise-linear reference and are recomputed from it in
every control tick, so a foothold may move at any time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern import zmp_kernel
from walking.pattern.lipm import Lipm
from walking.pattern.preview import preview_gains
from walking.pattern.ramps import ZmpRamp, table_of
from walking.pattern.support import SupportRegion


def dcm_reference(lipm: Lipm, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
    """DCM from which the reference is walked for ever: the recursion run backward.

    Beyond the last ramp the ZMP stays and the DCM rests on it; a reference s seconds ahead
    weighs ω e^{-ωs}, which is preview control in the limit of free jerk.
    """
    return zmp_kernel.dcm(table_of(ramps), lipm.omega * CONTROL_PERIOD)


@dataclass(slots=True)
class PendulumState:
    """State of the pendulum in the plan frame.

    Attributes:
        x, y: position [m].
        vx, vy: velocity [m/s].
        zmp_x, zmp_y: ZMP of the last tick [m].
    """

    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    zmp_x: float = 0.0
    zmp_y: float = 0.0


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
        px, py = region.clip(px, py)
        state.x, state.vx = lipm.step(state.x, state.vx, px)
        state.y, state.vy = lipm.step(state.y, state.vy, py)
        state.zmp_x, state.zmp_y = px, py


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


class PreviewGenerator(TrackingGenerator):
    """Kajita's preview regulator on the same reference.

    The preview sum over a piecewise-linear reference is closed form in running sums of the
    gains, so no reference is ever sampled.

    Args:
        lipm: pendulum.
        parameters: horizon and weight.
    """

    def __init__(self, lipm: Lipm, parameters: PatternParameters) -> None:
        self._lipm = lipm
        self._gains = preview_gains(lipm, parameters)

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
        lipm, gains = self._lipm, self._gains
        ahead_x, ahead_y = self._preview(ramps)
        px = state.zmp_x * (1.0 - gains.zmp) + ahead_x
        py = state.zmp_y * (1.0 - gains.zmp) + ahead_y
        px -= gains.position * state.x + gains.velocity * state.vx
        py -= gains.position * state.y + gains.velocity * state.vy
        px, py = region.clip(px, py)
        state.x, state.vx = lipm.step(state.x, state.vx, px)
        state.y, state.vy = lipm.step(state.y, state.vy, py)
        state.zmp_x, state.zmp_y = px, py

    def planned_dcm(self, state: PendulumState, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
        """The pendulum's own DCM: weighing the ZMP's change, it keeps off that of the footholds."""
        w = self._lipm.omega
        return state.x + state.vx / w, state.y + state.vy / w

    def _preview(self, ramps: Sequence[ZmpRamp]) -> tuple[float, float]:
        """Σ_j f_j p_ref(j) over the horizon; the rest weighs on its last point."""
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
