"""What the legs make of a velocity command: limits and slew."""

from math import sqrt

from walking.clamp import clamp
from walking.command import VelocityCommand
from walking.command_limits import Limit
from walking.footsteps.stride import STILL, Velocity
from walking.parameters import CONTROL_PERIOD, LimitParameters


def limited(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """The command with every component within its limit and all together in an ellipsoid.

    Returns:
        (vx, vy, wz) [m/s, m/s, rad/s]; the direction of the command is kept when the ellipsoid
        binds.
    """
    vx, vy, wz = _within(command, limits)
    max_vx = limits.vx if vx >= 0.0 else limits.vx_backward
    norm = sqrt((vx / max_vx) ** 2 + (vy / limits.vy) ** 2 + (wz / limits.wz) ** 2)
    if norm > limits.combined:
        scale = limits.combined / norm
        return vx * scale, vy * scale, wz * scale
    return vx, vy, wz


def speed_limits(command: VelocityCommand, limits: LimitParameters) -> list[Limit]:
    """Which of the limits alter a command."""
    within, bound = _within(command, limits), []
    if within != command.velocity:
        bound.append(Limit.SPEED)
    if limited(command, limits) != within:
        bound.append(Limit.COMBINED_SPEED)
    return bound


def _within(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """The command with every component within its limit."""
    return (
        min(limits.vx, max(-limits.vx_backward, command.vx)),
        clamp(command.vy, limits.vy),
        clamp(command.wz, limits.wz),
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
        velocity: given to the footsteps (vx, vy, wz) [m/s, m/s, rad/s].
        moving: whether any component differs from zero.
    """

    def __init__(self, limits: LimitParameters) -> None:
        self._limits = limits
        tick, braking = CONTROL_PERIOD, CONTROL_PERIOD / limits.braking_time
        self._vx = _Axis(limits.forward_acceleration * tick, braking)
        self._vy = _Axis(limits.lateral_acceleration * tick, braking)
        self._wz = _Axis(limits.turn_acceleration * tick, braking)
        self._command: VelocityCommand | None = None
        self._wanted: Velocity = STILL
        self.start(STILL)

    def start(self, velocity: Velocity) -> None:
        """Have a velocity at once (vx, vy, wz) [m/s, m/s, rad/s]."""
        self.velocity, self.moving = velocity, velocity != STILL

    def follow(self, command: VelocityCommand) -> Velocity:
        """Approach the limited command by one tick's acceleration.

        Returns:
            the limited command [m/s, m/s, rad/s].
        """
        if command is not self._command:
            self._command, self._wanted = command, limited(command, self._limits)
        (vx, vy, wz), wanted = self.velocity, self._wanted
        self.start(
            (
                self._vx.towards(vx, wanted[0]),
                self._vy.towards(vy, wanted[1]),
                self._wz.towards(wz, wanted[2]),
            )
        )
        return wanted
