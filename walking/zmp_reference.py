"""What footholds ask of the ZMP."""

from math import cos, sin

from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.ramps import ZmpRamp
from walking.robot_model import Sole
from walking.state import Footstep
from walking.stride import Timing

Point = tuple[float, float]


class ZmpReference:
    """Places the ZMP under the feet that carry, and moves it from one to the other.

    Args:
        parameters: where the ZMP is meant to be in a sole, and how long a walk takes to end.
        sole: rectangle of the soles.

    Attributes:
        stop: control ticks of the last double support [1].
    """

    def __init__(self, parameters: WalkingParameters, sole: Sole) -> None:
        self._forward = sole.centre + parameters.pattern.zmp_forward
        self._inward = parameters.pattern.zmp_inward
        self.stop = max(1, round(parameters.gait.stop_time / CONTROL_PERIOD))

    def under(self, foot: Footstep) -> Point:
        """ZMP under a foot that carries alone [m]."""
        inward = -self._inward if foot.left else self._inward
        c, s = cos(foot.yaw), sin(foot.yaw)
        return (
            foot.x + c * self._forward - s * inward,
            foot.y + s * self._forward + c * inward,
        )

    def between(self, one: Footstep, other: Footstep) -> Point:
        """ZMP while both feet carry alike [m]."""
        (ax, ay), (bx, by) = self.under(one), self.under(other)
        return 0.5 * (ax + bx), 0.5 * (ay + by)

    def onwards(
        self, support: Footstep, steps: list[Footstep], timing: Timing, *, ends: bool
    ) -> list[ZmpRamp]:
        """Reference from the end of the single support on `support`.

        Args:
            support: foothold that carries until then.
            steps: footholds to come.
            timing: of every footstep.
            ends: whether the walk ends with both feet carrying alike after the last foothold.
        """
        ramps = []
        before, last = support, self.under(support)
        for step in steps[:-1] if ends else steps:
            point = self.under(step)
            ramps.append(ZmpRamp(timing.double, *last, *point, (before, step)))
            ramps.append(ZmpRamp(timing.single, *point, *point, (step, step)))
            before, last = step, point
        if ends:
            centre = self.between(before, steps[-1])
            ramps.append(ZmpRamp(self.stop, *last, *centre, (before, steps[-1])))
        return ramps
