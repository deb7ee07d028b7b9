"""Reading of MJCF files: one robot whose bodies and joints all have names."""

from pathlib import Path

import mujoco
import numpy as np

from hsr8.robots.skeleton import label, root_of

MIN_STEP = 1e-5  # of the physics [s]
MAX_OFFSET = 5.0  # of a body from the one that carries it [m]


def read_mjcf(file: Path, foot: str = "") -> mujoco.MjSpec:
    """Read an MJCF file; other bodies that move are left out.

    Bodies and joints without a name get one, such as ``body_7``.

    Args:
        file: MJCF file.
        foot: body of the robot; default: the robot with most joints.

    Raises:
        ValueError: MuJoCo cannot compile it, or a number is not that of a robot.
    """
    model = mujoco.MjModel.from_xml_path(str(file))  # a copy of a specification loses wrong names
    _check_numbers(model)
    spec = mujoco.MjSpec.from_file(str(file))
    _name_parts(spec)
    if len(np.unique(model.body_rootid[model.jnt_bodyid])) > 1:
        _drop_others(spec, foot)
    return spec


def _check_numbers(model: mujoco.MjModel) -> None:
    """Refuse numbers that MuJoCo compiles although they are not those of a robot."""
    step = float(model.opt.timestep)
    if not step >= MIN_STEP:
        raise ValueError(f"option: timestep, got {step:g} s; expected at least {MIN_STEP:g}")
    bodies = [f"body {label(model.body(b).name, b)!r}" for b in range(model.nbody)]
    joints = [f"joint {label(model.joint(j).name, j)!r}" for j in range(model.njnt)]
    dofs = [joints[j] for j in model.dof_jntid]
    for names, kind, keys in (
        (bodies, "body", ("pos", "quat", "ipos")),
        (joints, "jnt", ("pos", "axis", "range", "stiffness")),
        (dofs, "dof", ("damping", "armature", "frictionloss")),
    ):
        for key in keys:
            rows = np.atleast_2d(getattr(model, f"{kind}_{key}").T).T
            for name, values in zip(names, rows, strict=True):
                got = " ".join(f"{value:g}" for value in values)
                if not np.isfinite(values).all():
                    raise ValueError(f"{name}: {key}, got {got}; expected finite numbers")
                if (kind == "dof" or key == "stiffness") and values.min() < 0.0:
                    raise ValueError(f"{name}: {key}, got {got}; expected >= 0")
    for body in range(1, model.nbody):
        distance = float(np.abs(model.body_pos[body]).max())
        if model.body_parentid[body] and distance > MAX_OFFSET:
            raise ValueError(
                f"{bodies[body]}: {distance:g} m from the body that carries it; expected at most "
                f"{MAX_OFFSET:g}"
            )


def _name_parts(spec: mujoco.MjSpec) -> None:
    """Name the bodies and the hinge joints that have no name."""
    for kind, parts in (("body", spec.bodies), ("joint", spec.joints)):
        names = {part.name for part in parts}
        for number, part in enumerate(parts):
            if not part.name and getattr(part, "type", None) != mujoco.mjtJoint.mjJNT_FREE:
                name = f"{kind}_{number}"
                part.name = name if name not in names else f"unnamed_{name}"


def _drop_others(spec: mujoco.MjSpec, foot: str) -> None:
    """Remove bodies that move and do not belong to the robot."""
    model = spec.copy().compile()
    names = {model.body(b).name for b in range(model.nbody)}
    root = int(model.body_rootid[model.body(foot).id]) if foot in names else root_of(model)
    moving = {model.body(b).name for b in model.body_rootid[model.jnt_bodyid] if b != root}
    for parts in (spec.keys, spec.sensors):
        for part in list(parts):
            spec.delete(part)
    for body in list(spec.worldbody.bodies):
        if body.name in moving:
            spec.delete(body)
