"""References of both feet in the plan frame: minimum-jerk swing, rest on the floor.

Flash & Hogan, J. Neurosci. 1985: the quintic from the present position, velocity and acceleration
to a landing at rest, replanned in every tick.
"""

from math import ceil
from typing import NamedTuple

from compilation import compiled
from walking.data import FootReference
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold, towards
from walking.plane import Vector, norm, within

PEAK = 1.875  # peak speed over mean speed of a minimum-jerk motion from rest to rest [1]
ROUNDING = 1e-7  # rounding error, relative to the maximum change [1]


@compiled
def minimum_jerk(time: float) -> float:
    """Return the fraction of the distance at a fraction of the time [1]."""
    s = within(time, 0.0, 1.0)
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@compiled
def rest_at(foot: FootReference, foothold: Foothold) -> None:
    """Set a foot reference to rest at a foothold, at its present height."""
    foot.x, foot.y, foot.yaw = foothold.x, foothold.y, foothold.yaw
    rate, acceleration = foot.rate, foot.acceleration
    rate.x = rate.y = rate.yaw = 0.0
    acceleration.x = acceleration.y = acceleration.yaw = 0.0
    foot.climb = foot.bend = 0.0


class Lift(NamedTuple):
    """Height of the swing foot relative to mid-swing, and its derivatives by the phase.

    Attributes:
        height, rate, acceleration: 64 s³ (1 - s)³ and its derivatives [1].
    """

    height: float
    rate: float
    acceleration: float


@compiled
def lift_profile(phase: float) -> Lift:
    """Return the lift at a phase of the swing, at rest at both ends."""
    rest = 1.0 - phase
    bump = phase * rest
    return Lift(
        64.0 * bump * bump * bump,
        192.0 * bump * bump * (rest - phase),
        384.0 * bump * (rest * rest - 3.0 * bump + phase * phase),
    )


@compiled
def move_foot(foot: FootReference, landing: Foothold, ticks_left: int) -> None:
    """Move the swing foot along the floor by one tick.

    Args:
        foot: reference of the foot, changed.
        landing: foothold of the foot.
        ticks_left: control ticks until touchdown [1].
    """
    v, a = foot.rate, foot.acceleration
    foot.x, v.x, a.x = _towards(foot.x, v.x, a.x, landing.x, ticks_left)
    foot.y, v.y, a.y = _towards(foot.y, v.y, a.y, landing.y, ticks_left)
    foot.yaw, v.yaw, a.yaw = _towards(foot.yaw, v.yaw, a.yaw, landing.yaw, ticks_left)


@compiled
def lift_foot(
    foot: FootReference, lift: float, phase: float, change: float, ticks_left: int
) -> None:
    """Lift the swing foot by one tick.

    The deviation from the profile, as after a change of the timing in the air, goes to rest by
    touchdown with continuous rate and acceleration.

    Args:
        foot: reference of the foot, its height is changed.
        lift: height at mid-swing [m].
        phase: phase of the swing after this tick [1].
        change: its change in this tick [1].
        ticks_left: control ticks until touchdown [1].
    """
    rate = change / CONTROL_PERIOD
    now, then = lift_profile(phase - change), lift_profile(phase)
    height, climb, bend = _towards(
        foot.height - lift * now.height,
        foot.climb - lift * rate * now.rate,
        foot.bend - lift * rate * rate * now.acceleration,
        0.0,
        ticks_left,
    )
    foot.height = max(0.0, height + lift * then.height)
    foot.climb = climb + lift * rate * then.rate
    foot.bend = bend + lift * rate * rate * then.acceleration


@compiled
def _towards(
    now: float, rate: float, acceleration: float, target: float, ticks_left: int
) -> Vector:
    """Return a coordinate and its rates after a tick of the motion to a target at rest."""
    if ticks_left <= 1:
        return target, 0.0, 0.0
    time = ticks_left * CONTROL_PERIOD
    e = target - now
    v, a = rate * time, acceleration * time * time
    c3 = 10.0 * e - 6.0 * v - 1.5 * a
    c4 = -15.0 * e + 8.0 * v + 1.5 * a
    c5 = 6.0 * e - 3.0 * v - 0.5 * a
    s = 1.0 / ticks_left
    return (
        now + s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5)))),
        (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time,
        (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (time * time),
    )


@compiled
def min_swing_ticks(foot: FootReference, landing: Foothold, speed: float) -> int:
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
    dx, dy, turn = wanted.x - landing.x, wanted.y - landing.y, wanted.yaw - landing.yaw
    excess = max(abs(dx) / max_shift, abs(dy) / max_shift, abs(turn) / max_turn)
    if excess <= 1.0 + ROUNDING:
        return wanted
    return towards(landing, wanted, 1.0 / excess)
