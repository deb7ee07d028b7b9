"""Linear inverted pendulum in closed form: x'' = ω² (x - p).

Kajita et al., IROS 2001; divergent component of motion ξ = x + x'/ω: Takenaka et al., IROS 2009.
"""

from math import cosh, exp, sinh, sqrt

from compilation import compiled
from compilation.record import Records
from walking.data import Data, Pendulum, Ramp
from walking.model import Model
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.plan.support import Region, clip
from walking.plane import Point, Vector


def natural_frequency(height: float) -> float:
    """Return ω = √(g / height) of a pendulum [1/s]."""
    return sqrt(GRAVITY / height)


@compiled
def plan_pendulum(walk: Data) -> Pendulum:
    """Return the pendulum of the plan: that of the body unless off plan."""
    return walk.planned if walk.off_plan else walk.pendulum


@compiled
def dcm(position: float, velocity: float, robot: Model) -> float:
    """Return the divergent component of motion of an axis [m]."""
    return position + velocity / robot.omega


@compiled
def dcm_of(pendulum: Pendulum, robot: Model) -> Point:
    """Return the divergent component of motion [m]."""
    return dcm(pendulum.x, pendulum.vx, robot), dcm(pendulum.y, pendulum.vy, robot)


@compiled
def ramp_weights(wh: float, ticks: int) -> Vector:
    """Return growth, first and last of ξ(h) = growth ξ(0) - first p(0) - last p(h).

    The ZMP is linear over a time h.

    Args:
        wh: ω times the control period [1].
        ticks: time h in control ticks [1].
    """
    if ticks == 0:
        return 1.0, 0.0, 0.0
    growth = exp(wh * ticks)
    last = (growth - 1.0) / (wh * ticks) - 1.0
    return growth, growth - 1.0 - last, last


@compiled
def dcm_reference(ramps: Records[Ramp], robot: Model) -> Point:
    """Return the DCM from which a reference can be walked for ever: the backward recursion [m].

    Beyond the last ramp the ZMP stays and the DCM rests on it. A reference s seconds ahead has the
    weight ω e^{-ωs}: preview control in the limit of zero weight on the jerk.

    Args:
        ramps: reference, see `walking.plan.reference.RAMP` (n,).
        robot: constants.
    """
    wh = robot.omega * CONTROL_PERIOD
    end = len(ramps) - 1
    x, y = ramps[end].bx, ramps[end].by
    for k in range(end, -1, -1):
        ramp = ramps[k]
        growth, first, last = ramp_weights(wh, ramp.ticks)
        x = (x + first * ramp.ax + last * ramp.bx) / growth
        y = (y + first * ramp.ay + last * ramp.by) / growth
    return x, y


@compiled
def hold(omega: float, position: float, velocity: float, zmp: float, time: float) -> Point:
    """Return position [m] and velocity [m/s] a `time` [s] later under a constant ZMP [m]."""
    c, s, d = cosh(omega * time), sinh(omega * time), position - zmp
    return zmp + d * c + velocity / omega * s, d * omega * s + velocity * c


@compiled
def hold_tick(robot: Model, position: float, velocity: float, zmp: float) -> Point:
    """Return position [m] and velocity [m/s] one control tick later under a constant ZMP [m]."""
    d, w = position - zmp, robot.omega
    return (
        zmp + d * robot.cosh + velocity / w * robot.sinh,
        d * w * robot.sinh + velocity * robot.cosh,
    )


@compiled
def step_pendulum(pendulum: Pendulum, robot: Model, zmp: Point, region: Region) -> None:
    """Advance by a tick under a constant ZMP [m], clipped to a region."""
    px, py = clip(region, zmp[0], zmp[1])
    pendulum.x, pendulum.vx = hold_tick(robot, pendulum.x, pendulum.vx, px)
    pendulum.y, pendulum.vy = hold_tick(robot, pendulum.y, pendulum.vy, py)
    pendulum.zmp_x, pendulum.zmp_y = px, py


@compiled
def track_dcm(
    pendulum: Pendulum, robot: Model, gain: float, dcm: Point, zmp: Point, region: Region
) -> None:
    """Advance by a tick towards a DCM.

    Args:
        pendulum: changed.
        robot: constants.
        gain: ZMP shift per DCM error, above one [1].
        dcm: reference [m].
        zmp: ZMP of the reference [m].
        region: admissible ZMP.
    """
    x, y = dcm_of(pendulum, robot)
    px = zmp[0] + gain * (x - dcm[0])
    py = zmp[1] + gain * (y - dcm[1])
    step_pendulum(pendulum, robot, (px, py), region)


@compiled
def track_reference(
    pendulum: Pendulum, robot: Model, gain: float, ramps: Records[Ramp], region: Region
) -> None:
    """Advance by a tick towards the DCM of a reference, see `track_dcm`."""
    ramp = ramps[0]
    middle = 0.5 / ramp.ticks
    x = ramp.ax + (ramp.bx - ramp.ax) * middle
    y = ramp.ay + (ramp.by - ramp.ay) * middle
    track_dcm(pendulum, robot, gain, dcm_reference(ramps, robot), (x, y), region)
