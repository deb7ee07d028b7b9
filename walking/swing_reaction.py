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
from math import cos, exp, sin

import numpy as np

from walking.joints import LEFT_LEG, RIGHT_LEG
from walking.leg_kinematics import FootPose, leg_angles
from walking.lipm import Lipm
from walking.parameters import CONTROL_PERIOD, GRAVITY
from walking.robot_model import RobotModel
from walking.state import Footstep
from walking.value import value

Point = tuple[float, float]
SMALL = 1e-4  # of a foot's move in finite differences [m]


@dataclass(frozen=True, slots=True)
class LegReaction:
    """Move of the ZMP by an acceleration of the swing foot.

    Attributes:
        thrust: B, against a horizontal one, per its size [s²].
        weight: K, towards the foot for one upwards, per its size and the foot's distance [s²/m].
        knee: N, backward for one upwards, per its size [s²].
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
    ahead = robot.com(robot.ready)[0]
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
class Swing:
    """A swing of the plan.

    Attributes:
        begin: control ticks until the foot lifts; negative while it is in the air [1].
        ticks: control ticks from lift to landing [1].
        lift: its height at mid-swing [m].
        origin, landing: where the foot comes from and goes to.
        zmp: of the support foot [m].
    """

    begin: int
    ticks: int
    lift: float
    origin: Footstep
    landing: Footstep
    zmp: Point


@dataclass(frozen=True, slots=True)
class _Profile:
    """A swing of so many ticks over a unit distance and height, tick by tick.

    Attributes:
        moved: share of the distance [1].
        forward, up: second derivatives of distance and height [1/s²].
        ahead_forward, ahead_up, ahead_both: ∫ ω e^{-ωs} over the rest of the swing of
            `forward`, of `up` and of `up` times `moved`.
    """

    moved: list[float]
    forward: list[float]
    up: list[float]
    ahead_forward: list[float]
    ahead_up: list[float]
    ahead_both: list[float]


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
        self._reaction = reaction
        self._share = 1.0 - exp(-lipm.omega * CONTROL_PERIOD)
        self._profiles: dict[int, _Profile] = {}
        self._ahead_before: Point = (0.0, 0.0)
        self.offset: Point = (0.0, 0.0)
        self.acceleration: Point = (0.0, 0.0)

    def advance(self, swings: list[Swing]) -> None:
        """One tick along a plan, the next swing first."""
        w = self._lipm.omega
        x = y = now_x = now_y = 0.0
        for swing in swings:
            profile = self._profile(swing.ticks)
            tick = min(swing.ticks, max(0, -swing.begin))
            vx, vy = self._moved(
                swing, profile.ahead_forward[tick], profile.ahead_up[tick], profile.ahead_both[tick]
            )
            decay = exp(-w * CONTROL_PERIOD * swing.begin) if swing.begin > 0 else 1.0
            x -= decay * vx
            y -= decay * vy
            if swing.begin <= 0:
                up = profile.up[tick]
                now_x, now_y = self._moved(
                    swing, profile.forward[tick], up, up * profile.moved[tick]
                )
        (cx, cy), (bx, by) = self.offset, self._ahead_before
        self._ahead_before = (x, y)
        cx += self._share * (0.5 * (bx + x) - cx)
        cy += self._share * (0.5 * (by + y) - cy)
        self.offset = (cx, cy)
        self.acceleration = (w * w * (cx + now_x), w * w * (cy + now_y))

    def _moved(self, swing: Swing, forward: float, up: float, both: float) -> Point:
        """Move of the ZMP, `both` being the move upwards weighted by the way made."""
        r, a, b = self._reaction, swing.origin, swing.landing
        yaw = 0.5 * (a.yaw + b.yaw)
        weight, knee = r.weight * swing.lift, r.knee * swing.lift * up
        dx, dy = b.x - a.x, b.y - a.y
        return (
            weight * (up * (a.x - swing.zmp[0]) + both * dx)
            - r.thrust * forward * dx
            - knee * cos(yaw),
            weight * (up * (a.y - swing.zmp[1]) + both * dy)
            - r.thrust * forward * dy
            - knee * sin(yaw),
        )

    def _profile(self, ticks: int) -> _Profile:
        found = self._profiles.get(ticks)
        if found is None:
            found = self._profiles[ticks] = self._make(ticks)
        return found

    def _make(self, ticks: int) -> _Profile:
        u = np.linspace(0.0, 1.0, ticks + 1)
        rest = 1.0 - u
        square = (ticks * CONTROL_PERIOD) ** 2
        moved = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
        forward = 60.0 * u * rest * (rest - u) / square
        # Of the profile 64 u³ (1 - u)³.
        up = 384.0 * u * rest * (rest * rest - 3.0 * u * rest + u * u) / square
        return _Profile(
            moved.tolist(),
            forward.tolist(),
            up.tolist(),
            self._ahead(forward.tolist()),
            self._ahead(up.tolist()),
            self._ahead((up * moved).tolist()),
        )

    def _ahead(self, values: list[float]) -> list[float]:
        """∫ ω e^{-ωs} of values linear from tick to tick, from each of them to the last."""
        c = self._lipm.ramp(1)
        sums = [0.0] * len(values)
        for k in range(len(values) - 2, -1, -1):
            sums[k] = (sums[k + 1] + c.first * values[k] + c.last * values[k + 1]) / c.growth
        return sums
