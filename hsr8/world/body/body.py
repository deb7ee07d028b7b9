"""The body the robot side drives: one protocol, two bodies (physics and kinematic)."""

from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.truth.truth import Truth
from walking.sensing import BodySensors
from walking.targets import JointTargets


class Body(Protocol):
    """A robot in its world, advanced one control tick at a time."""

    model: mujoco.MjModel
    data: mujoco.MjData

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    def sense(self) -> BodySensors:
        """Read the body's sensors now."""

    def set_points(self, targets: JointTargets) -> NDArray[np.float64]:
        """What the servos are told (26,) [rad]; given as `targets` again, the same happens."""

    def apply(self, targets: JointTargets) -> None:
        """Advance one control tick towards `targets`."""

    def update_kinematics(self) -> None:
        """Bring the poses in ``data`` up to date with its state, for a camera."""

    def truth(self) -> Truth:
        """State of the world now; contacts are those since the last call."""

    def state_bytes(self) -> bytes:
        """Everything that determines the future of the world, for hashing."""
