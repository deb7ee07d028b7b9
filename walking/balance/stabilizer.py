"""Balance: what the ankles can do now and what only the next foothold can."""

from math import cos, exp, sin

from walking.balance.pole_placement import dcm_gain
from walking.balance.step_timing import capture_time
from walking.body.robot_model import RobotModel
from walking.clamp import clamp
from walking.dead_zone import dead_zone
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.pattern.support import SupportRegion
from walking.value import value

ROUNDING = 1e-6  # ticks that a time divided into them may lack


@value
class Capture:
    """The foothold that catches the body, and when it is needed.

    Attributes:
        landing: of the swing foot.
        ticks: after which it has to carry [1].
    """

    landing: Foothold
    ticks: int


class Stabilizer:
    """Feedback of the DCM error on ZMP and footholds.

    Args:
        robot: mass, sole and ankle servos.
        parameters: gains.
        omega: of the pendulum [1/s].
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters, omega: float) -> None:
        self._parameters = parameters
        self._omega = omega
        lag = float((robot.damping[4:6] / robot.stiffness[4:6]).max())
        self._gain = dcm_gain(omega, lag, parameters.dcm_rate)
        sole = robot.sole
        self._room = (
            sole.half_length - parameters.sole_margin,
            sole.half_width - parameters.sole_margin,
        )

    def zmp_shift(
        self, zmp: tuple[float, float], error: tuple[float, float], region: SupportRegion
    ) -> tuple[float, float]:
        """By how much the ankles move the ZMP against a DCM error, inside the region [m]."""
        gain = self._gain
        x, y = region.clip(zmp[0] + gain * error[0], zmp[1] + gain * error[1])
        return x - zmp[0], y - zmp[1]

    def exceeds(self, foot: Foothold, error: tuple[float, float], share: float) -> bool:
        """Whether a DCM error [m] is more than a share [1] of the room that the ZMP has."""
        x, y = self._in_foot(foot, error)
        return abs(x) > share * self._room[0] or abs(y) > share * self._room[1]

    def holds(self, foot: Foothold, error: tuple[float, float]) -> bool:
        """Whether the ankles hold a DCM error [m], so that no landing is moved."""
        return not self.exceeds(foot, error, self._parameters.capture_dead_zone)

    def capture(
        self,
        planner: FootstepPlanner,
        support: Foothold,
        landing: Foothold,
        error: tuple[float, float],
        reference: tuple[float, float],
        *,
        ticks_left: int,
    ) -> Capture:
        """Landing and its time that catch what the ankles do not hold of a DCM error.

        Left alone, the error grows by e^{ωt} until touchdown; moving the foothold by that
        much puts the foot under it (Pratt et al., Humanoids 2006). Where that is out of reach
        the foot has to be down sooner, see `capture_time`.

        Args:
            planner: knows what is in reach.
            support: the foot on the floor.
            landing: the nominal one.
            error: of the measured DCM [m].
            reference: DCM of the plan less the ZMP of the support foot [m].
            ticks_left: until the end of single support.
        """
        p = self._parameters
        x, y = self._in_foot(support, error)
        x = dead_zone(x, p.capture_dead_zone * self._room[0])
        y = dead_zone(y, p.capture_dead_zone * self._room[1])
        growth = exp(self._omega * ticks_left * CONTROL_PERIOD)
        dx = clamp(growth * x, p.capture_forward)
        dy = clamp(growth * y, p.capture_side)
        c, s = cos(support.yaw), sin(support.yaw)
        reached = planner.reachable(support, landing, c * dx - s * dy, s * dx + c * dy)
        planned = time = ticks_left * CONTROL_PERIOD
        for off, room, ahead, reach in zip(
            self._in_foot(support, error),
            self._room,
            self._in_foot(support, reference),
            self._in_foot(support, (reached.x - landing.x, reached.y - landing.y)),
            strict=True,
        ):
            missing = dead_zone(off, room)
            time = min(time, capture_time(self._omega, planned, missing, ahead, reach))
        return Capture(reached, int(time / CONTROL_PERIOD + ROUNDING))

    @staticmethod
    def _in_foot(foot: Foothold, vector: tuple[float, float]) -> tuple[float, float]:
        c, s = cos(foot.yaw), sin(foot.yaw)
        return c * vector[0] + s * vector[1], c * vector[1] - s * vector[0]
