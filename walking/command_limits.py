"""Commanded and applied velocity or footstep, and the limits that bound."""

from enum import StrEnum

from walking.command import Command
from walking.value import comparable_value


class Limit(StrEnum):
    """Constraint that limits a command."""

    SPEED = "speed"
    COMBINED_SPEED = "combined speed"
    ACCELERATION = "acceleration"
    STEP_LENGTH = "step length"
    STEP_SIDE = "step side"
    STEP_TURN = "step turn"
    CLEARANCE = "clearance"
    REACH = "reach"
    TIMING = "timing"
    SWING_HEIGHT = "swing height"
    SETTLING = "settling"
    BALANCE = "balance"
    LANDING_FROZEN = "landing frozen"
    ZMP_REGION = "zmp region"
    LANDING_SPEED = "landing speed"
    FALLEN = "fallen"


(
    SPEED,
    COMBINED_SPEED,
    ACCELERATION,
    STEP_LENGTH,
    STEP_SIDE,
    STEP_TURN,
    CLEARANCE,
    REACH,
    TIMING,
    SWING_HEIGHT,
    SETTLING,
    BALANCE,
    LANDING_FROZEN,
    ZMP_REGION,
    LANDING_SPEED,
    FALLEN,
) = (1 << number for number in range(len(Limit)))
STRIDE_LIMITS = STEP_LENGTH | STEP_SIDE | STEP_TURN | CLEARANCE
_BITS = tuple((1 << number, limit) for number, limit in enumerate(Limit))


def limits_of(bits: int) -> tuple[Limit, ...]:
    """Return the constraints whose bits are set; compiled functions count them as bits."""
    return tuple([limit for bit, limit in _BITS if bits & bit]) if bits else ()


@comparable_value
class CommandLimits:
    """Report of how one tick's command is limited.

    Attributes:
        commanded: the command.
        applied: command that the next footsteps follow; a velocity for a command state, or the
            reverse, only while switching is blocked.
        limits: constraints that bind in this tick, including those on the present footstep. Empty
            when the command is followed: exactly in control ticks, and within the tolerance of
            `walking.footsteps.is_same` in the present landing.
    """

    commanded: Command
    applied: Command
    limits: tuple[Limit, ...]

    @property
    def limited(self) -> bool:
        """Whether any constraint binds."""
        return bool(self.limits)
