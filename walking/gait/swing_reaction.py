"""The swinging leg's reaction on the ZMP, and the motion of the pelvis that takes it out.

The pendulum stands for a body that carries its legs along; a leg that swings accelerates on
its own account and moves the ZMP by

    d = -B x_f'' + K h'' (x_f - p) - N h'' e,

x_f the foot's place, h its height, p the ZMP, e the heading: thrust of the leg forward, its
weight lifted, its knee pushed ahead as it folds. All three numbers are read off the robot's
model. A pelvis that moves by c more than the pendulum, c'' = ω² (c + d), puts the ZMP back to
where it was planned: of all solutions the one that neither grows nor has grown,

    c' = ω (ξ - c),   ξ = - ∫ ω e^{-ωs} d(t + s) ds,

which looks as far ahead as preview control does and is closed form in the footholds. Kajita
et al. (ICRA 2003) get the same correction from a second preview controller on the multibody
ZMP, Takenaka et al. (IROS 2009) from a pendulum with three masses.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from walking.body.joints import LEFT_LEG, RIGHT_LEG
from walking.body.leg_kinematics import FootPose, leg_angles
from walking.body.robot_model import RobotModel
from walking.gait import swing_kernel
from walking.gait.swing_kernel import Feet, Spot
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.pattern.lipm import Lipm
from walking.value import value

Array = NDArray[np.float64]
Point = tuple[float, float]
SMALL = 1e-4  # of a foot's move in finite differences [m]


@dataclass(frozen=True, slots=True)
class LegReaction:
    """How an acceleration of the swing foot moves the ZMP.

    Attributes:
        thrust: B, backward shift of the ZMP per forward acceleration of the foot [s²].
        weight: K, shift towards the foot per upward acceleration of it and distance of it from
            the ZMP [s²/m].
        knee: N, backward shift per upward acceleration of the foot [s²].
    """

    thrust: float
    weight: float
    knee: float


def leg_reaction(robot: RobotModel, height: float, lift: float) -> LegReaction:
    """Reaction of a leg at mid-swing.

    Args:
        robot: masses and dimensions.
        height: of the base above the floor [m].
        lift: of the foot [m]; half of it counts.
    """
    ahead = float(robot.com(robot.ready)[0])
    leg = robot.legs[0]

    def posture(forward: float, up: float) -> np.ndarray:
        q = robot.ready.copy()
        for side, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
            foot = FootPose(ahead, side.hip_y, -height, 0.0, 0.0, 0.0)
            if side is leg:
                foot = FootPose(ahead + forward, side.hip_y, up - height, 0.0, 0.0, 0.0)
            q[part] = leg_angles(side, foot)[0]
        return q

    middle = 0.5 * lift
    q = posture(0.0, middle)
    thrust = (posture(SMALL, middle) - posture(-SMALL, middle)) / (2.0 * SMALL)
    raised = (posture(0.0, middle + SMALL) - posture(0.0, middle - SMALL)) / (2.0 * SMALL)
    rest, load = np.zeros_like(q), robot.mass * GRAVITY

    def moment(acceleration: np.ndarray) -> tuple[float, float]:
        """About x and y through the floor under the foot, beyond that of the posture."""
        _, moved = robot.inverse_dynamics(q, rest, acceleration, (0.0, 0.0))
        _, still = robot.inverse_dynamics(q, rest, rest, (0.0, 0.0))
        fx, fy, fz, nx, ny, _ = (moved - still).tolist()
        return nx - height * fy, ny + height * fx + ahead * fz

    return LegReaction(
        thrust=moment(thrust)[1] / load,
        weight=moment(raised)[0] / (leg.hip_y * load),
        knee=moment(raised)[1] / load,
    )


@value
class Swings:
    """The swings of a plan, the next one first; only that one may be under way.

    Attributes:
        feet: the support foot, and where the other one comes from and goes to, see
            `swing_kernel.Feet`.
        steps: footholds to come, see `swing_kernel.swings` (n, 4).
        now: see `swing_kernel.swings`.
        later: see `swing_kernel.swings`.
        spot: see `swing_kernel.Spot`.
        ticks: from lift to landing, of the first and of all others [1].
    """

    feet: Feet
    steps: Array
    now: tuple[int, float, bool]
    later: tuple[int, int, float]
    spot: Spot
    ticks: tuple[int, int]


ORIGIN = (0.0, 0.0, 0.0, 0.0)
NO_SWINGS = Swings(
    (ORIGIN, ORIGIN, ORIGIN), np.empty((0, 4)), (0, 0.0, False), (0, 0, 0.0), (0.0, 0.0), (0, 0)
)
"""While the robot stands."""


class SwingCompensation:
    """Moves the pelvis against the swinging legs.

    Args:
        lipm: pendulum.
        reaction: of a leg.

    Attributes:
        offset: of the pelvis from the pendulum's plan (2,) [m].
        acceleration: of that offset (2,) [m/s²].
    """

    def __init__(self, lipm: Lipm, reaction: LegReaction) -> None:
        self._lipm = lipm
        law = reaction.thrust, reaction.weight, reaction.knee, lipm.omega, CONTROL_PERIOD
        self._law = np.array(law)
        self._profiles: dict[int, Array] = {0: np.zeros((1, 6))}
        self._state = np.zeros(4)
        self.offset: Point = (0.0, 0.0)
        self.acceleration: Point = (0.0, 0.0)

    def advance(self, swings: Swings) -> None:
        """One tick along a plan."""
        first, others = swings.ticks
        self.offset, self.acceleration = swing_kernel.react(
            swings.feet,
            swings.steps,
            swings.now,
            swings.later,
            swings.spot,
            self._profile(first),
            self._profile(others),
            self._law,
            self._state,
        )

    def _profile(self, ticks: int) -> Array:
        found = self._profiles.get(ticks)
        if found is None:
            c = self._lipm.ramp(1)
            ramp = (c.growth, c.first, c.last)
            found = self._profiles[ticks] = swing_kernel.profile(ticks, ramp, CONTROL_PERIOD)
        return found
