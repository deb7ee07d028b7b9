"""Derived numbers of a robot, for people and for JSON."""

from typing import Any

import mujoco

from hsr8.robots.loaded import LoadedRobot


def facts(robot: LoadedRobot) -> dict[str, Any]:
    """Return the numbers of a robot; keys end in their units."""
    measures, parameters, sole = robot.model.measures(), robot.parameters, robot.model.sole
    hinge = mujoco.mjtJoint.mjJNT_HINGE
    return {
        "mass_kg": robot.model.mass,
        "leg_m": measures.leg,
        "hips_m": parameters.pattern.pelvis_height,
        "joints": sum(joint.type == hinge for joint in robot.spec.joints),
        "walking_joints": len(robot.model.names),
        "sole_m": [2.0 * sole.half_length, 2.0 * sole.half_width],
        "stance_m": 2.0 * parameters.gait.half_stance,
        "radius_m": robot.radius,
        "head": robot.roles.head is not None,
        "stiffened": robot.model.stiffening,
        "footstep_time_s": parameters.gait.footstep_time,
        "swing_height_m": parameters.gait.swing_height,
        "vx_mps": parameters.limits.vx,
        "vx_backward_mps": parameters.limits.vx_backward,
        "vy_mps": parameters.limits.vy,
        "wz_radps": parameters.limits.wz,
        "calibrated": robot.description.calibration is not None,
    }
