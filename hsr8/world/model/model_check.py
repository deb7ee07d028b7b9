"""What MuJoCo compiles without a word, though no robot can be meant by it."""

import mujoco
import numpy as np

FREE = int(mujoco.mjtJoint.mjJNT_FREE)
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


def require_sound(model: mujoco.MjModel) -> None:
    """See to it that numbers are finite, joints limited, and servos push towards their set-points.

    Raises:
        ValueError: they are not; it names the attribute, the part and the value.
    """
    for name in FINITE:
        if not np.isfinite(getattr(model, name)).all():
            raise ValueError(f"a number in {name} is not finite")
    for joint in (model.joint(i) for i in range(model.njnt)):
        who = f"joint {joint.name!r}"
        if joint.type[0] != FREE and not model.jnt_limited[joint.id]:
            raise ValueError(f"{who}: range must rise, it is {_told(joint.range)}")
        for name in ("armature", "damping", "frictionloss"):
            value = getattr(joint, name)
            if (value < 0.0).any():
                raise ValueError(f"{who}: {name} must not be negative, it is {_told(value)}")
    for servo in (model.actuator(i) for i in range(model.nu)):
        who = f"actuator {servo.name!r}"
        if not model.actuator_forcelimited[servo.id]:
            raise ValueError(f"{who}: forcerange must rise, it is {_told(servo.forcerange)}")
        if servo.gainprm[0] <= 0.0:
            raise ValueError(f"{who}: kp must be positive, it is {_told(servo.gainprm[:1])}")


def _told(values: np.ndarray) -> str:
    return " ".join(f"{value:g}" for value in values.ravel())
