"""State of the linear inverted pendulum."""

from dataclasses import dataclass

from walking.arrays import Point
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

    @property
    def row(self) -> tuple[float, float, float, float, float, float]:
        """Row for kernels: all fields in order."""
        return self.x, self.y, self.vx, self.vy, self.zmp_x, self.zmp_y

    @property
    def zmp(self) -> Point:
        """ZMP of the last tick [m]."""
        return self.zmp_x, self.zmp_y

    def dcm(self, omega: float) -> Point:
        """Return the divergent component of motion [m] for ω [1/s]."""
        return self.x + self.vx / omega, self.y + self.vy / omega

    def step(self, lipm: Lipm, zmp: Point, region: SupportRegion) -> None:
        """Advance by a tick under a constant ZMP [m], clipped to a region."""
        px, py = region.clip(*zmp)
        self.x, self.vx = lipm.step(self.x, self.vx, px)
        self.y, self.vy = lipm.step(self.y, self.vy, py)
        self.zmp_x, self.zmp_y = px, py
