"""What the legs make of a velocity command: limits and slew."""

from math import sqrt

from walking.admission import Limit
from walking.command import VelocityCommand
from walking.parameters import CONTROL_PERIOD, LimitParameters


def limited(command: VelocityCommand, limits: LimitParameters) -> tuple[float, float, float]:
    """The command with every component within its limit and all together in an ellipsoid.

    Returns:
        forward [m/s], left [m/s], turn [rad/s]; the direction of the command is kept when
        the ellipsoid binds.
    """
    forward = min(limits.forward, max(-limits.backward, command.forward))
    left = min(limits.lateral, max(-limits.lateral, command.left))
    turn = min(limits.turn, max(-limits.turn, command.turn))
    longest = limits.forward if forward >= 0.0 else limits.backward
    norm = sqrt((forward / longest) ** 2 + (left / limits.lateral) ** 2 + (turn / limits.turn) ** 2)
    if norm > limits.combined:
        scale = limits.combined / norm
        return forward * scale, left * scale, turn * scale
    return forward, left, turn


def speed_limits(command: VelocityCommand, limits: LimitParameters) -> list[Limit]:
    """Which of the limits alter a command."""
    forward = min(limits.forward, max(-limits.backward, command.forward))
    left = min(limits.lateral, max(-limits.lateral, command.left))
    turn = min(limits.turn, max(-limits.turn, command.turn))
    bound = []
    if (forward, left, turn) != (command.forward, command.left, command.turn):
        bound.append(Limit.SPEED)
    if limited(command, limits) != (forward, left, turn):
        bound.append(Limit.COMBINED_SPEED)
    return bound


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
        forward, left, turn: velocity given to the footsteps [m/s, m/s, rad/s].
    """

    def __init__(self, limits: LimitParameters) -> None:
        self._limits = limits
        tick, braking = CONTROL_PERIOD, CONTROL_PERIOD / limits.braking_time
        self._forward = _Axis(limits.forward_acceleration * tick, braking)
        self._left = _Axis(limits.lateral_acceleration * tick, braking)
        self._turn = _Axis(limits.turn_acceleration * tick, braking)
        self.forward = self.left = self.turn = 0.0

    @property
    def moving(self) -> bool:
        """Whether any component differs from zero."""
        return self.forward != 0.0 or self.left != 0.0 or self.turn != 0.0

    def start(self, forward: float, left: float, turn: float) -> None:
        """Have a velocity at once [m/s, m/s, rad/s]."""
        self.forward, self.left, self.turn = forward, left, turn

    def follow(self, command: VelocityCommand) -> tuple[float, float, float]:
        """Approach the limited command by one tick's acceleration.

        Returns:
            the limited command [m/s, m/s, rad/s].
        """
        forward, left, turn = limited(command, self._limits)
        self.forward = self._forward.towards(self.forward, forward)
        self.left = self._left.towards(self.left, left)
        self.turn = self._turn.towards(self.turn, turn)
        return forward, left, turn
