"""Faults of body and floor in the physics: weak servos, slippery soles, bumps."""

from collections.abc import Sequence
from math import hypot

import mujoco

from hsr8.scenario.fault import Bump, Fault, LowFriction, ServoWeak
from hsr8.world.model.index import ModelIndex

TOUCHES = (3, 1)  # contype and conaffinity of what the robot touches
RULES = 1  # priority of the soles, so that their friction alone counts


class WorldFaults:
    """Sets what fails in a model, from the clock alone: the model is no part of a snapshot.

    Args:
        model: compiled world.
        index: addresses in it.
        faults: of the scenario; those of other parts are left to them.
    """

    def __init__(self, model: mujoco.MjModel, index: ModelIndex, faults: Sequence[Fault]) -> None:
        self._index = index
        self._weak = [f for f in faults if isinstance(f, ServoWeak)]
        self._slippery = [f for f in faults if isinstance(f, LowFriction)]
        bumps = [f for f in faults if isinstance(f, Bump)]
        self._bumps = list(zip(bumps, index.bumps, strict=True))
        self._any = bool(self._weak or self._slippery or self._bumps)
        self._placed = any(f.place is not None for f in self._slippery)
        self._torque = model.actuator_forcerange.copy()
        self._friction = [float(model.geom_friction[g, 0]) for g in index.foot_geoms]
        if self._slippery:
            model.geom_priority[list(index.foot_geoms)] = RULES

    def act(self, model: mujoco.MjModel, data: mujoco.MjData, tick: int) -> None:
        """Set what fails in control tick `tick`, which is about to be made."""
        if not self._any:
            return
        if self._weak:
            model.actuator_forcerange[:] = self._torque
            for weak in self._weak:
                if weak.acts(tick):
                    model.actuator_forcerange[self._index.actuators[weak.joints]] *= weak.magnitude
        for bump, geom in self._bumps:
            touches = TOUCHES if bump.acts(tick) else (0, 0)
            model.geom_contype[geom], model.geom_conaffinity[geom] = touches
        if self._placed:
            # Whether a camera has brought the poses up to date must not matter.
            mujoco.mj_kinematics(model, data)
        for side, geom in enumerate(self._index.foot_geoms):
            friction = self._friction[side]
            x, y, _ = data.geom_xpos[geom].tolist()
            for slip in self._slippery:
                if slip.acts(tick) and _within(slip, x, y):
                    friction = slip.magnitude
            if self._slippery:
                model.geom_friction[geom, 0] = friction


def _within(slip: LowFriction, x: float, y: float) -> bool:
    if slip.place is None:
        return True
    return hypot(x - slip.place[0], y - slip.place[1]) <= slip.reach
