"""World faults: weak servos, low friction and bumps on the floor."""

from collections.abc import Sequence
from math import hypot

import mujoco

from hsr8.scenario.fault import Bump, Fault, LowFriction, ServoWeak
from hsr8.world.model.index import ModelIndex

COLLIDES = (3, 1)  # contype and conaffinity of geoms that collide with the robot
SOLE_PRIORITY = 1  # so that the friction of the soles alone counts


class WorldFaults:
    """Applies world faults to a model.

    Args:
        model: compiled world.
        index: addresses in it.
        faults: of the scenario; faults of other parts are ignored.
        scale: of the world [1].
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        index: ModelIndex,
        faults: Sequence[Fault],
        scale: float = 1.0,
    ) -> None:
        self._scale = scale
        self._index = index
        self._weak = [f for f in faults if isinstance(f, ServoWeak)]
        self._low_friction = [f for f in faults if isinstance(f, LowFriction)]
        bumps = [f for f in faults if isinstance(f, Bump)]
        self._bumps = list(zip(bumps, index.bumps, strict=True))
        self._any = bool(self._weak or self._low_friction or self._bumps)
        self._local = any(f.position is not None for f in self._low_friction)
        self._torque = model.actuator_forcerange.copy(), model.jnt_actfrcrange.copy()
        self._joints = model.dof_jntid[index.joint_dof]
        self._friction = [float(model.geom_friction[g, 0]) for g in index.foot_geoms]
        if self._low_friction:
            model.geom_priority[list(index.foot_geoms)] = SOLE_PRIORITY

    def apply_fault(self, model: mujoco.MjModel, data: mujoco.MjData, tick: int) -> None:
        """Apply the faults of control tick `tick` before it is simulated."""
        if not self._any:
            return
        if self._weak:
            model.actuator_forcerange[:], model.jnt_actfrcrange[:] = self._torque
            for weak in self._weak:
                if weak.acts(tick):
                    joints = weak.joints(self._index.names)
                    model.actuator_forcerange[self._index.actuators[joints]] *= weak.magnitude
                    model.jnt_actfrcrange[self._joints[joints]] *= weak.magnitude
        for bump, geom in self._bumps:
            mask = COLLIDES if bump.acts(tick) else (0, 0)
            model.geom_contype[geom], model.geom_conaffinity[geom] = mask
        if self._local:
            # The result must not depend on an update of the poses by a camera.
            mujoco.mj_kinematics(model, data)
        for side, geom in enumerate(self._index.foot_geoms):
            friction = self._friction[side]
            x, y, _ = data.geom_xpos[geom].tolist()
            for slip in self._low_friction:
                if slip.acts(tick) and _within(slip, x, y, self._scale):
                    friction = slip.magnitude
            if self._low_friction:
                model.geom_friction[geom, 0] = friction


def _within(slip: LowFriction, x: float, y: float, scale: float) -> bool:
    if slip.position is None:
        return True
    return hypot(x - slip.position[0], y - slip.position[1]) <= slip.reach(scale)
