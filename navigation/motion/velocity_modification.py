"""Velocity modification: another speed on the same line, Yoo & Kim, section III-2."""

from math import inf

from compilation.value import value
from navigation.decision import Situation, SpeedLimits
from navigation.motion.collision_band import Encounter, free_intervals
from navigation.parameters.motion import MovingObstacleParameters

_TOUCH = 1e-9


@value
class ModifiedSpeed:
    """Result of velocity modification.

    Attributes:
        speed: new speed [m/s].
        situation: outcome.
    """

    speed: float
    situation: Situation


def needed_acceleration(speed: float, wanted: float, contact_time: float, footstep: float) -> float:
    """Return a_i = 2 (|p_oc| - |v_r| t_c)/t_c² of sec. III-2, with |p_oc| = v_c t_c [m/s²].

    Args:
        speed: |v_r| now [m/s].
        wanted: v_c, the speed that just touches [m/s].
        contact_time: t_c [s].
        footstep: minimum duration of a change of speed [s].
    """
    return 2.0 * (wanted - speed) / max(contact_time, footstep)


def modify_speed(
    encounters: tuple[Encounter, ...],
    desired: float,
    now: float,
    limits: SpeedLimits,
    parameters: MovingObstacleParameters,
) -> ModifiedSpeed:
    """Choose a free speed by the roots of the quadratic (Yoo & Kim, sec. III-2).

    Keep the desired speed if it is free; else the lowest free speed above that can be
    reached in time; else the highest free speed below, zero included; else the path changes.

    Args:
        encounters: the movers, in axes of the line of motion.
        desired: speed [m/s].
        now: present speed [m/s].
        limits: speed limits of the robot.
        parameters: horizon, and whether to brake inside the band.
    """
    horizon = parameters.horizon
    if not any(e.collides(desired, horizon) for e in encounters):
        return ModifiedSpeed(desired, "free")
    intervals = free_intervals(encounters, limits.vx, horizon)
    standing_collides = any(e.collides(0.0, horizon) for e in encounters)
    above = [low for low, _ in intervals if low > desired]
    if above:
        time = min((e.touch_time(above[0]) for e in encounters), default=inf)
        if needed_acceleration(now, above[0], time, limits.footstep) <= limits.acceleration:
            situation: Situation = "escape" if standing_collides else "accelerate"
            return ModifiedSpeed(min(limits.vx, above[0] + _TOUCH), situation)
    below = [high for _, high in intervals if high < desired]
    if below and _may_brake(encounters, desired, parameters):
        return ModifiedSpeed(max(0.0, below[-1] - _TOUCH), "brake")
    return ModifiedSpeed(desired, "path_change")


def sample_speed(
    encounters: tuple[Encounter, ...],
    desired: float,
    now: float,
    limits: SpeedLimits,
    parameters: MovingObstacleParameters,
) -> ModifiedSpeed:
    """Choose as `modify_speed` among sampled speeds.

    A higher speed is reachable if the robot gains it within the acceleration time.
    """
    p = parameters

    def free(speed: float) -> bool:
        return not any(e.collides(speed, p.horizon) for e in encounters)

    if free(desired):
        return ModifiedSpeed(desired, "free")
    speeds = [limits.vx * k / (p.samples - 1) for k in range(p.samples)]
    gain = limits.acceleration * p.acceleration_time
    for speed in speeds:
        if speed > desired and speed - now <= gain and free(speed):
            return ModifiedSpeed(speed, "accelerate" if free(0.0) else "escape")
    if _may_brake(encounters, desired, p):
        for speed in reversed(speeds):
            if speed < desired and free(speed):
                return ModifiedSpeed(speed, "brake")
    return ModifiedSpeed(desired, "path_change")


def _may_brake(
    encounters: tuple[Encounter, ...], desired: float, parameters: MovingObstacleParameters
) -> bool:
    return parameters.wait_in_band or not trapped(encounters, desired, parameters.horizon)


def trapped(encounters: tuple[Encounter, ...], desired: float, horizon: float) -> bool:
    """Whether the robot is in the band of a mover that `desired` [m/s] meets within `horizon` [s].

    Inside the collision band the only escape is ahead. A lower speed seems free there if it
    delays the collision beyond the horizon.
    """
    return any(e.in_band() and e.collides(desired, horizon) for e in encounters)
