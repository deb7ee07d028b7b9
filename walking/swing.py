"""References of both feet in the plan frame: minimum-jerk swing, rest on the floor.

Flash & Hogan, J. Neurosci. 1985: the quintic from the present position, velocity and acceleration
to a landing at rest, replanned in every tick.
"""

from math import ceil

from compilation import compiled
from compilation.record import record_type
from walking.footsteps import Foothold, towards
from walking.parameters import CONTROL_PERIOD
from walking.plane import norm
from walking.records import Record

REFERENCE = record_type(
    x=float, y=float, yaw=float, height=float, rate=(float, 3), acceleration=(float, 3)
)
"""Reference of a foot in the plan frame: position [m], yaw [rad], height above the floor [m]; rates
and accelerations of x, y and yaw."""

PEAK = 1.875  # peak speed over mean speed of a minimum-jerk motion from rest to rest [1]
ROUNDING = 1e-7  # rounding error, relative to the maximum change [1]


@compiled
def minimum_jerk(time: float) -> float:
    """Return the fraction of the distance at a fraction of the time [1]."""
    s = min(1.0, max(0.0, time))
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@compiled
def rest_at(foot: Record, foothold: Foothold) -> None:
    """Set a foot reference to rest at a foothold, at its present height."""
    foot.x, foot.y, foot.yaw = foothold.x, foothold.y, foothold.yaw
    for axis in range(3):
        foot.rate[axis] = foot.acceleration[axis] = 0.0


@compiled
def lift_profile(phase: float) -> float:
    """Return the height of the swing foot relative to mid-swing, at rest at both ends [1]."""
    bump = 4.0 * phase * (1.0 - phase)
    return bump * bump * bump


@compiled
def move_foot(foot: Record, landing: Foothold, ticks_left: int, height: float) -> None:
    """Move the swing foot by one tick.

    Args:
        foot: reference of the foot, changed.
        landing: foothold of the foot.
        ticks_left: control ticks until touchdown [1].
        height: height of the foot after this tick [m].
    """
    foot.x = _towards(foot, 0, foot.x, landing.x, ticks_left)
    foot.y = _towards(foot, 1, foot.y, landing.y, ticks_left)
    foot.yaw = _towards(foot, 2, foot.yaw, landing.yaw, ticks_left)
    foot.height = height


@compiled
def _towards(foot: Record, axis: int, now: float, target: float, ticks_left: int) -> float:
    """Return a coordinate after a tick of the motion to a target at rest; change its rates."""
    if ticks_left <= 1:
        foot.rate[axis] = foot.acceleration[axis] = 0.0
        return target
    time = ticks_left * CONTROL_PERIOD
    e = target - now
    v, a = foot.rate[axis] * time, foot.acceleration[axis] * time * time
    c3 = 10.0 * e - 6.0 * v - 1.5 * a
    c4 = -15.0 * e + 8.0 * v + 1.5 * a
    c5 = 6.0 * e - 3.0 * v - 0.5 * a
    s = 1.0 / ticks_left
    foot.rate[axis] = (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time
    foot.acceleration[axis] = (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (time * time)
    moved_by: float = s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5))))
    return now + moved_by


@compiled
def min_swing_ticks(foot: Record, landing: Foothold, speed: float) -> int:
    """Return the control ticks of a swing to `landing` with a peak speed [m/s]."""
    distance = norm(landing.x - foot.x, landing.y - foot.y)
    return ceil(PEAK * distance / (speed * CONTROL_PERIOD))


@compiled
def moved(landing: Foothold, wanted: Foothold, max_shift: float, max_turn: float) -> Foothold:
    """Move a landing towards another one by a limited change.

    Position and yaw change together, so that the foot stays clear of the other one.

    Args:
        landing: present landing.
        wanted: goal.
        max_shift: maximum shift along x and along y [m].
        max_turn: maximum change of the yaw [rad].
    """
    dx, dy, turned = wanted.x - landing.x, wanted.y - landing.y, wanted.yaw - landing.yaw
    excess = max(abs(dx) / max_shift, abs(dy) / max_shift, abs(turned) / max_turn)
    if excess <= 1.0 + ROUNDING:
        return wanted
    return towards(landing, wanted, 1.0 / excess)
