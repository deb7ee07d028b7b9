"""Commands to walking: a body velocity or footsteps, and a gaze direction."""

from dataclasses import dataclass
from typing import Annotated

from walking.dimension import LENGTH, NUMBER, RATE, SPEED, STANCE, TIME


@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """Desired velocity of the robot frame R, expressed in R.

    Attributes:
        vx: forward [m/s].
        vy: to the left [m/s].
        wz: yaw rate, counter-clockwise positive [rad/s].
    """

    vx: Annotated[float, SPEED] = 0.0
    vy: Annotated[float, SPEED] = 0.0
    wz: Annotated[float, RATE] = 0.0

    @property
    def velocity(self) -> tuple[float, float, float]:
        """(vx, vy, wz) [m/s, m/s, rad/s]."""
        return self.vx, self.vy, self.wz


@dataclass(frozen=True, slots=True)
class CommandState:
    """Explicit footstep, repeated until the next command.

    The command state of the modifiable walking pattern (Lee et al., IEEE T-RO 2008). Under a
    command state the robot steps; a zero velocity command closes the stance and stops it. The
    defaults step in place with HSR-VIII's timing; `walking.scaling.scale_parameters` scales them to
    another robot.

    Attributes:
        single_support: duration of single support [s].
        double_support: duration of the double support before it [s].
        forward: advance of the stance's middle per footstep [m].
        side: distance between the feet at touchdown, for either foot [m].
        direction: yaw of the landing foot in the frame of the support foot [rad].
        swing_height: of the swing foot at mid-swing [m].
    """

    single_support: Annotated[float, TIME] = 0.27
    double_support: Annotated[float, TIME] = 0.07
    forward: Annotated[float, LENGTH] = 0.0
    side: Annotated[float, STANCE] = 0.084
    direction: Annotated[float, NUMBER] = 0.0
    swing_height: Annotated[float, LENGTH] = 0.025

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
