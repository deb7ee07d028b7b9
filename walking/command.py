"""What walking is asked to do: a body velocity or footsteps, and a direction to look."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """Desired velocity of the robot frame R, expressed in R.

    Attributes:
        forward: along x [m/s].
        left: along y [m/s].
        turn: about z, counter-clockwise positive [rad/s].
    """

    forward: float = 0.0
    left: float = 0.0
    turn: float = 0.0

    @property
    def velocity(self) -> tuple[float, float, float]:
        """Forward [m/s], left [m/s], turn [rad/s]."""
        return self.forward, self.left, self.turn


@dataclass(frozen=True, slots=True)
class CommandState:
    """One footstep, given explicitly; it holds for every footstep until another comes.

    The command state of the modifiable walking pattern (Lee et al., IEEE T-RO 2008). A robot
    under a command state steps; a zero velocity command closes the stance and stops it.

    Attributes:
        single_support: time on one foot [s].
        double_support: time on both feet before that [s].
        forward: advance of the stance's middle per footstep [m].
        side: distance between the feet at landing; the same command serves both feet [m].
        direction: of the landing foot in the frame of the support foot [rad].
        swing_height: of the swing foot at mid-swing [m].
    """

    single_support: float = 0.27
    double_support: float = 0.07
    forward: float = 0.0
    side: float = 0.084
    direction: float = 0.0
    swing_height: float = 0.025

    @property
    def velocity(self) -> tuple[float, float, float]:
        """Mean velocity of the stance: forward [m/s], left [m/s], turn [rad/s]."""
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
