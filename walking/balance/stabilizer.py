"""Balance feedback of the DCM error: ankle strategy and capture step."""

from math import exp

from walking.arrays import Point
from walking.balance.pole_placement import dcm_gain
from walking.balance.step_timing import capture_time
from walking.body.robot_model import RobotModel
from walking.clamp import clamp, dead_zone
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.pattern.support import SupportRegion
from walking.planar import rotate, rotate_back
from walking.value import value

ROUNDING = 1e-6  # rounding error of a time in control ticks [1]


@value
class Capture:
    """Capture step.

    Attributes:
        landing: of the swing foot.
        ticks: control ticks until touchdown [1].
    """

    landing: Foothold
    ticks: int


class Stabilizer:
    """Feedback of the DCM error to ZMP and footholds.

    Args:
        robot: mass, sole and ankle servos.
        parameters: gains.
        omega: of the pendulum [1/s].
    """

    def __init__(self, robot: RobotModel, parameters: StabilizerParameters, omega: float) -> None:
        self._parameters = parameters
        self._omega = omega
        ankle = slice(robot.legs[0].ankle, 6)
        lag = float((robot.damping[ankle] / robot.stiffness[ankle]).max())
        self._gain = dcm_gain(omega, lag, parameters.dcm_rate)
        sole, margin = robot.support, parameters.sole_margin
        self._margin = sole.half_length - margin, sole.half_width - margin

    def zmp_shift(self, zmp: Point, error: Point, region: SupportRegion) -> Point:
        """Return the shift of the ZMP by the ankles against a DCM error [m]."""
        gain = self._gain
        x, y = region.clip(zmp[0] + gain * error[0], zmp[1] + gain * error[1])
        return x - zmp[0], y - zmp[1]

    def exceeds(self, foot: Foothold, error: Point, ratio: float) -> bool:
        """Whether a DCM error [m] exceeds a ratio [1] of the ZMP margins of the sole."""
        x, y = rotate_back(foot.yaw, *error)
        return abs(x) > ratio * self._margin[0] or abs(y) > ratio * self._margin[1]

    def holds(self, foot: Foothold, error: Point) -> bool:
        """Whether the ankles can balance a DCM error [m] without a capture step."""
        return not self.exceeds(foot, error, self._parameters.capture_dead_zone)

    def capture(
        self,
        planner: FootstepPlanner,
        support: Foothold,
        landing: Foothold,
        error: Point,
        reference: Point,
        *,
        ticks_left: int,
    ) -> Capture:
        """Return the capture step for the DCM error beyond the dead zone of the ankles.

        The error grows by e^{ωt} until touchdown; a landing shifted by as much is at the capture
        point (Pratt et al., Humanoids 2006). If that is out of reach, touchdown must be earlier,
        see `capture_time`.

        Args:
            planner: limits the landing to the reach of the leg.
            support: support foot.
            landing: nominal landing.
            error: of the measured DCM [m].
            reference: planned DCM minus ZMP of the support foot [m].
            ticks_left: control ticks until the end of single support [1].
        """
        p = self._parameters
        x, y = error_in_foot = rotate_back(support.yaw, *error)
        x = dead_zone(x, p.capture_dead_zone * self._margin[0])
        y = dead_zone(y, p.capture_dead_zone * self._margin[1])
        growth = exp(self._omega * ticks_left * CONTROL_PERIOD)
        dx = clamp(growth * x, p.capture_forward)
        dy = clamp(growth * y, p.capture_side)
        reached = planner.reachable(support, landing, *rotate(support.yaw, dx, dy))
        planned = time = ticks_left * CONTROL_PERIOD
        for off, margin, ahead, reach in zip(
            error_in_foot,
            self._margin,
            rotate_back(support.yaw, *reference),
            rotate_back(support.yaw, reached.x - landing.x, reached.y - landing.y),
            strict=True,
        ):
            missing = dead_zone(off, margin)
            time = min(time, capture_time(self._omega, planned, missing, ahead, reach))
        return Capture(reached, int(time / CONTROL_PERIOD + ROUNDING))
