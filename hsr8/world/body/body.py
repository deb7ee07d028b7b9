"""Protocol of the two robot bodies, physics and kinematic."""

from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.truth.saturation import Saturation
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
        """Read encoders, IMU and foot pads."""

    def setpoints(self, targets: JointTargets) -> NDArray[np.float64]:
        """Return the servo setpoints (n,) [rad]; as `targets` they have the same effect."""

    def apply(self, targets: JointTargets) -> None:
        """Advance one control tick towards `targets`."""

    def update_kinematics(self) -> None:
        """Update the poses in ``data`` from its state, for a camera."""

    def truth(self) -> Truth:
        """Return the ground truth now, with the contacts since the last call."""

    def saturation(self) -> Saturation | None:
        """Return the saturation of the servos so far; None without dynamics."""

    def state_bytes(self) -> bytes:
        """Return the state that determines the future of the world, for hashing."""
