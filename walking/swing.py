"""Swing foot: minimum jerk to a landing that may move, a smooth bump upwards."""

from walking.parameters import CONTROL_PERIOD


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


def lift_profile(phase: float) -> float:
    """Height of the swing foot as a share of the lift, at rest at both ends [1]."""
    bump = 4.0 * phase * (1.0 - phase)
    return bump * bump * bump
