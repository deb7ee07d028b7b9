"""Foothold."""

from typing import NamedTuple

from compilation import compiled
from walking.plane import Frame, from_frame
from walking.records import Record


class Foothold(NamedTuple):
    """Pose of a foot on the floor, in the plan frame; in a `WalkingState`, in the odometry frame.

    Attributes:
        left: whether it is the left foot.
        x, y: position of the foot frame on the floor [m].
        yaw: yaw of the foot [rad].
    """

    left: bool
    x: float
    y: float
    yaw: float

    @property
    def frame(self) -> Frame:
        """Foot frame in the plan frame."""
        return self.x, self.y, self.yaw


@compiled
def foothold(record: Record) -> Foothold:
    """Return the value of a record `FOOTHOLD`."""
    return Foothold(record.left, record.x, record.y, record.yaw)


@compiled
def put(record: Record, foot: Foothold) -> None:
    """Set a record `FOOTHOLD`."""
    record.left, record.x, record.y, record.yaw = foot.left, foot.x, foot.y, foot.yaw


@compiled
def towards(one: Foothold, other: Foothold, fraction: float) -> Foothold:
    """Interpolate linearly to another foothold of the same foot."""
    return Foothold(
        other.left,
        one.x + fraction * (other.x - one.x),
        one.y + fraction * (other.y - one.y),
        one.yaw + fraction * (other.yaw - one.yaw),
    )


@compiled
def placed(support: Foothold, x: float, y: float, turned: float) -> Foothold:
    """Return the other foot at x, y [m] and yaw [rad] in the frame of the support foot."""
    px, py = from_frame((support.x, support.y, support.yaw), x, y)
    return Foothold(not support.left, px, py, support.yaw + turned)


@compiled
def equal(one: Foothold, other: Foothold) -> bool:
    """Whether two footholds are the same number by number."""
    return one.left == other.left and one.x == other.x and one.y == other.y and one.yaw == other.yaw
