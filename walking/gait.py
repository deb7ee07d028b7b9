"""The gait: which foot carries, where the other lands, and what that asks of the ZMP."""

from math import cos, sin

from walking.footsteps import STILL, FootstepPlanner
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern import ZmpRamp
from walking.state import Footstep, Phase
from walking.stride import Strides, Timing
from walking.swing import FootReference, least_ticks, lift_profile
from walking.swing_reaction import Swing

Point = tuple[float, float]
Clock = tuple[Timing, tuple[int, int, Point, float], tuple[int, int, int, float]]

ROUNDING = 1e-9  # of a landing that another one is one move away from [m]


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
        footholds: where the feet stand, or last stood.
        feet: reference of both feet.
        landing: where the swing foot is about to land.
        completed: number of completed footsteps.
        held: whether the swing foot has met the floor before its time.
        hurried: whether this footstep is shorter than its timing to catch a fall.
        timing: of the footsteps to come.
    """

    def __init__(
        self,
        parameters: WalkingParameters,
        planner: FootstepPlanner,
        stance: tuple[Footstep, Footstep],
    ) -> None:
        gait = parameters.gait
        self._planner = planner
        self._zmp_forward = planner.sole.centre + parameters.pattern.zmp_forward
        self._zmp_inward = parameters.pattern.zmp_inward
        self._contact_decay = parameters.stabilizer.contact_decay
        self.timing = planner.cadence(STILL)
        self._start = round(gait.start_time / CONTROL_PERIOD)
        self._stop = round(gait.stop_time / CONTROL_PERIOD)
        self._swing_share = (gait.swing_start, gait.swing_end)
        self._single = self._swing_first = self._swing_last = 0
        self._swing_origin = 0.0
        self._freeze = gait.landing_freeze
        self._shortest_single = round(gait.catch_single / CONTROL_PERIOD)
        self._shortest_double = round(gait.catch_double / CONTROL_PERIOD)
        self._speed = gait.swing_speed
        self._move = gait.landing_speed * CONTROL_PERIOD
        self._lift_change = gait.lift_speed * CONTROL_PERIOD
        self._shortest_swing = round(gait.shortest_swing / CONTROL_PERIOD)
        self.stepping = False
        self.support = 0
        self.footholds = list(stance)
        self.feet = (FootReference(stance[0]), FootReference(stance[1]))
        self.landing = stance[1]
        self.completed = 0
        self.held = self.hurried = False
        self._tick = self._stop
        self._ramp_start, self._ramp_ticks = 0, self._stop
        self._ramp_fixed = True
        self._set_single(self.timing.single)
        self._lift = self.timing.lift
        self._origin = self._centre(*stance)
        self._weight_origin = 0.5
        self._ends = True
        self._future: list[Footstep] = []

    @property
    def swing(self) -> int:
        """Index of the foot that swings in this footstep."""
        return 1 - self.support

    @property
    def double(self) -> bool:
        """Whether both feet are meant to carry."""
        return not self.stepping or self._tick < self._ramp_ticks

    @property
    def phase(self) -> Phase:
        """Phase of the gait."""
        if not self.stepping:
            return Phase.STANDING
        if self.double:
            return Phase.DOUBLE_SUPPORT
        return Phase.RIGHT_SUPPORT if self.support else Phase.LEFT_SUPPORT

    @property
    def right_weight(self) -> float:
        """Scheduled share of the weight on the right foot [1]."""
        goal = float(self.support) if self.stepping else 0.5
        return self._weight_origin + self._ramp_share * (goal - self._weight_origin)

    @property
    def swing_phase(self) -> float:
        """Progress of the swing, 0 before and 1 after it [1]."""
        if not self.stepping:
            return 1.0
        elapsed = self._tick - self._ramp_ticks - self._swing_first
        share = elapsed / (self._swing_last - self._swing_first)
        return min(1.0, max(0.0, self._swing_origin + (1.0 - self._swing_origin) * share))

    @property
    def ticks_left(self) -> int:
        """Control ticks until the end of single support."""
        return self._ramp_ticks + self._single - self._tick

    @property
    def adjustable(self) -> bool:
        """Whether the landing may still move."""
        return self.stepping and not self.held and self.swing_phase < self._freeze

    @property
    def support_feet(self) -> tuple[Footstep, Footstep]:
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
        self._begin(support, ticks, self._zmp_reference(), self.right_weight)
        self._ramp_fixed = not at_once

    def nominal(self, wish: Strides) -> Footstep:
        """Landing that the wish asks for."""
        return self._planner.landing(self.footholds[self.support], wish)

    def retime(self, timing: Timing) -> bool:
        """Take over a timing as far as it may still change.

        A double support under way ends no earlier than in the next tick, a foot in the air
        has the parameters' `shortest_swing` to come down, and once the landing is frozen the
        times are.

        Returns:
            whether this footstep has the timing, too.
        """
        self.timing = timing
        if not self.stepping:
            return True
        if self.hurried:
            return False
        if self.double:
            if not self._ramp_fixed and timing.double != self._ramp_ticks:
                self._retime_ramp(max(timing.double, self._tick + 1))
            self._set_single(timing.single)
            return self._ramp_fixed or self._ramp_ticks == timing.double
        if timing.single != self._single and self.adjustable:
            self._retime_swing(timing.single)
        return self._single == timing.single

    def hasten(self, ticks: int, landing: Footstep) -> bool:
        """End single support `ticks` from now, or as soon after as the foot can be down.

        Args:
            ticks: wanted.
            landing: that the swing foot has to reach.

        Returns:
            whether that is any sooner.
        """
        if self._ramp_fixed or not self.adjustable:
            return False
        before, foot = self.ticks_left, self.feet[self.swing]
        least = least_ticks(foot, landing, self._speed)
        elapsed = self._tick - self._ramp_ticks
        if self.double:
            least = max(least, self._shortest_single)
            ramp = min(-elapsed, max(self._shortest_double, ticks - least))
            single = max(least, ticks - ramp)
            if ramp + single >= before:
                return False
            self._retime_ramp(self._tick + ramp)
            self._set_single(single)
        else:
            least = max(
                least,
                self._shortest_swing,
                round((1.0 - self.swing_phase) * self._shortest_single),
            )
            single = elapsed + max(least, ticks)
            if single >= self._single:
                return False
            self._retime_swing(single)
        self.hurried = True
        return self.ticks_left < before

    def clock(self) -> Clock:
        """The times of now, for `set_clock`."""
        return (
            self.timing,
            (self._ramp_start, self._ramp_ticks, self._origin, self._weight_origin),
            (self._single, self._swing_first, self._swing_last, self._swing_origin),
        )

    def set_clock(self, clock: Clock) -> None:
        """Take back a change of timing made in this tick."""
        self.timing, ramp, swing = clock
        self._ramp_start, self._ramp_ticks, self._origin, self._weight_origin = ramp
        self._single, self._swing_first, self._swing_last, self._swing_origin = swing

    def _retime_ramp(self, ticks: int) -> None:
        origin, weight = self._zmp_reference(), self.right_weight
        self._origin, self._weight_origin = origin, weight
        self._ramp_start, self._ramp_ticks = self._tick, ticks

    def _retime_swing(self, single: int) -> None:
        phase, elapsed = self.swing_phase, self._tick - self._ramp_ticks
        soonest = elapsed + self._shortest_swing
        while round(self._swing_share[1] * single) < soonest:
            single += 1
        self._set_single(single)
        if phase > 0.0 or elapsed > self._swing_first:
            self._swing_origin, self._swing_first = phase, elapsed

    def _set_single(self, single: int) -> None:
        first, last = self._swing_share
        self._single = single
        self._swing_first = round(first * single)
        self._swing_last = round(last * single)
        self._swing_origin = 0.0

    def aim(self, wanted: Footstep) -> None:
        """Move the landing towards `wanted`, in the air no faster than allowed."""
        self.landing = self.aimed(self.landing, wanted)

    def aimed(self, landing: Footstep, wanted: Footstep) -> Footstep:
        """A landing moved towards `wanted` by as much as one tick allows."""
        if self.swing_phase == 0.0:
            return wanted
        dx, dy = wanted.x - landing.x, wanted.y - landing.y
        largest = max(abs(dx), abs(dy))
        if largest <= self._move + ROUNDING:
            return wanted
        share = self._move / largest
        return Footstep(
            left=wanted.left,
            x=landing.x + share * dx,
            y=landing.y + share * dy,
            yaw=wanted.yaw,
        )

    def plan(self, landing: Footstep, wish: Strides, *, moving: bool) -> list[ZmpRamp]:
        """ZMP reference from now on if the swing foot lands at `landing`."""
        if not self.stepping:
            here, centre = self._zmp_reference(), self._centre(*self.footholds)
            self._future, self._ends = [], True
            feet = (self.footholds[self.support], self.footholds[self.swing])
            return [ZmpRamp(max(1, self._ramp_ticks - self._tick), *here, *centre, feet)]
        support = self.footholds[self.support]
        steps, ends = self._planner.sequence(support, landing, wish, moving=moving)
        self._future, self._ends = steps, ends
        last = self.zmp_point(support)
        ramps = []
        if self._tick < self._ramp_ticks:
            here = self._zmp_reference()
            feet = (self.footholds[self.swing], support)
            ramps.append(ZmpRamp(self._ramp_ticks - self._tick, *here, *last, feet))
            ramps.append(ZmpRamp(self._single, *last, *last, (support, support)))
        else:
            ramps.append(ZmpRamp(self.ticks_left, *last, *last, (support, support)))
        before = support
        for step in steps[:-1] if ends else steps:
            point = self.zmp_point(step)
            ramps.append(ZmpRamp(self.timing.double, *last, *point, (before, step)))
            ramps.append(ZmpRamp(self.timing.single, *point, *point, (step, step)))
            before, last = step, point
        if ends:
            centre = self._centre(before, steps[-1])
            ramps.append(ZmpRamp(self._stop, *last, *centre, (before, steps[-1])))
        return ramps

    def swings(self) -> list[Swing]:
        """Swings under way and to come."""
        if not self.stepping or not self._future:
            return []
        begin = self._ramp_ticks + self._swing_first - self._tick
        ticks = self._swing_last - self._swing_first
        if begin <= 0 and self._swing_origin > 0.0:
            # Retimed in the air: as if it had been so quick from the start.
            ticks = round(ticks / (1.0 - self._swing_origin))
            begin = -round(self.swing_phase * ticks)
        support, origin = self.footholds[self.support], self.footholds[self.swing]
        swings = []
        if not self.held:
            zmp = self.zmp_point(support)
            swings.append(Swing(begin, ticks, self._lift, origin, self.landing, zmp))
        first, last = self._swing_share
        single, double = self.timing.single, self.timing.double
        ticks = round(last * single) - round(first * single)
        begin = self.ticks_left + double + round(first * single)
        landing = self.landing
        for following in self._future[1:]:
            zmp = self.zmp_point(landing)
            swings.append(Swing(begin, ticks, self.timing.lift, support, following, zmp))
            support, landing = landing, following
            begin += double + single
        return swings

    def footsteps(self) -> tuple[Footstep, ...]:
        """Planned footholds in the plan frame, the support foot first."""
        support = self.footholds[self.support]
        if not self.stepping:
            return support, self.footholds[self.swing]
        return support, *self._future

    def touch_down(self) -> None:
        """The swing foot has met the floor early: leave it where it is."""
        foot = self.feet[self.swing]
        self.held = True
        self.landing = Footstep(
            self.swing == 0, foot.x.position, foot.y.position, foot.yaw.position
        )

    def advance(self, *, moving: bool) -> None:
        """Move the feet one tick, and go over to the next footstep when this one is done."""
        for foot in self.feet:
            foot.height *= self._contact_decay
        self._tick += 1
        if not self.stepping:
            return
        self._move_swing()
        if self.ticks_left == 0:
            self._land(moving=moving)

    def _move_swing(self) -> None:
        elapsed = self._tick - self._ramp_ticks
        if self.held or elapsed <= self._swing_first:
            return
        foot = self.feet[self.swing]
        left = self._swing_last - elapsed
        if left >= 0:
            foot.advance(self.landing, left + 1)
            change = self.timing.lift - self._lift
            self._lift += min(self._lift_change, max(-self._lift_change, change))
            foot.height = self._lift * lift_profile(self.swing_phase)

    def _land(self, *, moving: bool) -> None:
        support, swing = self.support, self.swing
        self.footholds[swing] = self.landing
        self.feet[swing].stand(self.landing)
        self.completed += 1
        here = self.zmp_point(self.footholds[support])
        following = self._future[1] if len(self._future) > 1 else None
        if not moving and self._planner.parallel(self.footholds[support], self.landing):
            self.stepping = False
            self._tick, self._ramp_start, self._ramp_ticks = 0, 0, self._stop
            self._origin, self._weight_origin = here, float(support)
            return
        self._begin(swing, self.timing.double, here, float(support))
        if following is not None:
            self.landing = following

    def _begin(self, support: int, ticks: int, origin: Point, weight: float) -> None:
        self.stepping = True
        self.support = support
        self.held = self.hurried = False
        self._tick, self._ramp_start, self._ramp_ticks = 0, 0, ticks
        self._ramp_fixed = False
        self._set_single(self.timing.single)
        self._lift = self.timing.lift
        self._origin, self._weight_origin = origin, weight
        self.landing = self.nominal(self._planner.still)

    @property
    def _ramp_share(self) -> float:
        elapsed = self._tick - self._ramp_start
        return min(1.0, elapsed / (self._ramp_ticks - self._ramp_start))

    def _zmp_reference(self) -> Point:
        """ZMP reference at this tick."""
        goal = (
            self.zmp_point(self.footholds[self.support])
            if self.stepping
            else self._centre(*self.footholds)
        )
        share = self._ramp_share
        (ox, oy), (gx, gy) = self._origin, goal
        return ox + share * (gx - ox), oy + share * (gy - oy)

    def zmp_point(self, foot: Footstep) -> Point:
        """Where the ZMP is meant to be under a foot that carries alone [m]."""
        inward = -self._zmp_inward if foot.left else self._zmp_inward
        c, s = cos(foot.yaw), sin(foot.yaw)
        return (
            foot.x + c * self._zmp_forward - s * inward,
            foot.y + s * self._zmp_forward + c * inward,
        )

    def _centre(self, one: Footstep, other: Footstep) -> Point:
        (ax, ay), (bx, by) = self.zmp_point(one), self.zmp_point(other)
        return 0.5 * (ax + bx), 0.5 * (ay + by)
