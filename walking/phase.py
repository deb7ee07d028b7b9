"""Phases of the gait."""

from enum import StrEnum


class Phase(StrEnum):
    """Support phase, or getting up or fallen after a fall."""

    STANDING = "standing"
    DOUBLE_SUPPORT = "double"
    LEFT_SUPPORT = "left"
    RIGHT_SUPPORT = "right"
    GETTING_UP = "up"
    FALLEN = "fallen"

    @property
    def down(self) -> bool:
        """Whether the robot is off its feet: odometry and camera pose are invalid."""
        return self in (Phase.GETTING_UP, Phase.FALLEN)
