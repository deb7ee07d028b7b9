"""References of both feet in the plan frame, compiled.

Rows of the left and right foot: x, y [m], yaw [rad], height above the floor [m]; rates and
accelerations of x, y and yaw (2, 10).
"""

from compilation import compiled
from walking.arrays import Array, Vector

HEIGHT, RATE, ACCELERATION, WIDTH = 3, 4, 7, 10  # columns, and their number


@compiled
def advance(
    feet: Array,
    decay: float,
    swing: int,
    landing: Vector,
    ticks_left: int,
    lift: tuple[float, float],
    period: float,
) -> None:
    """Move the feet by one tick.

    Args:
        feet: references, updated (2, 10).
        decay: per tick, of the height of a foot on the floor [1].
        swing: index of the swing foot, -1 for none.
        landing: of the swing foot, x, y [m], yaw [rad].
        ticks_left: until touchdown [1].
        lift: height at mid-swing [m], and phase of the swing after this tick [1].
        period: of control [s].
    """
    feet[0, HEIGHT] *= decay
    feet[1, HEIGHT] *= decay
    if swing < 0:
        return
    for axis in range(3):
        _towards(feet[swing], axis, landing[axis], ticks_left, period)
    feet[swing, HEIGHT] = lift[0] * lift_profile(lift[1])


@compiled
def lift_profile(phase: float) -> float:
    """Return the height of the swing foot relative to mid-swing, at rest at both ends [1]."""
    bump = 4.0 * phase * (1.0 - phase)
    return bump * bump * bump


@compiled
def _towards(foot: Array, axis: int, target: float, ticks_left: int, period: float) -> None:
    """Move one coordinate by a tick of the minimum-jerk motion to a target at rest.

    Flash & Hogan, J. Neurosci. 1985: the quintic from the present position, velocity and
    acceleration, replanned in every tick.
    """
    if ticks_left <= 1:
        foot[axis], foot[RATE + axis], foot[ACCELERATION + axis] = target, 0.0, 0.0
        return
    time = ticks_left * period
    e = target - foot[axis]
    v, a = foot[RATE + axis] * time, foot[ACCELERATION + axis] * time * time
    c3 = 10.0 * e - 6.0 * v - 1.5 * a
    c4 = -15.0 * e + 8.0 * v + 1.5 * a
    c5 = 6.0 * e - 3.0 * v - 0.5 * a
    s = 1.0 / ticks_left
    foot[axis] += s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5))))
    foot[RATE + axis] = (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time
    foot[ACCELERATION + axis] = (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (
        time * time
    )
