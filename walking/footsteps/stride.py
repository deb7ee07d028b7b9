"""Strides and timing of footsteps."""

from walking.parameters import CONTROL_PERIOD
from walking.value import comparable_value

Velocity = tuple[float, float, float]
"""(vx, vy, wz) [m/s, m/s, rad/s]."""

STILL: Velocity = (0.0, 0.0, 0.0)

Placement = tuple[float, float, float]
"""Landing in the frame of the support foot: x, y [m], yaw [rad]."""


@comparable_value
class Strides:
    """Landing of either foot in the frame of the other.

    Attributes:
        right, left: of that foot.
    """

    right: Placement
    left: Placement

    def towards(self, other: "Strides", fraction: float) -> "Strides":
        """Interpolate linearly to other strides."""
        return Strides(
            right=_between(self.right, other.right, fraction),
            left=_between(self.left, other.left, fraction),
        )


@comparable_value
class Timing:
    """Timing and swing height of a footstep.

    Attributes:
        double, single: control ticks in double and single support [1].
        swing_height: height of the swing foot at mid-swing [m].
    """

    double: int
    single: int
    swing_height: float

    @property
    def duration(self) -> float:
        """Duration of the footstep [s]."""
        return (self.double + self.single) * CONTROL_PERIOD

    def towards(self, other: "Timing", fraction: float) -> "Timing":
        """Interpolate linearly to another timing, in whole ticks."""
        return Timing(
            double=self.double + round(fraction * (other.double - self.double)),
            single=self.single + round(fraction * (other.single - self.single)),
            swing_height=self.swing_height + fraction * (other.swing_height - self.swing_height),
        )


def _between(a: Placement, b: Placement, fraction: float) -> Placement:
    return (
        a[0] + fraction * (b[0] - a[0]),
        a[1] + fraction * (b[1] - a[1]),
        a[2] + fraction * (b[2] - a[2]),
    )
