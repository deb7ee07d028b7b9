"""Velocity modification: another speed on the same line, Yoo & Kim, section III-2."""

from math import inf

from navigation.decision import Situation
from navigation.motion.collision_band import Encounter, free_intervals
from navigation.value import value

_TOUCH = 1e-9


@value
class ModifiedSpeed:
    """Result of velocity modification.

    Attributes:
        speed: to walk with [m/s].
        situation: what was found.
    """

    speed: float
    situation: Situation


def needed_acceleration(speed: float, wanted: float, contact_time: float, footstep: float) -> float:
    """a_i = 2 (|p_oc| - |v_r| t_c)/t_c² of sec. III-2, with |p_oc| = v_c t_c [m/s²].

    Args:
        speed: |v_r| now [m/s].
        wanted: v_c, the speed that just touches [m/s].
        contact_time: t_c [s].
        footstep: the least time a speed can change in [s].
    """
    return 2.0 * (wanted - speed) / max(contact_time, footstep)


def modify_speed(
    encounters: tuple[Encounter, ...],
    desired: float,
    now: float,
    *,
    v_max: float,
    acceleration: float,
    footstep: float,
    horizon: float,
    wait_in_band: bool,
) -> ModifiedSpeed:
    """Choose a free speed by the roots of the quadratic (Yoo & Kim, sec. III-2).

    Keep the desired speed if it is free; else the lowest free speed above that can be
    reached in time; else the highest free speed below, standing included; else give up
    and let the path change.

    Args:
        encounters: the movers, in axes of the line of motion.
        desired: speed asked for [m/s].
        now: present speed [m/s].
        v_max: largest speed [m/s].
        acceleration: largest [m/s²].
        footstep: duration of a footstep [s].
        horizon: later contacts are ignored [s].
        wait_in_band: whether a robot that is in a mover's way may also brake.
    """
    if not any(e.collides(desired, horizon) for e in encounters):
        return ModifiedSpeed(desired, "free")
    intervals = free_intervals(encounters, v_max, horizon)
    standing_hits = any(e.collides(0.0, horizon) for e in encounters)
    above = [low for low, _ in intervals if low > desired]
    if above:
        time = min((e.touch_time(above[0]) for e in encounters), default=inf)
        if needed_acceleration(now, above[0], time, footstep) <= acceleration:
            situation: Situation = "escape" if standing_hits else "accelerate"
            return ModifiedSpeed(min(v_max, above[0] + _TOUCH), situation)
    below = [high for _, high in intervals if high < desired]
    if below and (wait_in_band or not trapped(encounters, desired, horizon)):
        return ModifiedSpeed(max(0.0, below[-1] - _TOUCH), "brake")
    return ModifiedSpeed(desired, "path_change")


def trapped(encounters: tuple[Encounter, ...], desired: float, horizon: float) -> bool:
    """Whether the robot is in the way of a mover that `desired` [m/s] meets within `horizon` [s].

    Inside the collision band the only way out is ahead. A lower speed seems free there when
    it puts the contact off beyond the horizon.
    """
    return any(e.in_band() and e.collides(desired, horizon) for e in encounters)


def sample_speed(
    encounters: tuple[Encounter, ...],
    desired: float,
    now: float,
    *,
    v_max: float,
    acceleration: float,
    samples: int,
    horizon: float,
    acceleration_time: float,
    wait_in_band: bool,
) -> ModifiedSpeed:
    """The same choice among `samples` speeds from 0 to v_max.

    A higher speed counts as reachable if it is gained within `acceleration_time` [s].
    The other arguments are those of `modify_speed`.
    """

    def free(speed: float) -> bool:
        return not any(e.collides(speed, horizon) for e in encounters)

    if free(desired):
        return ModifiedSpeed(desired, "free")
    speeds = [v_max * k / (samples - 1) for k in range(samples)]
    for speed in speeds:
        if speed > desired and speed - now <= acceleration * acceleration_time and free(speed):
            return ModifiedSpeed(speed, "accelerate" if free(0.0) else "escape")
    if wait_in_band or not trapped(encounters, desired, horizon):
        for speed in reversed(speeds):
            if speed < desired and free(speed):
                return ModifiedSpeed(speed, "brake")
    return ModifiedSpeed(desired, "path_change")
