"""Sanity checks for models that MuJoCo accepts but that are not valid robots."""

import mujoco
import numpy as np

FINITE = (
    "body_pos",
    "body_mass",
    "body_inertia",
    "jnt_range",
    "geom_size",
    "geom_friction",
    "dof_armature",
    "dof_damping",
    "dof_frictionloss",
    "actuator_gainprm",
    "actuator_forcerange",
)


def check_model(model: mujoco.MjModel) -> None:
    """Check that numbers are finite and servo gains positive.

    Raises:
        ValueError: a check failed; the message names the part, the attribute and the value.
    """
    for name in FINITE:
        if not np.isfinite(getattr(model, name)).all():
            raise ValueError(f"{name}: a value is not finite")
    for servo in (model.actuator(i) for i in range(model.nu)):
        who = f"actuator {servo.name!r}"
        if servo.gainprm[0] <= 0.0:
            raise ValueError(f"{who}: kp: got {servo.gainprm[0]:g}; expected > 0")
