"""From commands to what the footsteps obey: limits, slew, and the account of both."""

from walking.command import Command, CommandState, VelocityCommand
from walking.command_limits import CommandLimits, Limit
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Timing, Velocity
from walking.footsteps.velocity import VelocitySlew, limited, speed_limits
from walking.parameters import LimitParameters
from walking.value import value

SAME_SPEED = 1e-9  # difference of velocities that is rounding
STRIDE_LIMITS = {Limit.STEP_LENGTH, Limit.STEP_SIDE, Limit.STEP_TURN, Limit.CLEARANCE}


@value
class Steady:
    """A velocity command that asks for no change: the next tick does what this one did.

    Attributes:
        command: the command.
        share: of it to walk at [1].
        bound: limits that alter it.
    """

    command: VelocityCommand
    share: float
    bound: list[Limit]

    def holds(self, command: VelocityCommand, share: float) -> bool:
        """Whether this is what is asked."""
        return share == self.share and (command is self.command or command == self.command)


class Steering:
    """Follows velocity commands and command states, one after the other in any order.

    Args:
        planner: makes strides of commands.
        limits: speed and acceleration limits.
        selective: whether the pattern takes of a change only what the legs can do; then to
            stand is a wish that needs no slew.

    Attributes:
        timing: wanted of the footsteps.
    """

    def __init__(
        self, planner: FootstepPlanner, limits: LimitParameters, *, selective: bool = False
    ) -> None:
        self._planner = planner
        self._limits = limits
        self._selective = selective
        self._slew = VelocitySlew(limits)
        self._command: Command = VelocityCommand()
        self._state: CommandState | None = None
        self._bound: list[Limit] = []
        self._steady: Steady | None = None
        self._too_fast: tuple[VelocityCommand | None, list[Limit]] = (None, [])
        self.timing = planner.cadence(self.velocity)

    @property
    def bound(self) -> tuple[Limit, ...]:
        """Limits that altered the command before it became a wish."""
        return tuple(self._bound)

    @property
    def moving(self) -> bool:
        """Whether more than standing is wanted."""
        return self._state is not None or self._slew.moving

    @property
    def velocity(self) -> Velocity:
        """Velocity that the robot is meant to have."""
        return self._slew.velocity

    def follow(self, command: Command, share: float, *, settled: bool, balanced: bool) -> None:
        """Take in a command.

        Args:
            command: of this tick.
            share: of a velocity command to walk at [1].
            settled: whether the robot may move at all yet.
            balanced: whether the motion may change.
        """
        self._command, self._bound = command, []
        steady, self._steady = self._steady, None
        if not balanced:
            self._hold(command)
        elif not settled:
            if command != VelocityCommand():
                self._bound.append(Limit.SETTLING)
            self._slew.follow(VelocityCommand())
        elif isinstance(command, CommandState):
            self._follow_state(command)
        elif steady is not None and steady.holds(command, share):
            self._steady, self._bound = steady, steady.bound
        else:
            self._follow_velocity(command, share)

    def pace(self, before: Timing, *, stepping: bool) -> Timing:
        """Timing of the footsteps to come.

        Those that only close the stance are no slower than the walk was: while a slow footstep
        lasts, a body that is still fast gets too far on its way.

        Args:
            before: timing of the footstep under way.
            stepping: whether there is one.
        """
        if stepping and not self.moving and before.duration < self.timing.duration:
            return before
        return self.timing

    def wish(self, correction: Velocity) -> Strides:
        """What the footsteps obey.

        Args:
            correction: velocity that makes up for what the feet slip; of it, footsteps that are
                commanded take only the turn.
        """
        time = self.timing.duration
        if self._state is None:
            (vx, vy, wz), velocity = correction, self._slew.velocity
            wanted = (velocity[0] + vx, velocity[1] + vy, velocity[2] + wz)
            return self._planner.strides(wanted, time)
        return self._planner.explicit(self._state, correction[2] * time)[0]

    def report(
        self, binding: list[Limit], applied: Velocity, strides: Strides | None, timing: Timing
    ) -> CommandLimits:
        """Account of this tick.

        Args:
            binding: limits met after the command had become a wish.
            applied: velocity that the footsteps follow.
            strides: that the footsteps obey in place of the wished ones, if others.
            timing: that the footsteps obey.
        """
        bound, commanded = (*self._bound, *binding), self._command
        if not bound:
            return CommandLimits(commanded, commanded, ())
        if self._state is None:
            if not STRIDE_LIMITS.isdisjoint(bound):
                time = timing.duration
                applied = self._planner.velocity(self._planner.strides(applied, time), time)
            return CommandLimits(commanded, VelocityCommand(*applied), bound)
        obeyed = strides or self._planner.explicit(self._state, 0.0)[0]
        return CommandLimits(commanded, self._planner.command_state(obeyed, timing), bound)

    def _hold(self, command: Command) -> None:
        """Nothing changes; that alters a command unless it is the one already obeyed."""
        bound = self._bound
        if isinstance(command, CommandState):
            if command != self._state:
                bound.append(Limit.BALANCE)
                return
            bound.extend(self._planner.explicit(command, 0.0)[1])
            bound.extend(self._planner.timing(command)[1])
            return
        if self._state is not None or self._differs(limited(command, self._limits)):
            bound.append(Limit.BALANCE)
        bound.extend(self._speed_limits(command))
        if self._state is None:
            bound.extend(self._planner.stride_limits(self.velocity, self.timing.duration))

    def _differs(self, wanted: Velocity) -> bool:
        """Whether the robot is not meant to have a velocity; from standing any is another."""
        if wanted == STILL:
            return self._slew.moving
        vx, vy, wz = self.velocity
        return (
            abs(vx - wanted[0]) > SAME_SPEED
            or abs(vy - wanted[1]) > SAME_SPEED
            or abs(wz - wanted[2]) > SAME_SPEED
        )

    def _speed_limits(self, command: VelocityCommand) -> list[Limit]:
        """Limits that alter the speed of a command, which stays for many ticks."""
        if command is not self._too_fast[0]:
            self._too_fast = (command, speed_limits(command, self._limits))
        return self._too_fast[1]

    def _follow_velocity(self, command: VelocityCommand, share: float) -> None:
        before, self._state = self._state, None
        was = self.velocity
        bound, dared = self._bound, command
        if share < 1.0 and command.velocity != STILL:
            vx, vy, wz = limited(command, self._limits)
            dared = VelocityCommand(share * vx, share * vy, share * wz)
            bound.append(Limit.BALANCE)
        if self._selective and command.velocity == STILL:
            self._slew.start(STILL)
        wanted = self._slew.follow(dared)
        bound.extend(self._speed_limits(command))
        velocity = self.velocity
        self.timing = self._planner.cadence(velocity)
        if self._differs(wanted):
            bound.append(Limit.ACCELERATION)
        bound.extend(self._planner.stride_limits(velocity, self.timing.duration))
        if before is None and velocity == was:
            self._steady = Steady(command, share, bound)

    def _follow_state(self, command: CommandState) -> None:
        self._state = command
        self.timing, late = self._planner.timing(command)
        strides, altered = self._planner.explicit(command, 0.0)
        self._bound.extend(altered)
        self._bound.extend(late)
        time = self.timing.duration
        # A velocity command that comes next sets out from here.
        start = self._planner.command_state(strides, self.timing)
        self._slew.start((start.forward / time, 0.0, start.direction / time))
