"""Which feet carry the robot, or that none does."""

from enum import StrEnum


class Phase(StrEnum):
    """Phase of the gait, or of a fall: getting up, or given up."""

    STANDING = "standing"
    DOUBLE_SUPPORT = "double"
    LEFT_SUPPORT = "left"
    RIGHT_SUPPORT = "right"
    GETTING_UP = "up"
    FALLEN = "fallen"

    @property
    def down(self) -> bool:
        """Whether the robot is off its feet, so that neither odometry nor camera pose hold."""
        return self in (Phase.GETTING_UP, Phase.FALLEN)
