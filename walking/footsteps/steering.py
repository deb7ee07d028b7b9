"""Steering: commands to wanted strides and timing, within limits."""

from walking.command import Command, CommandState, VelocityCommand
from walking.command_limits import CommandLimits, Limit
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import STILL, Strides, Timing, Velocity
from walking.footsteps.velocity import VelocitySlew, limited, speed_limits
from walking.parameters import LimitParameters

SAME_SPEED = 1e-9  # rounding error of velocities [m/s, rad/s]
STRIDE_LIMITS = {Limit.STEP_LENGTH, Limit.STEP_SIDE, Limit.STEP_TURN, Limit.CLEARANCE}


class Steering:
    """Follows velocity commands and command states in any order.

    Args:
        planner: computes strides and timing.
        limits: speed and acceleration limits.
        selective: whether the pattern generator limits changes itself; then a stop needs no rate
            limit.

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
        self.timing = planner.cadence(self.velocity)

    @property
    def bound(self) -> tuple[Limit, ...]:
        """Limits that bind on the command before the plan."""
        return tuple(self._bound)

    @property
    def moving(self) -> bool:
        """Whether a motion is wanted."""
        return self._state is not None or self._slew.moving

    @property
    def velocity(self) -> Velocity:
        """Wanted velocity (vx, vy, wz) [m/s, m/s, rad/s]."""
        return self._slew.velocity

    def follow(
        self, command: Command, speed_ratio: float, *, settled: bool, balanced: bool
    ) -> None:
        """Follow the command of this tick.

        Args:
            command: velocity or footsteps.
            speed_ratio: of a velocity command to walk at [1].
            settled: whether the robot may start to move.
            balanced: whether the motion may change.
        """
        self._command, self._bound = command, []
        if not balanced:
            self._hold(command)
        elif not settled:
            if command != VelocityCommand():
                self._bound.append(Limit.SETTLING)
            self._slew.follow(VelocityCommand())
        elif isinstance(command, CommandState):
            self._follow_state(command)
        else:
            self._follow_velocity(command, speed_ratio)

    def next_timing(self, before: Timing, *, stepping: bool) -> Timing:
        """Return the timing of the next footsteps.

        Footsteps that close the stance are at least as fast as the walk was: during a slow footstep
        the moving body would go too far.

        Args:
            before: timing of the present footstep.
            stepping: whether a footstep is under way.
        """
        if stepping and not self.moving and before.duration < self.timing.duration:
            return before
        return self.timing

    def strides(self, correction: Velocity) -> Strides:
        """Return the wanted strides.

        Args:
            correction: of the velocity (vx, vy, wz) [m/s, m/s, rad/s]; command states use only wz.
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
        """Return the report of this tick.

        Args:
            binding: limits that bind on the plan.
            applied: velocity that the footsteps follow.
            strides: that the footsteps follow instead of the wanted ones, if limited.
            timing: that the footsteps follow.
        """
        bound, commanded = (*self._bound, *binding), self._command
        if not bound:
            return CommandLimits(commanded, commanded, ())
        if self._state is None:
            if not STRIDE_LIMITS.isdisjoint(bound):
                time = timing.duration
                applied = self._planner.velocity(self._planner.strides(applied, time), time)
            return CommandLimits(commanded, VelocityCommand(*applied), bound)
        followed = strides or self._planner.explicit(self._state, 0.0)[0]
        return CommandLimits(commanded, self._planner.command_state(followed, timing), bound)

    def _hold(self, command: Command) -> None:
        """Keep the present motion; balance limits any other command."""
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
        bound.extend(speed_limits(command, self._limits))
        if self._state is None:
            bound.extend(self._planner.stride_limits(self.velocity, self.timing.duration))

    def _differs(self, wanted: Velocity) -> bool:
        """Whether a velocity differs from the wanted one; at rest any does."""
        if wanted == STILL:
            return self._slew.moving
        vx, vy, wz = self.velocity
        return (
            abs(vx - wanted[0]) > SAME_SPEED
            or abs(vy - wanted[1]) > SAME_SPEED
            or abs(wz - wanted[2]) > SAME_SPEED
        )

    def _follow_velocity(self, command: VelocityCommand, speed_ratio: float) -> None:
        self._state = None
        bound, wanted = self._bound, command
        if speed_ratio < 1.0 and command.velocity != STILL:
            vx, vy, wz = limited(command, self._limits)
            wanted = VelocityCommand(speed_ratio * vx, speed_ratio * vy, speed_ratio * wz)
            bound.append(Limit.BALANCE)
        if self._selective and command.velocity == STILL:
            self._slew.start(STILL)
        limit = self._slew.follow(wanted)
        bound.extend(speed_limits(command, self._limits))
        velocity = self.velocity
        self.timing = self._planner.cadence(velocity)
        if self._differs(limit):
            bound.append(Limit.ACCELERATION)
        bound.extend(self._planner.stride_limits(velocity, self.timing.duration))

    def _follow_state(self, command: CommandState) -> None:
        self._state = command
        self.timing, late = self._planner.timing(command)
        strides, altered = self._planner.explicit(command, 0.0)
        self._bound.extend(altered)
        self._bound.extend(late)
        time = self.timing.duration
        # A later velocity command starts from this velocity.
        start = self._planner.command_state(strides, self.timing)
        self._slew.start((start.forward / time, 0.0, start.direction / time))
