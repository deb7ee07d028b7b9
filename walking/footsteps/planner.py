"""Footstep planner: velocities and command states to strides and footholds."""

from math import cos, sin, sqrt

from walking.arrays import Point
from walking.body.sole import Sole
from walking.clamp import clamp
from walking.command import CommandState
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps import stride_kernel
from walking.footsteps.foothold_kernel import Chain
from walking.footsteps.stride import STILL, Strides, Timing, Velocity
from walking.parameters import CONTROL_PERIOD, GaitParameters, LimitParameters
from walking.planar import from_frame, rotate_back

POSITION_TOLERANCE = 0.024  # of equal footholds, per half stance [1]
YAW_TOLERANCE = 1e-3  # of equal footholds [rad]
STANCE_TOLERANCE = 0.6  # of a parallel stance, per half stance [1]
STANCE_YAW_TOLERANCE = 0.05  # of a parallel stance [rad]


class FootstepPlanner:
    """Footstep planner.

    The foot on the side of a lateral or turning motion opens the stance by twice the motion of
    one footstep, the other foot closes it again; so the feet never cross and the mean velocity
    is the commanded one.

    Args:
        gait: timing, stance, clearance.
        limits: of footsteps and reach.
        sole: rectangle of the soles.

    Attributes:
        still: strides of stepping in place.
    """

    def __init__(self, gait: GaitParameters, limits: LimitParameters, sole: Sole) -> None:
        self._gait = gait
        self._limits = limits
        self._near = POSITION_TOLERANCE * gait.half_stance
        self._stance = (STANCE_TOLERANCE * gait.half_stance, STANCE_YAW_TOLERANCE)
        heel, toe = sole.centre - sole.half_length, sole.centre + sole.half_length
        self._sole = heel, toe, sole.half_width
        self._build = gait.half_stance, gait.foot_clearance, *self._sole
        self._max_step = limits.step_forward, limits.step_side, limits.step_turn
        self._strides_key: tuple[Velocity, float] = (STILL, gait.footstep_time)
        self.still = self._strides = self._make(STILL, gait.footstep_time)
        self._cadence: tuple[Velocity, Timing] = (STILL, self._timing(gait.footstep_time))

    def opening_left(self, velocity: Velocity) -> bool | None:
        """Whether the left foot opens the stance for `velocity`; None when neither does."""
        _, vy, wz = velocity
        tendency = vy / self._limits.vy + wz / self._limits.wz
        return None if tendency == 0.0 else tendency > 0.0

    def landing(self, support: Foothold, wanted: Strides) -> Foothold:
        """Return the next foothold of the swing foot."""
        return self._at(support, *(wanted.right if support.left else wanted.left))

    def cadence(self, velocity: Velocity) -> Timing:
        """Return the timing for a velocity (vx, vy, wz) [m/s, m/s, rad/s].

        Footsteps that would exceed their limits are made faster instead.
        """
        if velocity != self._cadence[0]:
            gait, limits = self._gait, self._limits
            vx, vy, wz = velocity
            x, y = vx / limits.step_forward, 2.0 * vy / limits.step_side
            turned = 2.0 * wz / limits.step_turn
            rate = sqrt(x * x + y * y + turned * turned)
            time = 1.0 / max(rate, 1.0 / gait.footstep_time)
            self._cadence = (velocity, self._timing(max(gait.min_footstep_time, time)))
        return self._cadence[1]

    def strides(self, velocity: Velocity, time: float) -> Strides:
        """Return the strides of a velocity.

        Args:
            velocity: of the middle of the stance (vx, vy, wz) [m/s, m/s, rad/s].
            time: duration of a footstep [s].
        """
        if (velocity, time) != self._strides_key:
            self._strides_key = (velocity, time)
            self._strides = self._make(velocity, time)
        return self._strides

    def explicit(self, command: CommandState, turn: float) -> tuple[Strides, list[Limit]]:
        """Return the strides of a command state, turned by `turn` [rad], and the binding limits."""
        limits, gap, bound = self._limits, self._gait.foot_clearance, []
        dx = clamp(command.forward, limits.step_forward)
        widest = 2.0 * self._gait.half_stance + limits.step_side
        apart = min(widest, command.side)
        wanted = command.direction + turn
        turned = clamp(wanted, limits.step_turn)
        if dx != command.forward:
            bound.append(Limit.STEP_LENGTH)
        if apart != command.side:
            bound.append(Limit.STEP_SIDE)
        if abs(command.direction) > limits.step_turn:
            bound.append(Limit.STEP_TURN)
        placements = []
        for side in (-1.0, 1.0):
            x, y = stride_kernel.stance_after(dx, 0.0, turned, 0.5 * side * apart)
            clear = stride_kernel.clear(y, turned, side, gap, self._sole)
            if clear != y and Limit.CLEARANCE not in bound:
                bound.append(Limit.CLEARANCE)
            rx, ry = self._within_reach(x, clear, side)
            if (rx, ry) != (x, clear) and Limit.REACH not in bound:
                bound.append(Limit.REACH)
            placements.append((rx, stride_kernel.clear(ry, turned, side, gap, self._sole), turned))
        return Strides(right=placements[0], left=placements[1]), bound

    def timing(self, command: CommandState) -> tuple[Timing, list[Limit]]:
        """Return the timing of a command state and the limits that bind."""
        limits, bound = self._limits, []
        double = min(limits.max_double, max(CONTROL_PERIOD, command.double_support))
        single = min(limits.max_single, max(limits.min_single, command.single_support))
        height = min(limits.max_swing_height, max(0.0, command.swing_height))
        if double != command.double_support or single != command.single_support:
            bound.append(Limit.TIMING)
        if height != command.swing_height:
            bound.append(Limit.SWING_HEIGHT)
        ticks = round(double / CONTROL_PERIOD), round(single / CONTROL_PERIOD)
        return Timing(*ticks, height), bound

    @staticmethod
    def command_state(strides: Strides, timing: Timing) -> CommandState:
        """Return the command state of strides and timing: inverse of `explicit` and `timing`."""
        x, y, turned = strides.left
        forward, lateral = rotate_back(0.5 * turned, x, y)
        return CommandState(
            single_support=timing.single * CONTROL_PERIOD,
            double_support=timing.double * CONTROL_PERIOD,
            forward=forward,
            side=lateral / cos(0.5 * turned),
            direction=turned,
            swing_height=timing.swing_height,
        )

    def stride_limits(self, velocity: Velocity, time: float) -> list[Limit]:
        """Return the limits that bind on footsteps of a velocity, each of duration `time` [s]."""
        vx, vy, wz = velocity
        limits = self._limits
        bound = []
        if abs(vx) * time > limits.step_forward:
            bound.append(Limit.STEP_LENGTH)
        if 2.0 * abs(vy) * time > limits.step_side:
            bound.append(Limit.STEP_SIDE)
        if 2.0 * abs(wz) * time > limits.step_turn:
            bound.append(Limit.STEP_TURN)
        if stride_kernel.strides(velocity, time, self._max_step, self._build)[2]:
            bound.append(Limit.CLEARANCE)
        return bound

    def velocity(self, strides: Strides, time: float) -> Velocity:
        """Return the mean velocity of strides of duration `time` [s], the inverse of `strides`."""
        vx = vy = wz = 0.0
        half = self._gait.half_stance
        for (x, y, turned), stance in ((strides.right, -half), (strides.left, half)):
            dx = x + stance * sin(turned)
            dy = y - stance - stance * cos(turned)
            along, across = rotate_back(0.5 * turned, dx, dy)
            vx += along
            vy += across
            wz += turned
        return vx / (2.0 * time), vy / (2.0 * time), wz / (2.0 * time)

    def _timing(self, time: float) -> Timing:
        """Return the timing of a footstep of a duration [s], at least one tick of each support."""
        ticks = max(2, round(time / CONTROL_PERIOD))
        double = min(ticks - 1, max(1, round(self._gait.double_support * ticks)))
        return Timing(double, ticks - double, self._gait.swing_height)

    def _make(self, velocity: Velocity, time: float) -> Strides:
        right, left, _ = stride_kernel.strides(velocity, time, self._max_step, self._build)
        return Strides(right=right, left=left)

    def reachable(self, support: Foothold, landing: Foothold, dx: float, dy: float) -> Foothold:
        """Shift a landing by dx, dy [m], within reach and clear of the support foot."""
        side = 1.0 if landing.left else -1.0
        wx, wy = landing.x + dx - support.x, landing.y + dy - support.y
        x, y = self._within_reach(*rotate_back(support.yaw, wx, wy), side)
        turned = landing.yaw - support.yaw
        clear = stride_kernel.clear(y, turned, side, self._gait.capture_clearance, self._sole)
        return self._at(support, x, clear, turned)

    def _within_reach(self, x: float, y: float, side: float) -> Point:
        """Scale a landing in the frame of the support foot into the ellipse of reach [m]."""
        limits = self._limits
        centre = side * 2.0 * self._gait.half_stance
        along, across = x / limits.reach_forward, (y - centre) / limits.reach_side
        square = along * along + across * across
        if square > 1.0:
            scale = 1.0 / sqrt(square)
            x, y = x * scale, centre + (y - centre) * scale
        return x, y

    def chain(self, wanted: Strides) -> Chain:
        """Return the rule of the footholds of a walk, see `foothold_kernel`."""
        still = self.still
        return (
            (wanted.right, wanted.left),
            (still.right, still.left),
            self._stance,
            self._gait.preview_steps,
        )

    def parallel(self, support: Foothold, other: Foothold) -> bool:
        """Whether the stance is parallel within tolerance.

        After an early touchdown or a capture step the foot is off its planned landing, with the
        pendulum at rest: another footstep would start it again from an infeasible state.
        """
        rest, (near, turned) = self.landing(support, self.still), self._stance
        return (
            abs(rest.x - other.x) < near
            and abs(rest.y - other.y) < near
            and abs(rest.yaw - other.yaw) < turned
        )

    def same(self, one: Foothold, other: Foothold) -> bool:
        """Whether two footholds of a foot are equal within tolerance."""
        return one is other or (
            abs(one.x - other.x) < self._near
            and abs(one.y - other.y) < self._near
            and abs(one.yaw - other.yaw) < YAW_TOLERANCE
        )

    @staticmethod
    def _at(support: Foothold, x: float, y: float, turned: float) -> Foothold:
        px, py = from_frame(support.frame, x, y)
        return Foothold(left=not support.left, x=px, y=py, yaw=support.yaw + turned)
