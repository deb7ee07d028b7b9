"""Strides of a velocity, compiled; see `FootstepPlanner`."""

from math import cos, sin

from compilation import compiled
from walking.arrays import Point, Vector
from walking.footsteps.stride import Placement

Build = tuple[float, float, float, float, float]
"""Half the distance between the feet, their clearance; heel and toe ahead of the ankle, half of the
width of a sole [m]."""


@compiled
def strides(
    velocity: Vector, time: float, limits: Vector, build: Build
) -> tuple[Placement, Placement, bool]:
    """Return the strides of a velocity.

    Args:
        velocity: of the middle of the stance (vx, vy, wz) [m/s, m/s, rad/s].
        time: duration of a footstep [s].
        limits: maximum footstep forward and to the side [m], and turn [rad].
        build: of the feet.

    Returns:
        landing of the right and left foot, and whether one is shifted to clear the other foot.
    """
    vx, vy, wz = velocity
    half, gap, heel, toe, width = build
    dx = min(limits[0], max(-limits[0], vx * time))
    right_x, right_y, right_turn = _opened(dx, vy, wz, time, -1.0, limits, half)
    left_x, left_y, left_turn = _opened(dx, vy, wz, time, 1.0, limits, half)
    right = clear(right_y, right_turn, -1.0, gap, (heel, toe, width))
    left = clear(left_y, left_turn, 1.0, gap, (heel, toe, width))
    return (
        (right_x, right, right_turn),
        (left_x, left, left_turn),
        right != right_y or left != left_y,
    )


@compiled
def stance_after(dx: float, dy: float, turned: float, stance: float) -> Point:
    """Return the landing for a middle of the stance that moves along the chord of the arc.

    Args:
        dx: of the middle, forward [m].
        dy: of the middle, to the left [m].
        turned: change of yaw [rad].
        stance: lateral distance of the foot from the middle after the turn [m].

    Returns:
        x, y in the frame of the support foot [m].
    """
    ch, sh = cos(0.5 * turned), sin(0.5 * turned)
    return (
        ch * dx - sh * dy - stance * sin(turned),
        stance + sh * dx + ch * dy + stance * cos(turned),
    )


@compiled
def clear(y: float, turned: float, side: float, gap: float, sole: Vector) -> float:
    """Return the lateral landing with every corner clear of the strip of the support foot.

    Args:
        y: wanted [m].
        turned: yaw of the landing [rad].
        side: of the swing foot, left 1, right -1.
        gap: clearance [m].
        sole: heel and toe ahead of the ankle, half of the width [m].
    """
    heel, toe, width = sole
    s = side * sin(turned)
    inner = min(s * heel, s * toe) - width * cos(turned)
    min_distance = width + gap - inner
    return side * max(side * y, min_distance)


@compiled
def _opened(
    dx: float, vy: float, wz: float, time: float, side: float, limits: Vector, half: float
) -> Placement:
    """Return the landing on a side; it opens the stance if the motion is to that side."""
    dy = 2.0 * vy * time if vy * side > 0.0 else 0.0
    dy = min(limits[1], max(-limits[1], dy))
    turned = 2.0 * wz * time if wz * side > 0.0 else 0.0
    turned = min(limits[2], max(-limits[2], turned))
    x, y = stance_after(dx, dy, turned, side * half)
    return x, y, turned
