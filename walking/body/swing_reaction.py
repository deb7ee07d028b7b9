"""Reaction of the swing leg on the ZMP, and its compensation by the pelvis.

The pendulum models a body with its legs at rest; the acceleration of the swing leg shifts the ZMP
by

    d = -B x_f'' + K h'' (x_f - p) - N h'' e,

x_f the position of the foot, h its height, p the ZMP, e the heading: forward thrust of the leg,
lifted weight, forward motion of the folding knee. The three coefficients follow from the robot
model. A pelvis offset c from the pendulum, c'' = ω² (c + d), restores the planned ZMP. Its bounded
solution is

    c' = ω (ξ - c),   ξ = - ∫ ω e^{-ωs} d(t + s) ds,

a closed form in the footholds with the look-ahead of preview control. Kajita et al. (ICRA 2003)
compute this correction by a second preview controller on the multibody ZMP, Takenaka et al.
(IROS 2009) by a pendulum with three masses.
"""

from math import cos, exp, sin
from typing import NamedTuple

import numpy as np

from compilation import compiled
from walking.body.kinematics import FootPose
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.data import Limbs, Plan
from walking.model import Model
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.plan.footsteps import Foothold, foothold
from walking.plan.gait import phase_of, support_foot, swing_foot, zmp_under
from walking.plan.pendulum import ramp_weights
from walking.plan.swing import lift_profile, minimum_jerk
from walking.plane import Point, Vector

SMALL = 1e-4  # step of finite differences [m]


def leg_reaction(robot: RobotModel, height: float, lift: float) -> Vector:
    """Return the reaction of a leg at mid-swing.

    Args:
        robot: masses and dimensions.
        height: height of the base above the floor [m].
        lift: swing height; the reaction is that at half of it [m].

    Returns:
        B, backward shift of the ZMP per forward acceleration of the foot [s²]; K, shift towards the
        foot per upward acceleration and distance of the foot from the ZMP [s²/m]; N, backward shift
        per upward acceleration of the foot [s²].
    """
    robot = robot.with_own_buffers()
    ahead = float(robot.com(robot.ready)[0])
    leg = robot.legs[0]

    def posture(forward: float, up: float) -> np.ndarray:
        q = robot.ready.copy()
        for side, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
            moved, raised = (forward, up) if side is leg else (0.0, 0.0)
            foot = FootPose(ahead + moved, side.foot[1], raised - height)
            q[part] = side.angles(foot)[0]
        return q

    middle = 0.5 * lift
    q = posture(0.0, middle)
    thrust = (posture(SMALL, middle) - posture(-SMALL, middle)) / (2.0 * SMALL)
    raised = (posture(0.0, middle + SMALL) - posture(0.0, middle - SMALL)) / (2.0 * SMALL)
    rest, load = np.zeros_like(q), robot.mass * GRAVITY

    def moment(acceleration: np.ndarray) -> Point:
        """Return the moment of an acceleration about x and y at the floor under the foot [N m]."""
        _, moved = robot.inverse_dynamics(q, rest, acceleration, (0.0, 0.0))
        _, still = robot.inverse_dynamics(q, rest, rest, (0.0, 0.0))
        fx, fy, fz, nx, ny, _ = (moved - still).tolist()
        return nx - height * fy, ny + height * fx + ahead * fz

    sideways, forward = moment(raised)
    return moment(thrust)[1] / load, sideways / (leg.foot[1] * load), forward / load


class Moments(NamedTuple):
    """Accelerations of a swing over unit distance and height.

    Attributes:
        forward, up: accelerations [1/s²].
        both: `up` times the distance covered [1/s²].
    """

    forward: float
    up: float
    both: float


@compiled
def accelerations(ticks: int, tick: int) -> Moments:
    """Return the accelerations in a tick of a swing of a number of ticks."""
    time = ticks * CONTROL_PERIOD
    square = time * time
    u = tick / ticks
    rest = 1.0 - u
    up = lift_profile(u).acceleration / square
    return Moments(60.0 * u * rest * (rest - u) / square, up, up * minimum_jerk(u))


@compiled
def previewed(ticks: int, tick: int, robot: Model) -> Moments:
    """Return ∫ ω e^{-ωs} of the accelerations over the rest of a swing, linear between ticks."""
    growth, first, last = ramp_weights(robot.omega * CONTROL_PERIOD, 1)
    forward = up = both = 0.0
    then = accelerations(ticks, ticks)
    for k in range(ticks - 1, tick - 1, -1):
        now = accelerations(ticks, k)
        forward = (forward + first * now.forward + last * then.forward) / growth
        up = (up + first * now.up + last * then.up) / growth
        both = (both + first * now.both + last * then.both) / growth
        then = now
    return Moments(forward, up, both)


@compiled
def compensate(limbs: Limbs, plan: Plan, robot: Model) -> None:
    """Run one tick of the compensation along a plan.

    Args:
        limbs: offset of the pelvis and its acceleration, changed.
        plan: plan in force.
        robot: constants.
    """
    w = robot.omega
    ahead_x, ahead_y, now_x, now_y = _previewed_shift(plan, robot)
    gain = 1.0 - exp(-w * CONTROL_PERIOD)
    offset, ahead = limbs.offset, limbs.ahead
    offset.x = offset.x + gain * (0.5 * (ahead.x + ahead_x) - offset.x)
    offset.y = offset.y + gain * (0.5 * (ahead.y + ahead_y) - offset.y)
    ahead.x, ahead.y = ahead_x, ahead_y
    limbs.offset_acceleration.x = w * w * (offset.x + now_x)
    limbs.offset_acceleration.y = w * w * (offset.y + now_y)


@compiled
def _previewed_shift(plan: Plan, robot: Model) -> tuple[float, float, float, float]:
    """Return ξ x, y [m] and the present shift of the ZMP x, y [m]; zero while standing."""
    gait, timing, single = plan.gait, plan.gait.clock.timing, plan.gait.clock.single
    ahead_x = ahead_y = now_x = now_y = 0.0
    if not gait.stepping or plan.step_count == 0:
        return ahead_x, ahead_y, now_x, now_y
    phase = phase_of(gait)
    begin, ticks = single.first - phase.elapsed, single.last - single.first
    if begin <= 0 and single.origin > 0.0:
        # Retimed in the air: extrapolate back to a swing of constant speed.
        ticks = round(ticks / (1.0 - single.origin))
        begin = -round(phase.swing * ticks)
    first = round(robot.gait.swing_start * timing.single)
    usual = round(robot.gait.swing_end * timing.single) - first
    support, origin, landing = support_foot(gait), swing_foot(gait), foothold(gait.landing)
    if not gait.landed_early:
        elapsed = min(ticks, max(0, -begin))
        zmp = zmp_under(support, robot)
        lift = gait.swing_height
        moments = previewed(ticks, elapsed, robot)
        dx, dy = _zmp_shift(origin, landing, zmp, lift, moments, robot)
        decay = _decay(begin, robot)
        ahead_x, ahead_y = ahead_x - decay * dx, ahead_y - decay * dy
        if begin <= 0:
            moments = accelerations(ticks, elapsed)
            now_x, now_y = _zmp_shift(origin, landing, zmp, lift, moments, robot)
    begin = phase.ticks_left + timing.double + first
    whole = previewed(usual, 0, robot)
    for k in range(1, plan.step_count):
        step, zmp = foothold(plan.steps[k]), zmp_under(landing, robot)
        dx, dy = _zmp_shift(support, step, zmp, timing.swing_height, whole, robot)
        decay = _decay(begin, robot)
        ahead_x, ahead_y = ahead_x - decay * dx, ahead_y - decay * dy
        support, landing = landing, step
        begin += timing.double + timing.single
    return ahead_x, ahead_y, now_x, now_y


@compiled
def _zmp_shift(
    origin: Foothold, landing: Foothold, zmp: Point, lift: float, moments: Moments, robot: Model
) -> Point:
    """Return the shift of the ZMP by a swing of height `lift` [m] about a ZMP [m]."""
    thrust, weight = robot.thrust, robot.lifted_weight * lift
    knee = robot.knee * lift * moments.up
    yaw = 0.5 * (origin.yaw + landing.yaw)
    (x, y), dx, dy = zmp, landing.x - origin.x, landing.y - origin.y
    forward, up, both = moments
    return (
        weight * (up * (origin.x - x) + both * dx) - thrust * forward * dx - knee * cos(yaw),
        weight * (up * (origin.y - y) + both * dy) - thrust * forward * dy - knee * sin(yaw),
    )


@compiled
def _decay(begin: int, robot: Model) -> float:
    """Return the weight of a swing that begins some ticks ahead [1]."""
    return exp(-robot.omega * CONTROL_PERIOD * begin) if begin > 0 else 1.0
