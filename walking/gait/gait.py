"""Gait: sequence of supports, landing of the swing foot, and ZMP reference."""

import numpy as np

from walking.arrays import Array, Point
from walking.body.sole import Sole
from walking.clamp import clamp
from walking.foothold import Foothold
from walking.footsteps.foothold_kernel import RAMP
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Timing
from walking.gait import swing_foot_kernel
from walking.gait.footstep_clock import Clock, SwingWindow, WeightShift
from walking.gait.swing import min_ticks, moved, resting, stand
from walking.gait.swing_foot_kernel import HEIGHT
from walking.gait.swing_reaction import NO_SWINGS, Swings
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.ramps import Ramps, ZmpRamp, table_of
from walking.pattern.zmp_reference import ZmpReference
from walking.phase import Phase

NO_STEPS = np.empty((0, 4))


class Gait:
    """Sequence of double and single supports, counted in control ticks.

    Feet are indexed 0 left, 1 right. A footstep is a double support, in which the ZMP moves
    onto the support foot, and a single support, in which the other foot swings. The plan
    frame is that of the first stance.

    Args:
        parameters: of the engine.
        planner: of the footholds.
        stance: initial left and right foothold.
        sole: part of a sole that the ankles can press on the floor.

    Attributes:
        stepping: whether a footstep is under way.
        support: index of the support foot of this footstep.
        swing: index of the swing foot of this footstep.
        footholds: present or last foothold of each foot.
        foot_zmps: ZMP of single support on each of these [m].
        feet: foot references, see `walking.gait.swing_foot_kernel` (2, 10).
        landing: of the swing foot.
        completed: number of completed footsteps.
        landed_early: whether the swing foot touched down early.
        shortened: whether this is a capture step, shorter than its timing.
        clock: present timing, see `set_clock`.
        timing: of the next footsteps.
        swing_height: of the present swing at mid-swing [m]; it follows `timing` in the air.
        double: whether double support is planned.
        right_weight: planned load fraction of the right foot [1].
        swing_phase: 0 before and 1 after the swing [1].
        ticks_left: control ticks until the end of single support [1].
        adjustable: whether the landing may still change.
    """

    def __init__(
        self,
        parameters: WalkingParameters,
        planner: FootstepPlanner,
        stance: tuple[Foothold, Foothold],
        sole: Sole,
    ) -> None:
        gait = parameters.gait
        self._planner = planner
        self._reference = ZmpReference(parameters, sole)
        self._contact_decay = parameters.stabilizer.contact_decay
        self._start = max(1, round(gait.start_time / CONTROL_PERIOD))
        self._freeze = gait.landing_freeze
        self._min_single = round(gait.capture_single / CONTROL_PERIOD)
        self._min_double = round(gait.capture_double / CONTROL_PERIOD)
        min_swing = round(gait.min_swing_time / CONTROL_PERIOD)
        self._window = SwingWindow(gait.swing_start, gait.swing_end, min_swing)
        self._speed = gait.swing_speed
        self._move = gait.landing_speed * CONTROL_PERIOD
        self._turn = gait.landing_turn * CONTROL_PERIOD
        self._max_height_change = gait.swing_height_rate * CONTROL_PERIOD
        self.stepping = False
        self.support, self.swing = 0, 1
        self.footholds = list(stance)
        under = self._reference.under
        self.foot_zmps = (under(stance[0]), under(stance[1]))
        self.feet = resting(stance)
        self.landing = stance[1]
        self.completed = 0
        self.landed_early = self.shortened = False
        timing = planner.cadence(STILL)
        self._usual = self._window.single_support(timing.single)
        self._tick = self._reference.stop
        shift = WeightShift(0, self._tick, self._reference.between(*stance), 0.5)
        self.set_clock(Clock(timing, shift, self._usual))
        self._shift_fixed = True
        self.swing_height = timing.swing_height
        self._future = NO_STEPS
        self._walk: tuple[object, ...] | None = None  # inputs of the present plan
        self._ramps = Ramps(np.empty((0, RAMP)))
        still = planner.still
        self._nominal = still, stance[0], planner.landing(stance[0], still)

    @property
    def airborne(self) -> bool:
        """Whether the swing foot is in the air."""
        return (
            self.stepping
            and not self.landed_early
            and not self.double
            and 0.0 < self.swing_phase < 1.0
        )

    @property
    def phase(self) -> Phase:
        """Phase of the gait."""
        if not self.stepping:
            return Phase.STANDING
        if self.double:
            return Phase.DOUBLE_SUPPORT
        return Phase.RIGHT_SUPPORT if self.support else Phase.LEFT_SUPPORT

    @property
    def zmp(self) -> Point:
        """Scheduled ZMP [m]."""
        goal = (
            self.foot_zmps[self.support]
            if self.stepping
            else self._reference.between(*self.footholds)
        )
        return self._shift.zmp_at(self._tick, goal)

    @property
    def support_feet(self) -> tuple[Foothold, Foothold]:
        """Unloading and loading foot in double support, twice the support foot otherwise."""
        loading = self.footholds[self.support]
        return (self.footholds[self.swing] if self.double else loading), loading

    def start(self, support: int, *, at_once: bool = False) -> None:
        """Start to walk.

        Args:
            support: index of the first support foot.
            at_once: whether to skip the long first double support.
        """
        ticks = self.timing.double if at_once else self._start
        self._begin(support, ticks, self.zmp, self.right_weight)
        self._shift_fixed = not at_once

    def nominal(self, wanted: Strides) -> Foothold:
        """Return the landing of the wanted strides."""
        support, (known, by, landing) = self.footholds[self.support], self._nominal
        if wanted is not known or support is not by:
            landing = self._planner.landing(support, wanted)
            self._nominal = wanted, support, landing
        return landing

    def retime(self, timing: Timing) -> bool:
        """Change the timing as far as the present footstep allows.

        A double support ends in the next tick at the earliest, a foot in the air takes at least
        `min_swing_time`, and the timing is frozen with the landing.

        Returns:
            whether the present footstep has the timing, too.
        """
        _, shift, single = self.clock
        free = self.stepping and not self.shortened
        if free and self.double:
            if not self._shift_fixed and timing.double != shift.end:
                shift = self._shift_until(max(timing.double, self._tick + 1))
            if timing.single != single.ticks:
                single = self._window.single_support(timing.single)
        elif free and timing.single != single.ticks and self.adjustable:
            single = self._window.retimed(single, self._elapsed, timing.single)
        if (timing, shift, single) != self.clock:
            self.set_clock(Clock(timing, shift, single))
        if not free:
            return not self.stepping
        return shift.end == timing.double if self.double else single.ticks == timing.single

    def shorten(self, ticks: int, landing: Foothold) -> bool:
        """Shorten the footstep for a capture step.

        Args:
            ticks: wanted until the end of single support, as far as the foot can be down by then.
            landing: of the swing foot.

        Returns:
            whether the footstep ends earlier.
        """
        before, foot = self.ticks_left, self.feet[self.swing]
        if ticks >= before or self._shift_fixed or not self.adjustable:
            return False
        swing_ticks = min_ticks(foot, landing, self._speed)
        elapsed = self._elapsed
        if self.double:
            swing_ticks = max(swing_ticks, self._min_single)
            double = min(-elapsed, max(self._min_double, ticks - swing_ticks))
            single = max(swing_ticks, ticks - double)
            if double + single >= before:
                return False
            shift = self._shift_until(self._tick + double)
            self.set_clock(Clock(self.timing, shift, self._window.single_support(single)))
        else:
            rest = round((1.0 - self.swing_phase) * self._min_single)
            single = elapsed + max(swing_ticks, self._window.min_ticks, rest, ticks)
            if single >= self._single.ticks:
                return False
            retimed = self._window.retimed(self._single, elapsed, single)
            self.set_clock(Clock(self.timing, self._shift, retimed))
        self.shortened = True
        return self.ticks_left < before

    def set_clock(self, clock: Clock) -> None:
        """Replace the present timing."""
        if clock.timing.single != self._usual.ticks:
            self._usual = self._window.single_support(clock.timing.single)
        self.clock = clock
        self.timing, self._shift, self._single = clock
        self._update_phase()

    def _update_phase(self) -> None:
        """Update the phase after a change of timing, tick or `landed_early`."""
        shift, single, stepping = self._shift, self._single, self.stepping
        self._elapsed = elapsed = self._tick - shift.end
        self.double = not stepping or elapsed < 0
        self.right_weight = shift.right_weight_at(self._tick, self.support if stepping else 0.5)
        self.ticks_left = single.ticks - elapsed
        self.swing_phase = phase = single.phase(elapsed) if stepping else 1.0
        self.adjustable = stepping and not self.landed_early and phase < self._freeze

    def _shift_until(self, end: int) -> WeightShift:
        """Return the present weight shift with another end."""
        return WeightShift(self._tick, end, self.zmp, self.right_weight)

    def aim(self, wanted: Foothold) -> None:
        """Move the landing towards `wanted` by at most one tick's change."""
        self.landing = self.aimed(self.landing, wanted)

    def aimed(self, landing: Foothold, wanted: Foothold) -> Foothold:
        """Return a landing moved towards `wanted` by at most one tick's change."""
        if wanted is landing or self.swing_phase == 0.0:
            return wanted
        return moved(landing, wanted, self._move, self._turn)

    def plan(self, landing: Foothold, wanted: Strides, *, moving: bool) -> Ramps:
        """Return the ZMP reference from now on for a landing and wanted strides.

        With unchanged inputs it is the last reference with its first ramp a tick shorter.
        """
        support, swing = self.footholds[self.support], self.footholds[self.swing]
        if not self.stepping:
            self._future, self._walk = NO_STEPS, None
            centre = self._reference.between(*self.footholds)
            ramp = ZmpRamp(max(1, -self._elapsed), *self.zmp, *centre, (support, swing))
            return Ramps(table_of([ramp]))
        double, single = self.double, self._single.ticks
        walk = (support, swing, landing, wanted, self.timing, moving, double, single)
        if walk == self._walk:
            table = self._ramps.table.copy()
            if double:
                table[0, 0], table[0, 1:3] = -self._elapsed, self.zmp
            else:
                table[0, 0] = self.ticks_left
            return Ramps(table)
        self._walk = walk
        self._future, self._ramps = self._reference.plan_walk(
            (swing, support),
            landing,
            self._planner.chain(wanted),
            self.timing,
            zmp=self.zmp if double else (0.0, 0.0),
            left=(-self._elapsed, single) if double else (0, self.ticks_left),
            moving=moving,
        )
        return self._ramps

    def swings(self) -> Swings:
        """Return the present and planned swings, none while standing."""
        if not self.stepping or not len(self._future):
            return NO_SWINGS
        single, timing = self._single, self.timing
        begin = single.first - self._elapsed
        ticks = single.last - single.first
        if begin <= 0 and single.origin > 0.0:
            # Retimed in the air: extrapolate back to a swing of constant speed.
            ticks = round(ticks / (1.0 - single.origin))
            begin = -round(self.swing_phase * ticks)
        usual = self._usual
        each = usual.last - usual.first
        return Swings(
            (self.footholds[self.support].row, self.footholds[self.swing].row, self.landing.row),
            self._future,
            (begin, self.swing_height, not self.landed_early),
            (
                self.ticks_left + timing.double + usual.first,
                timing.double + timing.single,
                timing.swing_height,
            ),
            self._reference.zmp_offset,
            (each if self.landed_early else ticks, each),
        )

    def footsteps(self) -> Array:
        """Return the planned footholds, support foot first, rows of `Foothold.row` (n, 4)."""
        support = self.footholds[self.support]
        if not self.stepping:
            return np.array([support.row, self.footholds[self.swing].row])
        rows = np.empty((1 + len(self._future), 4))
        rows[0], rows[1:] = support.row, self._future
        return rows

    def touchdown(self) -> None:
        """Stop the swing foot at an early touchdown."""
        self.landed_early = True
        self.landing = Foothold(self.swing == 0, *self.feet[self.swing, :HEIGHT].tolist())
        self._update_phase()

    def advance(self, *, moving: bool) -> None:
        """Move the feet by one tick and start the next footstep at the end of this one."""
        self._tick += 1
        self._update_phase()
        self._move_feet()
        if self.stepping and self.ticks_left == 0:
            self._land(moving=moving)

    def _move_feet(self) -> None:
        swing, single, landing = -1, self._single, self.landing
        if self.stepping and not self.landed_early and single.first < self._elapsed <= single.last:
            swing = self.swing
            self.swing_height += clamp(
                self.timing.swing_height - self.swing_height, self._max_height_change
            )
        swing_foot_kernel.advance(
            self.feet,
            self._contact_decay,
            swing,
            (landing.x, landing.y, landing.yaw),
            single.last - self._elapsed + 1,
            (self.swing_height, self.swing_phase),
            CONTROL_PERIOD,
        )

    def _land(self, *, moving: bool) -> None:
        support, swing = self.support, self.swing
        self.footholds[swing] = self.landing
        under = self._reference.under(self.landing)
        self.foot_zmps = (self.foot_zmps[0], under) if swing else (under, self.foot_zmps[1])
        stand(self.feet[swing], self.landing)
        self.completed += 1
        here = self.foot_zmps[support]
        following = Foothold.from_row(self._future[1].tolist()) if len(self._future) > 1 else None
        if not moving and self._planner.parallel(self.footholds[support], self.landing):
            self.stepping = False
            self._tick = 0
            shift = WeightShift(0, self._reference.stop, here, float(support))
            self.set_clock(Clock(self.timing, shift, self._single))
            return
        self._begin(swing, self.timing.double, here, float(support))
        if following is not None:
            self.landing = following

    def _begin(self, support: int, double: int, zmp: Point, right_weight: float) -> None:
        self.stepping = True
        self.support, self.swing = support, 1 - support
        self.landed_early = self.shortened = False
        self._tick = 0
        self._shift_fixed = False
        shift = WeightShift(0, double, zmp, right_weight)
        self.set_clock(Clock(self.timing, shift, self._usual))
        self.swing_height = self.timing.swing_height
        self.landing = self.nominal(self._planner.still)
