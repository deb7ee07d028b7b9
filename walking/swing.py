"""Swing foot: minimum jerk to a landing that may move, a smooth bump upwards."""

from math import ceil, hypot

from walking.parameters import CONTROL_PERIOD
from walking.state import Footstep

PEAK = 1.875  # of the speed of a minimum-jerk motion over its mean [1]
ROUNDING = 1e-7  # of a landing that another one is one move away from, of the move [1]


class MinimumJerk:
    """One coordinate driven to a target with rest at arrival, replanned every tick.

    Flash & Hogan, J. Neurosci. 1985: the quintic from the present position, velocity and
    acceleration; following it for one tick and replanning is the same motion while the
    target stays.

    Args:
        position: start, at rest [m or rad].
    """

    __slots__ = ("acceleration", "position", "velocity")

    def __init__(self, position: float) -> None:
        self.position = position
        self.velocity = 0.0
        self.acceleration = 0.0

    def rest(self, position: float) -> None:
        """Stand at `position`."""
        self.position = position
        self.velocity = self.acceleration = 0.0

    def advance(self, target: float, ticks_left: int) -> None:
        """Move one tick towards `target`, due `ticks_left` ticks from now."""
        if ticks_left <= 1:
            self.rest(target)
            return
        time = ticks_left * CONTROL_PERIOD
        e = target - self.position
        v, a = self.velocity * time, self.acceleration * time * time
        c3 = 10.0 * e - 6.0 * v - 1.5 * a
        c4 = -15.0 * e + 8.0 * v + 1.5 * a
        c5 = 6.0 * e - 3.0 * v - 0.5 * a
        s = 1.0 / ticks_left
        self.position += s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5))))
        self.velocity = (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time
        self.acceleration = (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (time * time)


class FootReference:
    """Reference of one foot in the plan frame: on the floor, or on its way.

    Attributes:
        x, y, yaw: horizontal coordinates, each with its rate [m, m, rad].
        height: of the sole above the floor [m].
    """

    __slots__ = ("height", "x", "y", "yaw")

    def __init__(self, foothold: Footstep) -> None:
        self.x = MinimumJerk(foothold.x)
        self.y = MinimumJerk(foothold.y)
        self.yaw = MinimumJerk(foothold.yaw)
        self.height = 0.0

    @property
    def row(self) -> tuple[float, float, float, float]:
        """As compiled code has it: x, y, yaw, height."""
        return self.x.position, self.y.position, self.yaw.position, self.height

    def stand(self, foothold: Footstep) -> None:
        """Rest on a foothold."""
        self.x.rest(foothold.x)
        self.y.rest(foothold.y)
        self.yaw.rest(foothold.yaw)

    def advance(self, landing: Footstep, ticks_left: int) -> None:
        """Move one tick towards the landing."""
        self.x.advance(landing.x, ticks_left)
        self.y.advance(landing.y, ticks_left)
        self.yaw.advance(landing.yaw, ticks_left)


def least_ticks(foot: FootReference, landing: Footstep, speed: float) -> int:
    """Control ticks of a swing from rest to `landing` that peaks at `speed` [m/s]."""
    way = hypot(landing.x - foot.x.position, landing.y - foot.y.position)
    return ceil(PEAK * way / (speed * CONTROL_PERIOD))


def lift_profile(phase: float) -> float:
    """Height of the swing foot as a share of the lift, at rest at both ends [1]."""
    bump = 4.0 * phase * (1.0 - phase)
    return bump * bump * bump


def moved(landing: Footstep, wanted: Footstep, most: float, turn: float) -> Footstep:
    """A landing moved towards another one.

    By no more than `most` along x and y [m], and by no more than `turn` [rad]; place and
    direction change together, so that the foot stays clear of the other one.
    """
    dx, dy, turned = wanted.x - landing.x, wanted.y - landing.y, wanted.yaw - landing.yaw
    largest = max(abs(dx) / most, abs(dy) / most, abs(turned) / turn)
    if largest <= 1.0 + ROUNDING:
        return wanted
    share = 1.0 / largest
    return Footstep(
        left=wanted.left,
        x=landing.x + share * dx,
        y=landing.y + share * dy,
        yaw=landing.yaw + share * turned,
    )
