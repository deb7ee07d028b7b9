"""Velocities and command states to footholds."""

from math import cos, sin, sqrt

from walking.body.sole import Sole
from walking.clamp import clamp
from walking.command import CommandState
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps import stride_kernel
from walking.footsteps.foothold_kernel import Chain
from walking.footsteps.stride import STILL, Strides, Timing, Velocity
from walking.parameters import CONTROL_PERIOD, GaitParameters, LimitParameters

PLACE_TOLERANCE = 0.024  # between footholds that count as the same, of half the stance [1]
TURN_TOLERANCE = 1e-3  # between their directions [rad]
STANCE_TOLERANCE = 0.6  # between footholds and those of standing, of half the stance [1]
STANCE_TURN = 0.05  # between their directions [rad]


class FootstepPlanner:
    """Places footholds for a velocity, one at a time.

    The foot on the side of a lateral or turning motion opens the stance by twice the motion
    of one footstep, the other foot closes it again; so the feet never cross and the mean
    velocity is the commanded one.

    Args:
        gait: timing, stance, clearance.
        limits: longest footstep and reach.
        sole: rectangle of the soles.

    Attributes:
        sole: rectangle of the soles.
        still: strides of stepping in place.
    """

    def __init__(self, gait: GaitParameters, limits: LimitParameters, sole: Sole) -> None:
        self._gait = gait
        self._limits = limits
        self._near = PLACE_TOLERANCE * gait.half_stance
        self._stance = (STANCE_TOLERANCE * gait.half_stance, STANCE_TURN)
        self.sole = sole
        heel, toe = sole.centre - sole.half_length, sole.centre + sole.half_length
        self._sole = heel, toe, sole.half_width
        self._build = gait.half_stance, gait.foot_clearance, *self._sole
        self._longest = limits.step_forward, limits.step_side, limits.step_turn
        self._asked: tuple[Velocity, float] = (STILL, gait.footstep_time)
        self.still = self._strides = self._make(STILL, gait.footstep_time)
        self._cadence: tuple[Velocity, Timing] = (STILL, self._timing(gait.footstep_time))

    def opening_left(self, velocity: Velocity) -> bool | None:
        """Whether the left foot opens the stance for `velocity`; None when neither does."""
        _, vy, wz = velocity
        tendency = vy / self._limits.vy + wz / self._limits.wz
        return None if tendency == 0.0 else tendency > 0.0

    def landing(self, support: Foothold, wish: Strides) -> Foothold:
        """Next foothold of the foot that is not `support`."""
        return self._at(support, *(wish.right if support.left else wish.left))

    def cadence(self, velocity: Velocity) -> Timing:
        """Timing and swing height for a velocity (vx, vy, wz) [m/s, m/s, rad/s].

        A walk is quickened rather than its footsteps stretched beyond their limits, all
        components together.
        """
        if velocity != self._cadence[0]:
            gait, limits = self._gait, self._limits
            vx, vy, wz = velocity
            rate = sqrt(
                (vx / limits.step_forward) ** 2
                + (2.0 * vy / limits.step_side) ** 2
                + (2.0 * wz / limits.step_turn) ** 2
            )
            time = 1.0 / max(rate, 1.0 / gait.footstep_time)
            self._cadence = (velocity, self._timing(max(gait.min_footstep_time, time)))
        return self._cadence[1]

    def strides(self, velocity: Velocity, time: float) -> Strides:
        """Strides of a velocity (vx, vy, wz) [m/s, m/s, rad/s].

        Args:
            velocity: of the stance's middle.
            time: duration of a footstep [s].
        """
        if (velocity, time) != self._asked:
            self._asked = (velocity, time)
            self._strides = self._make(velocity, time)
        return self._strides

    def explicit(self, command: CommandState, turn: float) -> tuple[Strides, list[Limit]]:
        """Strides of a command state, and the limits that altered it.

        Args:
            command: the command state.
            turn: added to its direction [rad].
        """
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
        """Timing of a command state in whole ticks, and the limits that altered it."""
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
        """The command state that `explicit` and `timing` make into these."""
        x, y, turned = strides.left
        ch, sh = cos(0.5 * turned), sin(0.5 * turned)
        return CommandState(
            single_support=timing.single * CONTROL_PERIOD,
            double_support=timing.double * CONTROL_PERIOD,
            forward=x * ch + y * sh,
            side=(y * ch - x * sh) / ch,
            direction=turned,
            swing_height=timing.swing_height,
        )

    def stride_limits(self, velocity: Velocity, time: float) -> list[Limit]:
        """Limits that bind on the footsteps of a velocity, each lasting `time` [s]."""
        vx, vy, wz = velocity
        limits = self._limits
        bound = []
        if abs(vx) * time > limits.step_forward:
            bound.append(Limit.STEP_LENGTH)
        if 2.0 * abs(vy) * time > limits.step_side:
            bound.append(Limit.STEP_SIDE)
        if 2.0 * abs(wz) * time > limits.step_turn:
            bound.append(Limit.STEP_TURN)
        if stride_kernel.strides(velocity, time, self._longest, self._build)[2]:
            bound.append(Limit.CLEARANCE)
        return bound

    def velocity(self, strides: Strides, time: float) -> Velocity:
        """Mean velocity of the stance's middle that strides make, each lasting `time` [s].

        The middle moves along the chords of its arcs, see `strides`.
        """
        vx = vy = wz = 0.0
        half = self._gait.half_stance
        for (x, y, turned), stance in ((strides.right, -half), (strides.left, half)):
            ch, sh = cos(0.5 * turned), sin(0.5 * turned)
            dx = x + stance * sin(turned)
            dy = y - stance - stance * cos(turned)
            vx += ch * dx + sh * dy
            vy += ch * dy - sh * dx
            wz += turned
        return vx / (2.0 * time), vy / (2.0 * time), wz / (2.0 * time)

    def _timing(self, time: float) -> Timing:
        """A footstep of a duration [s], in whole ticks: one of either support at least."""
        ticks = max(2, round(time / CONTROL_PERIOD))
        double = min(ticks - 1, max(1, round(self._gait.double_support * ticks)))
        return Timing(double, ticks - double, self._gait.swing_height)

    def _make(self, velocity: Velocity, time: float) -> Strides:
        right, left, _ = stride_kernel.strides(velocity, time, self._longest, self._build)
        return Strides(right=right, left=left)

    def reachable(self, support: Foothold, landing: Foothold, dx: float, dy: float) -> Foothold:
        """`landing` moved by dx, dy [m], kept within reach and clear of the support foot."""
        side = 1.0 if landing.left else -1.0
        c, s = cos(support.yaw), sin(support.yaw)
        wx, wy = landing.x + dx - support.x, landing.y + dy - support.y
        x, y = self._within_reach(c * wx + s * wy, c * wy - s * wx, side)
        turned = landing.yaw - support.yaw
        clear = stride_kernel.clear(y, turned, side, self._gait.capture_clearance, self._sole)
        return self._at(support, x, clear, turned)

    def _within_reach(self, x: float, y: float, side: float) -> tuple[float, float]:
        """A landing in the frame of the support foot, scaled into the ellipse of reach [m]."""
        limits = self._limits
        centre = side * 2.0 * self._gait.half_stance
        norm = (x / limits.reach_forward) ** 2 + ((y - centre) / limits.reach_side) ** 2
        if norm > 1.0:
            scale = norm**-0.5
            x, y = x * scale, centre + (y - centre) * scale
        return x, y

    def chain(self, wish: Strides) -> Chain:
        """How footholds follow each other."""
        still = self.still
        return (
            (wish.right, wish.left),
            (still.right, still.left),
            self._stance,
            self._gait.preview_steps,
        )

    def parallel(self, support: Foothold, other: Foothold) -> bool:
        """Whether the two feet stand side by side as for standing, or nearly so.

        A foot that meets the floor early, or is moved to keep the balance, lands beside its
        place. The pendulum has been brought to rest by then: another footstep would put it in
        motion again, from where it cannot swing onto the other foot.
        """
        rest, (near, turned) = self.landing(support, self.still), self._stance
        return (
            abs(rest.x - other.x) < near
            and abs(rest.y - other.y) < near
            and abs(rest.yaw - other.yaw) < turned
        )

    def same(self, one: Foothold, other: Foothold) -> bool:
        """Whether two footholds of a foot differ by no more than counts."""
        return one is other or (
            abs(one.x - other.x) < self._near
            and abs(one.y - other.y) < self._near
            and abs(one.yaw - other.yaw) < TURN_TOLERANCE
        )

    @staticmethod
    def _at(support: Foothold, x: float, y: float, turned: float) -> Foothold:
        c, s = cos(support.yaw), sin(support.yaw)
        return Foothold(
            left=not support.left,
            x=support.x + c * x - s * y,
            y=support.y + s * x + c * y,
            yaw=support.yaw + turned,
        )
