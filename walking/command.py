"""What walking is asked to do: a body velocity and a direction to look."""

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


@dataclass(frozen=True, slots=True)
class HeadTarget:
    """Desired head angles.

    Attributes:
        pan: left positive [rad].
        tilt: up positive [rad].
    """

    pan: float = 0.0
    tilt: float = 0.0
