"""Walking parameters that fit a robot: scaled, within all rules, rehearsed."""

import mujoco
import numpy as np

from hsr8.robots.file.description import RobotDescription
from hsr8.robots.file.key_mistake import KeyMistake, at_least, joint_error
from hsr8.robots.parts.skeleton import LEG_JOINTS, Posed
from hsr8.robots.walk.rehearsal import within_joints
from hsr8.robots.walk.rules import fit, one_leg_load
from walking.body.robot_model import RobotModel
from walking.constants import parameters_for
from walking.parameters import HeadParameters, WalkingParameters

HEAVY = 0.8  # torque on one leg that is worth a note, of its maximum [1]
STANDING = 1e-9  # maximum error of the legs in the ready posture [rad]
SLACK = 1e-6  # of joint limits [rad]
HEAD_SPEED = 0.8  # of the head joints, of their maximum [1]
HEAD_TORQUE = 0.5  # of a head joint that accelerates it; gravity and damping need the rest [1]


def fitted_parameters(
    robot: RobotModel, description: RobotDescription, source: str
) -> tuple[WalkingParameters, list[str]]:
    """Return the walking parameters of a robot, and notes; set its ready posture.

    Raises:
        ModelError: the robot cannot stand.
    """
    scaled = WalkingParameters() if description.tuned else parameters_for(robot)
    fitted = scaled if description.tuned else fit(robot, scaled)
    _stand(robot, fitted, description, source)
    strength = _strength(robot, fitted, description, source)
    if description.tuned:
        return fitted, strength
    known = None
    if description.calibration is not None:
        known = description.calibration.speed.model_dump()
        known["reach_side"] = known.pop("reach") * fitted.limits.reach_side
    parameters, notes = within_joints(robot, fitted, known)
    hips, before = parameters.pattern.pelvis_height, scaled.pattern.pelvis_height
    if hips != before:
        notes.insert(0, f"hips {before:.3f} -> {hips:.3f} m high")
    if robot.stiffening > 1.0:
        notes.insert(0, f"leg servos stiffened {robot.stiffening:.2f} times by feedback")
    return parameters, notes + strength


def head_limits(
    standing: Posed, robot: RobotModel, description: RobotDescription
) -> HeadParameters:
    """Return the limits of the head: as HSR-VIII, as far as its joints allow."""
    usual, model, tree = HeadParameters(), standing.model, robot.tree
    if tree.head is None or description.tuned:
        return usual
    matrix, head = np.zeros((model.nv, model.nv)), list(tree.head)
    mujoco.mj_fullM(model, standing.data, matrix)
    dofs = [int(model.joint(tree.names[k]).dofadr[0]) for k in head]
    rate = HEAD_SPEED * float(tree.speed[head].min())
    acceleration = HEAD_TORQUE * float((tree.effort[head] / matrix[dofs, dofs]).min())
    return HeadParameters(
        max_rate=description.head_rate or min(usual.max_rate, rate),
        max_acceleration=description.head_acceleration
        or float(f"{min(usual.max_acceleration, acceleration):.3g}"),
    )


def _stand(
    robot: RobotModel, parameters: WalkingParameters, description: RobotDescription, source: str
) -> None:
    """Set the ready posture and check that the legs reach it.

    Raises:
        ModelError: a foot is above the floor, or a joint outside its limits.
    """
    height = parameters.pattern.pelvis_height
    if robot.stand(height, parameters.gait.half_stance) > STANDING:
        raise KeyMistake(
            f"zero: the legs do not reach the floor in the ready posture, got hips at "
            f"{height:.3f} m; expected angles of straight legs, and soles below the ankles"
        )
    limits = zip(robot.names, robot.ready.tolist(), robot.tree.lower, robot.tree.upper, strict=True)
    for name, angle, lower, upper in list(limits)[: 2 * LEG_JOINTS]:
        if not lower - SLACK <= angle <= upper + SLACK:
            raise joint_error(
                name,
                "range",
                description,
                source,
                f"the ready posture is outside, got {angle:.3f} rad; expected {lower:.3g} to "
                f"{upper:.3g}",
            )


def _strength(
    robot: RobotModel, parameters: WalkingParameters, description: RobotDescription, source: str
) -> list[str]:
    """Check that each leg can carry the robot alone; return notes.

    Raises:
        ModelError: a joint is too weak.
    """
    loads = one_leg_load(robot, parameters.gait.half_stance, parameters.pattern.pelvis_height)
    worst = int(loads.argmax())
    load, name, effort = float(loads[worst]), robot.names[worst], robot.tree.effort[worst]
    if load > 1.0:
        raise joint_error(
            name,
            "effort",
            description,
            source,
            f"too weak to carry the robot on one leg, got a maximum torque of {effort:.3g} N m; "
            f"expected at least {at_least(load * effort)}: state effort, if that of the model is "
            "wrong",
        )
    return [f"{load:.0%} of the torque of {name} on one leg"] if load > HEAVY else []
