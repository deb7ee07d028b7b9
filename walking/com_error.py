"""Where the body's mass centre is, seen from the feet that the plan stands on."""

from walking import leg_kernel
from walking.estimator import ErrorFilter
from walking.gait import Gait
from walking.measurement import BodyMeasurement
from walking.parameters import EstimatorParameters

Point = tuple[float, float]


class ComError:
    """Difference of measured and planned mass centre in the plan frame.

    Args:
        omega: of the pendulum [1/s].
        parameters: noise levels.

    Attributes:
        filter: its position and velocity.
    """

    def __init__(self, omega: float, parameters: EstimatorParameters) -> None:
        self.filter = ErrorFilter(omega, parameters)
        self._omega = omega
        self._right_weight: float | None = None

    def update(
        self, body: BodyMeasurement, gait: Gait, planned: Point, slip: float, zmp_shift: Point
    ) -> Point:
        """One tick.

        Args:
            body: measured.
            gait: feet as planned, and the weight on them.
            planned: mass centre [m].
            slip: turn rate of the body that was not planned [rad/s].
            zmp_shift: by how much the ankles moved the ZMP [m].

        Returns:
            error of the DCM [m].
        """
        (left, right), (one, other) = body.feet, gait.feet
        (lx, ly, lax, lay), (rx, ry, rax, ray) = leg_kernel.com_errors(
            body.com,
            ((left.x, left.y, left.yaw), (right.x, right.y, right.yaw)),
            (one.row, other.row),
            planned,
        )
        weight = gait.right_weight
        rest = 1.0 - weight
        e, before = self.filter, self._right_weight
        self._right_weight = weight
        if before is not None and weight != before:
            e.shift((weight - before) * (rx - lx), (weight - before) * (ry - ly))
        arm_x = rest * lax + weight * rax
        arm_y = rest * lay + weight * ray
        e.update(
            (rest * lx + weight * rx, rest * ly + weight * ry),
            zmp_shift,
            (-slip * arm_y, slip * arm_x),
        )
        return e.x + e.vx / self._omega, e.y + e.vy / self._omega
