"""What the legs make of a velocity command: limits and slew."""

from math import sqrt

from walking.admission import Limit
from walking.clamp import clamp
from walking.command import VelocityCommand
from walking.footsteps.stride import STILL, Velocity
from walking.parameters import CONTROL_PERIOD, LimitParameters


def limited(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """The command with every component within its limit and all together in an ellipsoid.

    Returns:
        forward [m/s], left [m/s], turn [rad/s]; the direction of the command is kept when
        the ellipsoid binds.
    """
    forward, left, turn = _within(command, limits)
    longest = limits.forward if forward >= 0.0 else limits.backward
    norm = sqrt((forward / longest) ** 2 + (left / limits.lateral) ** 2 + (turn / limits.turn) ** 2)
    if norm > limits.combined:
        scale = limits.combined / norm
        return forward * scale, left * scale, turn * scale
    return forward, left, turn


def speed_limits(command: VelocityCommand, limits: LimitParameters) -> list[Limit]:
    """Which of the limits alter a command."""
    within, bound = _within(command, limits), []
    if within != (command.forward, command.left, command.turn):
        bound.append(Limit.SPEED)
    if limited(command, limits) != within:
        bound.append(Limit.COMBINED_SPEED)
    return bound


def _within(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """The command with every component within its limit."""
    return (
        min(limits.forward, max(-limits.backward, command.forward)),
        clamp(command.left, limits.lateral),
        clamp(command.turn, limits.turn),
    )


class _Axis:
    """Bounded change of one component: away from rest by so much a tick, to rest in a time.

    Args:
        speeding: largest change per tick.
        braking: share of the speed, when it last rose, that a tick may take away.
    """

    __slots__ = ("_braking", "_fastest", "_speeding")

    def __init__(self, speeding: float, braking: float) -> None:
        self._speeding, self._braking = speeding, braking
        self._fastest = 0.0

    def towards(self, now: float, wanted: float) -> float:
        """The component a tick later."""
        change = wanted - now
        if now * change >= 0.0:
            self._fastest = abs(now)
            return now + min(self._speeding, max(-self._speeding, change))
        self._fastest = max(self._fastest, abs(now))
        most = max(self._speeding, self._braking * self._fastest)
        if abs(now) < min(most, abs(change)):
            return 0.0  # a reversal passes through rest
        return now + min(most, max(-most, change))


class VelocitySlew:
    """Velocity that follows the command with bounded acceleration.

    Args:
        limits: speed and acceleration limits.

    Attributes:
        velocity: given to the footsteps (forward, left, turn) [m/s, m/s, rad/s].
        moving: whether any component differs from zero.
    """

    def __init__(self, limits: LimitParameters) -> None:
        self._limits = limits
        tick, braking = CONTROL_PERIOD, CONTROL_PERIOD / limits.braking_time
        self._forward = _Axis(limits.forward_acceleration * tick, braking)
        self._left = _Axis(limits.lateral_acceleration * tick, braking)
        self._turn = _Axis(limits.turn_acceleration * tick, braking)
        self._command: VelocityCommand | None = None
        self._wanted: Velocity = STILL
        self.start(STILL)

    def start(self, velocity: Velocity) -> None:
        """Have a velocity at once (forward, left, turn) [m/s, m/s, rad/s]."""
        self.velocity, self.moving = velocity, velocity != STILL

    def follow(self, command: VelocityCommand) -> Velocity:
        """Approach the limited command by one tick's acceleration.

        Returns:
            the limited command [m/s, m/s, rad/s].
        """
        if command is not self._command:
            self._command, self._wanted = command, limited(command, self._limits)
        (forward, left, turn), wanted = self.velocity, self._wanted
        self.start(
            (
                self._forward.towards(forward, wanted[0]),
                self._left.towards(left, wanted[1]),
                self._turn.towards(turn, wanted[2]),
            )
        )
        return wanted
