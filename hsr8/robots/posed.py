"""Robot model posed with its base at the origin."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco


@dataclass(frozen=True, slots=True, eq=False)
class Posed:
    """Compiled robot in a posture.

    Attributes:
        model: compiled robot.
        data: its state, with all places computed.
    """

    model: mujoco.MjModel
    data: mujoco.MjData

    @classmethod
    def at(cls, model: mujoco.MjModel, angles: Mapping[str, float], height: float = 0.0) -> "Posed":
        """Return a robot with its base level at a height [m] above the origin.

        Args:
            model: compiled robot, its free joint first.
            angles: of joints; zero by default [rad].
            height: of the base [m].
        """
        data = mujoco.MjData(model)
        data.qpos[:] = 0.0
        data.qpos[2:4] = height, 1.0
        for name, angle in angles.items():
            data.qpos[model.joint(name).qposadr[0]] = angle
        mujoco.mj_forward(model, data)
        return cls(model, data)
