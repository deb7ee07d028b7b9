"""Reading of MJCF files: one robot whose bodies and joints all have names."""

from pathlib import Path

import mujoco
import numpy as np

from hsr8.robots.skeleton import root_of


def read_mjcf(file: Path, foot: str = "") -> mujoco.MjSpec:
    """Read an MJCF file; other bodies that move are left out.

    Bodies and joints without a name get one, such as ``body_7``.

    Args:
        file: MJCF file.
        foot: body of the robot; default: the robot with most joints.

    Raises:
        ValueError: MuJoCo cannot compile it.
    """
    model = mujoco.MjModel.from_xml_path(str(file))  # a copy of a specification loses wrong names
    spec = mujoco.MjSpec.from_file(str(file))
    _name_parts(spec)
    if len(np.unique(model.body_rootid[model.jnt_bodyid])) > 1:
        _drop_others(spec, foot)
    return spec


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
