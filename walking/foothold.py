"""Foothold."""

from collections.abc import Sequence

from walking.planar import Frame
from walking.value import comparable_value


@comparable_value
class Foothold:
    """Pose of a foot on the floor, in the plan frame; in a `WalkingState`, in the odometry frame.

    Attributes:
        left: whether it is the left foot.
        x, y: position of the foot frame on the floor [m].
        yaw: of the foot [rad].
    """

    left: bool
    x: float
    y: float
    yaw: float

    def towards(self, other: "Foothold", fraction: float) -> "Foothold":
        """Interpolate linearly to another foothold of the same foot."""
        return Foothold(
            left=other.left,
            x=self.x + fraction * (other.x - self.x),
            y=self.y + fraction * (other.y - self.y),
            yaw=self.yaw + fraction * (other.yaw - self.yaw),
        )

    @property
    def frame(self) -> Frame:
        """Foot frame in the plan frame."""
        return self.x, self.y, self.yaw

    @property
    def row(self) -> tuple[float, float, float, float]:
        """Row for kernels: x, y, yaw, and 1 for a left foot, 0 for a right one."""
        return self.x, self.y, self.yaw, 1.0 if self.left else 0.0

    @staticmethod
    def from_row(row: Sequence[float]) -> "Foothold":
        """Return the foothold of a `row`."""
        x, y, yaw, left = row
        return Foothold(left > 0.0, x, y, yaw)
