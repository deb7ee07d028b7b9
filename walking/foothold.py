"""A place on the floor for a foot."""

from collections.abc import Sequence

from walking.value import comparable_value


@comparable_value
class Foothold:
    """A foothold in the plan frame; in a `WalkingState`, in the odometry frame.

    Attributes:
        left: whether it is the left foot.
        x, y: position of the foot frame on the floor [m].
        yaw: direction of the foot [rad].
    """

    left: bool
    x: float
    y: float
    yaw: float

    @property
    def row(self) -> tuple[float, float, float, float]:
        """As compiled code has it: x, y, yaw, and 1 for a left foot, 0 for a right one."""
        return self.x, self.y, self.yaw, 1.0 if self.left else 0.0

    @staticmethod
    def from_row(row: Sequence[float]) -> "Foothold":
        """The foothold of a `row`."""
        x, y, yaw, left = row
        return Foothold(left > 0.0, x, y, yaw)
