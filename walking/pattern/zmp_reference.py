"""What footholds ask of the ZMP."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps import foothold_kernel
from walking.footsteps.foothold_kernel import Chain
from walking.footsteps.stride import Timing
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.pattern.ramps import Ramps

Array = NDArray[np.float64]
Point = tuple[float, float]


class ZmpReference:
    """Places the ZMP under the feet that carry, and moves it from one to the other.

    Args:
        parameters: where the ZMP is meant to be in a sole, and how long a walk takes to end.
        sole: rectangle of the soles.

    Attributes:
        spot: of the ZMP under a foot that carries alone, forward and inward [m].
        stop: control ticks of the last double support [1].
    """

    def __init__(self, parameters: WalkingParameters, sole: Sole) -> None:
        pattern = parameters.pattern
        self.spot = (sole.centre + pattern.zmp_forward, pattern.zmp_inward)
        self.stop = max(1, round(parameters.gait.stop_time / CONTROL_PERIOD))

    def under(self, foot: Foothold) -> Point:
        """ZMP under a foot that carries alone [m]."""
        forward, inward = self.spot
        inward = -inward if foot.left else inward
        c, s = cos(foot.yaw), sin(foot.yaw)
        return (
            foot.x + c * forward - s * inward,
            foot.y + s * forward + c * inward,
        )

    def between(self, one: Foothold, other: Foothold) -> Point:
        """ZMP while both feet carry alike [m]."""
        (ax, ay), (bx, by) = self.under(one), self.under(other)
        return 0.5 * (ax + bx), 0.5 * (ay + by)

    def onwards(
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
        """Footholds of a walk from now on, and its reference.

        Args:
            feet: the foot that is about to swing and the one that carries in this footstep.
            landing: where the first is about to land.
            chain: how the footholds follow each other.
            timing: of every footstep to come.
            zmp: of now, while the weight goes over to the foot that carries [m].
            left: control ticks of that double support, none in single support, and of the
                single support after it [1].
            moving: whether more than closing the stance is wanted.

        Returns:
            x, y [m], yaw [rad] of each foothold from `landing` on, and 1 if it is a left one, 0 if
            not (n, 4); the reference.
        """
        steps, table = foothold_kernel.onwards(
            feet[0].row,
            feet[1].row,
            landing.row,
            chain,
            moving,
            zmp,
            (*left, timing.double, timing.single, self.stop),
            self.spot,
        )
        return steps, Ramps(table)
