"""What a command makes of a footstep: where each foot goes, how long it takes, how high."""

from walking.parameters import CONTROL_PERIOD
from walking.value import comparable_value

Velocity = tuple[float, float, float]
"""(vx, vy, wz) [m/s, m/s, rad/s]."""

STILL: Velocity = (0.0, 0.0, 0.0)

Placement = tuple[float, float, float]
"""Landing in the frame of the support foot: x [m], y [m], direction [rad]."""


@comparable_value
class Strides:
    """Landing of either foot in the frame of the other.

    Attributes:
        right, left: of that foot.
    """

    right: Placement
    left: Placement

    def towards(self, other: "Strides", share: float) -> "Strides":
        """Strides `share` of the way to others."""
        return Strides(
            right=_between(self.right, other.right, share),
            left=_between(self.left, other.left, share),
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
        """Of the footstep [s]."""
        return (self.double + self.single) * CONTROL_PERIOD

    def towards(self, other: "Timing", share: float) -> "Timing":
        """Timing `share` of the way to another, in whole ticks."""
        return Timing(
            double=self.double + round(share * (other.double - self.double)),
            single=self.single + round(share * (other.single - self.single)),
            swing_height=self.swing_height + share * (other.swing_height - self.swing_height),
        )


def _between(a: Placement, b: Placement, share: float) -> Placement:
    return (
        a[0] + share * (b[0] - a[0]),
        a[1] + share * (b[1] - a[1]),
        a[2] + share * (b[2] - a[2]),
    )
