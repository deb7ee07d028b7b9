"""ZMP reference of footholds."""

from walking.arrays import Array, Point
from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps import foothold_kernel
from walking.footsteps.foothold_kernel import Chain
from walking.footsteps.stride import Timing
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.ramps import Ramps
from walking.planar import from_frame


class ZmpReference:
    """Computes the ZMP reference of footholds.

    Args:
        parameters: ZMP in the sole, and duration of the last double support.
        sole: rectangle of the soles.

    Attributes:
        zmp_offset: ZMP of single support in the foot frame, forward and inward [m].
        stop: control ticks of the last double support [1].
    """

    def __init__(self, parameters: WalkingParameters, sole: Sole) -> None:
        pattern = parameters.pattern
        self.zmp_offset = (sole.centre + pattern.zmp_forward, pattern.zmp_inward)
        self.stop = max(1, round(parameters.gait.stop_time / CONTROL_PERIOD))

    def under(self, foot: Foothold) -> Point:
        """Return the ZMP of single support on a foot [m]."""
        forward, inward = self.zmp_offset
        return from_frame(foot.frame, forward, -inward if foot.left else inward)

    def between(self, one: Foothold, other: Foothold) -> Point:
        """Return the ZMP of equal loads on two feet [m]."""
        (ax, ay), (bx, by) = self.under(one), self.under(other)
        return 0.5 * (ax + bx), 0.5 * (ay + by)

    def plan_walk(
        self,
        feet: tuple[Foothold, Foothold],
        landing: Foothold,
        chain: Chain,
        timing: Timing,
        *,
        zmp: Point,
        left: tuple[int, int],
        moving: bool,
    ) -> tuple[Array, Ramps]:
        """Return the footholds of a walk from now on, and its ZMP reference.

        Args:
            feet: swing foot and support foot of this footstep.
            landing: of the swing foot.
            chain: rule of the following footholds.
            timing: of later footsteps.
            zmp: present ZMP in double support [m].
            left: remaining control ticks of the double support, zero in single support, and of the
                single support after it [1].
            moving: whether the walk goes on.

        Returns:
            footholds from `landing` on, rows of `Foothold.row` (n, 4); the reference.
        """
        steps, table = foothold_kernel.plan_walk(
            feet[0].row,
            feet[1].row,
            landing.row,
            chain,
            moving,
            zmp,
            (*left, timing.double, timing.single, self.stop),
            self.zmp_offset,
        )
        return steps, Ramps(table)
