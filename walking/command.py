"""Commands to walking: a body velocity or footsteps, a gaze direction, and how they are limited."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from compilation.value import comparable_value
from walking import dimension


@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """Desired velocity of the robot frame R, expressed in R.

    Attributes:
        vx: velocity forward [m/s].
        vy: velocity to the left [m/s].
        wz: yaw rate, counter-clockwise positive [rad/s].
    """

    vx: Annotated[float, dimension.SPEED] = 0.0
    vy: Annotated[float, dimension.SPEED] = 0.0
    wz: Annotated[float, dimension.RATE] = 0.0

    @property
    def velocity(self) -> tuple[float, float, float]:
        """(vx, vy, wz) [m/s, m/s, rad/s]."""
        return self.vx, self.vy, self.wz


@dataclass(frozen=True, slots=True)
class CommandState:
    """Explicit footstep, repeated until the next command.

    The command state of the modifiable walking pattern (Lee et al., IEEE T-RO 2008). Under a
    command state the robot steps; a zero velocity command closes the stance and stops it. The
    defaults step in place with HSR-VIII's timing; `walking.dimension.scale_parameters` scales them
    to another robot.

    Attributes:
        single_support: duration of single support [s].
        double_support: duration of the double support before it [s].
        forward: advance of the stance's middle per footstep [m].
        side: distance between the feet at touchdown, for either foot [m].
        direction: yaw of the landing foot in the frame of the support foot [rad].
        swing_height: height of the swing foot at mid-swing [m].
    """

    single_support: Annotated[float, dimension.TIME] = 0.27
    double_support: Annotated[float, dimension.TIME] = 0.07
    forward: Annotated[float, dimension.LENGTH] = 0.0
    side: Annotated[float, dimension.STANCE] = 0.084
    direction: Annotated[float, dimension.NUMBER] = 0.0
    swing_height: Annotated[float, dimension.LENGTH] = 0.025

    @property
    def velocity(self) -> tuple[float, float, float]:
        """Mean velocity of the stance (vx, vy, wz) [m/s, m/s, rad/s]."""
        time = self.single_support + self.double_support
        return self.forward / time, 0.0, self.direction / time


Command = VelocityCommand | CommandState


@dataclass(frozen=True, slots=True)
class HeadTarget:
    """Desired head angles.

    Attributes:
        pan: left positive [rad].
        tilt: up positive [rad].
    """

    pan: float = 0.0
    tilt: float = 0.0


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
            `walking.plan.footsteps.is_close` in the present landing.
    """

    commanded: Command
    applied: Command
    limits: tuple[Limit, ...]

    @property
    def limited(self) -> bool:
        """Whether any constraint binds."""
        return bool(self.limits)
