"""Speed and acceleration limits of velocity commands."""

from math import sqrt

from walking.clamp import clamp
from walking.command import VelocityCommand
from walking.command_limits import Limit
from walking.footsteps.stride import STILL, Velocity
from walking.parameters import CONTROL_PERIOD, LimitParameters


def limited(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """Clip a command to the limits of each component and to the ellipsoid of all.

    Returns:
        (vx, vy, wz) [m/s, m/s, rad/s]; the direction of the command is kept when the ellipsoid
        binds.
    """
    vx, vy, wz = _within(command, limits)
    max_vx = limits.vx if vx >= 0.0 else limits.vx_backward
    x, y, turned = vx / max_vx, vy / limits.vy, wz / limits.wz
    norm = sqrt(x * x + y * y + turned * turned)
    if norm > limits.combined:
        scale = limits.combined / norm
        return vx * scale, vy * scale, wz * scale
    return vx, vy, wz


def speed_limits(command: VelocityCommand, limits: LimitParameters) -> list[Limit]:
    """Return the speed limits that bind on a command."""
    within, bound = _within(command, limits), []
    if within != command.velocity:
        bound.append(Limit.SPEED)
    if limited(command, limits) != within:
        bound.append(Limit.COMBINED_SPEED)
    return bound


def _within(command: VelocityCommand, limits: LimitParameters) -> Velocity:
    """Clip every component to its limit."""
    return (
        min(limits.vx, max(-limits.vx_backward, command.vx)),
        clamp(command.vy, limits.vy),
        clamp(command.wz, limits.wz),
    )


class _Axis:
    """Rate limiter of one component.

    Args:
        acceleration: maximum change per tick.
        braking: maximum decrease per tick, as a fraction of the last peak speed [1].
    """

    __slots__ = ("_acceleration", "_braking", "_peak")

    def __init__(self, acceleration: float, braking: float) -> None:
        self._acceleration, self._braking = acceleration, braking
        self._peak = 0.0

    def towards(self, now: float, wanted: float) -> float:
        """Return the component a tick later."""
        change = wanted - now
        if now * change >= 0.0:
            self._peak = abs(now)
            return now + min(self._acceleration, max(-self._acceleration, change))
        self._peak = max(self._peak, abs(now))
        step = max(self._acceleration, self._braking * self._peak)
        if abs(now) < min(step, abs(change)):
            return 0.0  # a reversal passes through rest
        return now + min(step, max(-step, change))


class VelocitySlew:
    """Rate limiter of velocity commands.

    Args:
        limits: speed and acceleration limits.

    Attributes:
        velocity: output (vx, vy, wz) [m/s, m/s, rad/s].
        moving: whether it is not zero.
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
        """Jump to a velocity (vx, vy, wz) [m/s, m/s, rad/s]."""
        self.velocity, self.moving = velocity, velocity != STILL

    def follow(self, command: VelocityCommand) -> Velocity:
        """Approach a command by one tick; return the command within the speed limits."""
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
