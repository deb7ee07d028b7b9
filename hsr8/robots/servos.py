"""Choice of the position servos of a robot: those of its model, or by rule."""

import mujoco

from hsr8.robots.description import RobotDescription, ServoRule
from hsr8.robots.mechanism_checks import is_position_servo, joint_actuators
from hsr8.robots.normal_form import physics_step
from hsr8.robots.roles import Roles
from hsr8.robots.servo_rule import add_servos


def choose_servos(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    roles: Roles,
    description: RobotDescription,
    sole_height: float,
) -> tuple[str, ...]:
    """Add servos by rule where the description asks for it or the legs have none; return notes.

    Args:
        spec: changed in place.
        model: compiled from `spec`.
        roles: of the robot's parts.
        description: of the robot.
        sole_height: height of the soles above the base, with straight legs; negative [m].
    """
    stated = description.servo
    if stated == "own" or (stated is None and _has_servos(model, roles)):
        return ("servos of the model",)
    return add_servos(
        spec,
        roles.legs,
        sole_height=sole_height,
        posture={**description.posture, **description.zero},
        rule=stated if isinstance(stated, ServoRule) else ServoRule(),
        effort=description.effort,
        speed=description.speed,
        timestep=physics_step(float(spec.option.timestep)),
    )


def _has_servos(model: mujoco.MjModel, roles: Roles) -> bool:
    """Return whether every leg joint has a position servo."""
    return all(
        any(is_position_servo(model, a) for a in joint_actuators(model, model.joint(name).id))
        for leg in roles.legs
        for name in leg
    )
