"""The gait: which foot carries, where the other lands, and what that asks of the ZMP."""

import numpy as np
from numpy.typing import NDArray

from walking.clamp import clamp
from walking.foothold import Foothold
from walking.footsteps.foothold_kernel import RAMP
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Timing
from walking.gait import swing_foot_kernel
from walking.gait.footstep_clock import Clock, SwingWindow, WeightShift
from walking.gait.swing import least_ticks, moved, resting, stand
from walking.gait.swing_foot_kernel import HEIGHT
from walking.gait.swing_reaction import NO_SWINGS, Swings
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.ramps import Ramps, ZmpRamp, table_of
from walking.pattern.zmp_reference import ZmpReference
from walking.phase import Phase

Array = NDArray[np.float64]
Point = tuple[float, float]
NO_STEPS = np.empty((0, 4))


class Gait:
    """Sequence of double and single supports, counted in control ticks.

    Feet are indexed 0 left, 1 right. A footstep is a double support, in which the ZMP moves
    onto the support foot, and a single support, in which the other foot swings. The plan
    frame is that of the first stance.

    Args:
        parameters: of the engine.
        planner: places the footholds.
        stance: left and right foothold at the start.

    Attributes:
        stepping: whether a footstep is under way.
        support: index of the support foot of this footstep.
        swing: index of the foot that swings in it.
        footholds: where the feet stand, or last stood.
        spots: where the ZMP is meant to be under either of these if it carries alone [m].
        feet: reference of both feet, see `walking.gait.swing_foot_kernel` (2, 10).
        landing: where the swing foot is about to land.
        completed: number of completed footsteps.
        held: whether the swing foot has met the floor before its time.
        hurried: whether this footstep is shorter than its timing to catch a fall.
        clock: all times; see `set_clock`.
        timing: of the footsteps to come.
        swing_height: of the present swing at mid-swing [m]; it follows `timing` in the air.
        double: whether both feet are meant to carry.
        right_weight: scheduled share of the weight on the right foot [1].
        swing_phase: progress of the swing, 0 before and 1 after it [1].
        ticks_left: control ticks until the end of single support [1].
        adjustable: whether the landing may still move.
    """

    def __init__(
        self,
        parameters: WalkingParameters,
        planner: FootstepPlanner,
        stance: tuple[Foothold, Foothold],
    ) -> None:
        gait = parameters.gait
        self._planner = planner
        self._reference = ZmpReference(parameters, planner.sole)
        self._contact_decay = parameters.stabilizer.contact_decay
        self._start = max(1, round(gait.start_time / CONTROL_PERIOD))
        self._freeze = gait.landing_freeze
        self._shortest_single = round(gait.capture_single / CONTROL_PERIOD)
        self._shortest_double = round(gait.capture_double / CONTROL_PERIOD)
        min_swing_time = round(gait.min_swing_time / CONTROL_PERIOD)
        self._window = SwingWindow(gait.swing_start, gait.swing_end, min_swing_time)
        self._speed = gait.swing_speed
        self._move = gait.landing_speed * CONTROL_PERIOD
        self._turn = gait.landing_turn * CONTROL_PERIOD
        self._max_height_change = gait.swing_height_rate * CONTROL_PERIOD
        self.stepping = False
        self.support, self.swing = 0, 1
        self.footholds = list(stance)
        under = self._reference.under
        self.spots = (under(stance[0]), under(stance[1]))
        self.feet = resting(stance)
        self.landing = stance[1]
        self.completed = 0
        self.held = self.hurried = False
        timing = planner.cadence(STILL)
        self._usual = self._window.single_support(timing.single)
        self._tick = self._reference.stop
        shift = WeightShift(0, self._tick, self._reference.between(*stance), 0.5)
        self.set_clock(Clock(timing, shift, self._usual))
        self._shift_fixed = True
        self.swing_height = timing.swing_height
        self._future = NO_STEPS
        self._walk: tuple[object, ...] | None = None  # what the footholds and ramps are made of
        self._ramps = Ramps(np.empty((0, RAMP)))
        still = planner.still
        self._nominal = still, stance[0], planner.landing(stance[0], still)

    @property
    def flying(self) -> bool:
        """Whether the swing foot is in the air."""
        return self.stepping and not self.held and not self.double and 0.0 < self.swing_phase < 1.0

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
            self.spots[self.support] if self.stepping else self._reference.between(*self.footholds)
        )
        return self._shift.zmp_at(self._tick, goal)

    @property
    def support_feet(self) -> tuple[Foothold, Foothold]:
        """The unloading and the loading foot in double support, the same foot twice in single."""
        loading = self.footholds[self.support]
        return (self.footholds[self.swing] if self.double else loading), loading

    def start(self, support: int, *, at_once: bool = False) -> None:
        """Begin to walk onto foot `support`.

        Args:
            support: index of the first support foot.
            at_once: whether to lift the other foot as soon as in a walk, without the long
                first double support.
        """
        ticks = self.timing.double if at_once else self._start
        self._begin(support, ticks, self.zmp, self.right_weight)
        self._shift_fixed = not at_once

    def nominal(self, wish: Strides) -> Foothold:
        """Landing that the wish asks for."""
        support, (known, by, landing) = self.footholds[self.support], self._nominal
        if wish is not known or support is not by:
            landing = self._planner.landing(support, wish)
            self._nominal = wish, support, landing
        return landing

    def retime(self, timing: Timing) -> bool:
        """Take over a timing as far as it may still change.

        A double support under way ends no earlier than in the next tick, a foot in the air
        has the parameters' `min_swing_time` to come down, and once the landing is frozen the
        times are.

        Returns:
            whether this footstep has the timing, too.
        """
        _, shift, single = self.clock
        free = self.stepping and not self.hurried
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

    def hasten(self, ticks: int, landing: Foothold) -> bool:
        """End single support `ticks` from now, or as soon after as the foot can be down.

        Args:
            ticks: wanted.
            landing: that the swing foot has to reach.

        Returns:
            whether that is any sooner.
        """
        before, foot = self.ticks_left, self.feet[self.swing]
        if ticks >= before or self._shift_fixed or not self.adjustable:
            return False
        least = least_ticks(foot, landing, self._speed)
        elapsed = self._elapsed
        if self.double:
            least = max(least, self._shortest_single)
            double = min(-elapsed, max(self._shortest_double, ticks - least))
            single = max(least, ticks - double)
            if double + single >= before:
                return False
            shift = self._shift_until(self._tick + double)
            self.set_clock(Clock(self.timing, shift, self._window.single_support(single)))
        else:
            least = max(
                least,
                self._window.shortest,
                round((1.0 - self.swing_phase) * self._shortest_single),
            )
            single = elapsed + max(least, ticks)
            if single >= self._single.ticks:
                return False
            retimed = self._window.retimed(self._single, elapsed, single)
            self.set_clock(Clock(self.timing, self._shift, retimed))
        self.hurried = True
        return self.ticks_left < before

    def set_clock(self, clock: Clock) -> None:
        """Have these times from now on, whatever there were."""
        if clock.timing.single != self._usual.ticks:
            self._usual = self._window.single_support(clock.timing.single)
        self.clock = clock
        self.timing, self._shift, self._single = clock
        self._look_at_clock()

    def _look_at_clock(self) -> None:
        """What the times say of now: after every change of them, of the tick, of `held`."""
        shift, single, stepping = self._shift, self._single, self.stepping
        self._elapsed = elapsed = self._tick - shift.end
        self.double = not stepping or elapsed < 0
        self.right_weight = shift.right_weight_at(self._tick, self.support if stepping else 0.5)
        self.ticks_left = single.ticks - elapsed
        self.swing_phase = phase = single.phase(elapsed) if stepping else 1.0
        self.adjustable = stepping and not self.held and phase < self._freeze

    def _shift_until(self, end: int) -> WeightShift:
        """The weight shift under way made to end in another tick."""
        return WeightShift(self._tick, end, self.zmp, self.right_weight)

    def aim(self, wanted: Foothold) -> None:
        """Move the landing towards `wanted`, in the air no faster than allowed."""
        self.landing = self.aimed(self.landing, wanted)

    def aimed(self, landing: Foothold, wanted: Foothold) -> Foothold:
        """A landing moved towards `wanted` by as much as one tick allows."""
        if wanted is landing or self.swing_phase == 0.0:
            return wanted
        return moved(landing, wanted, self._move, self._turn)

    def plan(self, landing: Foothold, wish: Strides, *, moving: bool) -> Ramps:
        """ZMP reference from now on if the swing foot lands at `landing`.

        Where nothing has changed it is that of the last tick, its first ramp a tick shorter.
        """
        support, swing = self.footholds[self.support], self.footholds[self.swing]
        if not self.stepping:
            self._future, self._walk = NO_STEPS, None
            centre = self._reference.between(*self.footholds)
            ramp = ZmpRamp(max(1, -self._elapsed), *self.zmp, *centre, (support, swing))
            return Ramps(table_of([ramp]))
        double, single = self.double, self._single.ticks
        walk = (support, swing, landing, wish, self.timing, moving, double, single)
        if walk == self._walk:
            table = self._ramps.table.copy()
            if double:
                table[0, 0], table[0, 1:3] = -self._elapsed, self.zmp
            else:
                table[0, 0] = self.ticks_left
            return Ramps(table)
        self._walk = walk
        self._future, self._ramps = self._reference.onwards(
            (swing, support),
            landing,
            self._planner.chain(wish),
            self.timing,
            zmp=self.zmp if double else (0.0, 0.0),
            left=(-self._elapsed, single) if double else (0, self.ticks_left),
            moving=moving,
        )
        return self._ramps

    def swings(self) -> Swings:
        """Swings under way and to come, none while the robot stands."""
        if not self.stepping or not len(self._future):
            return NO_SWINGS
        single, timing = self._single, self.timing
        begin = single.first - self._elapsed
        ticks = single.last - single.first
        if begin <= 0 and single.origin > 0.0:
            # Retimed in the air: as if it had been so quick from the start.
            ticks = round(ticks / (1.0 - single.origin))
            begin = -round(self.swing_phase * ticks)
        usual = self._usual
        each = usual.last - usual.first
        return Swings(
            (
                self.footholds[self.support].row,
                self.footholds[self.swing].row,
                self.landing.row,
            ),
            self._future,
            (begin, self.swing_height, not self.held),
            (
                self.ticks_left + timing.double + usual.first,
                timing.double + timing.single,
                timing.swing_height,
            ),
            self._reference.spot,
            (each if self.held else ticks, each),
        )

    def footsteps(self) -> Array:
        """Planned footholds in the plan frame, support foot first (n, 4); see `Foothold.row`."""
        support = self.footholds[self.support]
        if not self.stepping:
            return np.array([support.row, self.footholds[self.swing].row])
        rows = np.empty((1 + len(self._future), 4))
        rows[0], rows[1:] = support.row, self._future
        return rows

    def touchdown(self) -> None:
        """The swing foot has met the floor early: leave it where it is."""
        self.held = True
        self.landing = Foothold(self.swing == 0, *self.feet[self.swing, :HEIGHT].tolist())
        self._look_at_clock()

    def advance(self, *, moving: bool) -> None:
        """Move the feet one tick, and go over to the next footstep when this one is done."""
        self._tick += 1
        self._look_at_clock()
        self._move_feet()
        if self.stepping and self.ticks_left == 0:
            self._land(moving=moving)

    def _move_feet(self) -> None:
        swing, single, landing = -1, self._single, self.landing
        if self.stepping and not self.held and single.first < self._elapsed <= single.last:
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
        self.spots = (self.spots[0], under) if swing else (under, self.spots[1])
        stand(self.feet[swing], self.landing)
        self.completed += 1
        here = self.spots[support]
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
        self.held = self.hurried = False
        self._tick = 0
        self._shift_fixed = False
        shift = WeightShift(0, double, zmp, right_weight)
        self.set_clock(Clock(self.timing, shift, self._usual))
        self.swing_height = self.timing.swing_height
        self.landing = self.nominal(self._planner.still)
