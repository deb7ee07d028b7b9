"""State of the linear inverted pendulum."""

from dataclasses import dataclass

from walking.pattern.lipm import Lipm
from walking.pattern.support import SupportRegion


@dataclass(slots=True)
class PendulumState:
    """State of the pendulum in the plan frame.

    Attributes:
        x, y: position [m].
        vx, vy: velocity [m/s].
        zmp_x, zmp_y: ZMP of the last tick [m].
    """

    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    zmp_x: float = 0.0
    zmp_y: float = 0.0

    def step(self, lipm: Lipm, zmp: tuple[float, float], region: SupportRegion) -> None:
        """Advance by a tick under a constant ZMP [m], clipped to a region."""
        px, py = region.clip(*zmp)
        self.x, self.vx = lipm.step(self.x, self.vx, px)
        self.y, self.vy = lipm.step(self.y, self.vy, py)
        self.zmp_x, self.zmp_y = px, py
