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

from dataclasses import dataclass

import numpy as np

from walking.arrays import Array, Point
from walking.body.leg import FootPose
from walking.body.robot_model import RobotModel
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.footsteps.foothold_kernel import ZmpOffset
from walking.gait import swing_kernel
from walking.gait.swing_kernel import Feet
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.pattern.lipm import Lipm
from walking.value import value

SMALL = 1e-4  # step of finite differences [m]


@dataclass(frozen=True, slots=True)
class LegReaction:
    """Shift of the ZMP by accelerations of the swing foot.

    Attributes:
        thrust: B, backward shift of the ZMP per forward acceleration of the foot [s²].
        weight: K, shift towards the foot per upward acceleration and distance of the foot from the
            ZMP [s²/m].
        knee: N, backward shift per upward acceleration of the foot [s²].
    """

    thrust: float
    weight: float
    knee: float


def leg_reaction(robot: RobotModel, height: float, lift: float) -> LegReaction:
    """Return the reaction of a leg at mid-swing.

    Args:
        robot: masses and dimensions.
        height: of the base above the floor [m].
        lift: swing height; the reaction is that at half of it [m].
    """
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

    return LegReaction(
        thrust=moment(thrust)[1] / load,
        weight=moment(raised)[0] / (leg.foot[1] * load),
        knee=moment(raised)[1] / load,
    )


@value
class Swings:
    """Swings of a plan, arguments of `swing_kernel.swings`.

    Attributes:
        feet: see `swing_kernel.Feet`.
        steps, now, later: see `swing_kernel.swings`.
        zmp_offset: see `swing_kernel.ZmpOffset`.
        ticks: from lift-off to touchdown, of the first and of later swings [1].
    """

    feet: Feet
    steps: Array
    now: tuple[int, float, bool]
    later: tuple[int, int, float]
    zmp_offset: ZmpOffset
    ticks: tuple[int, int]


ORIGIN = (0.0, 0.0, 0.0, 0.0)
NO_SWINGS = Swings(
    (ORIGIN, ORIGIN, ORIGIN), np.empty((0, 4)), (0, 0.0, False), (0, 0, 0.0), (0.0, 0.0), (0, 0)
)
"""Swings while standing."""


class SwingCompensation:
    """Compensation of the swing leg's reaction by the pelvis.

    Args:
        lipm: pendulum.
        reaction: of a leg.

    Attributes:
        offset: of the pelvis from the pendulum (2,) [m].
        acceleration: of that offset (2,) [m/s²].
    """

    def __init__(self, lipm: Lipm, reaction: LegReaction) -> None:
        self._lipm = lipm
        leg = reaction.thrust, reaction.weight, reaction.knee
        self._coefficients = np.array([*leg, lipm.omega, CONTROL_PERIOD])
        self._profiles: dict[int, Array] = {0: np.zeros((1, 6))}
        self._state = np.zeros(4)
        self.offset: Point = (0.0, 0.0)
        self.acceleration: Point = (0.0, 0.0)

    def advance(self, swings: Swings) -> None:
        """Run one tick along a plan."""
        first, others = swings.ticks
        self.offset, self.acceleration = swing_kernel.react(
            swings.feet,
            swings.steps,
            swings.now,
            swings.later,
            swings.zmp_offset,
            self._profile(first),
            self._profile(others),
            self._coefficients,
            self._state,
        )

    def _profile(self, ticks: int) -> Array:
        if ticks not in self._profiles:
            c = self._lipm.ramp(1)
            ramp = (c.growth, c.first, c.last)
            self._profiles[ticks] = swing_kernel.profile(ticks, ramp, CONTROL_PERIOD)
        return self._profiles[ticks]
