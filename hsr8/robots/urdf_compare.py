"""Comparison of a converted robot with its URDF file as Pinocchio reads it."""

from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from hsr8.errors import ModelError

Array = NDArray[np.float64]
MASS_TOLERANCE = 1e-6  # relative
LENGTH_TOLERANCE = 1e-5  # [m]


def compare_with_file(
    model: mujoco.MjModel, file: Path, base: str, rotation: Array, held: Mapping[str, float]
) -> None:
    """Compare mass, CoM and joint origins of a model with the file that it was made from.

    CoM and origins are compared in the base at zero angles, and with every joint off its zero so
    that the axes count, too.

    Args:
        model: the converted robot; its first joint frees the base.
        file: URDF file.
        base: link whose origin is that of the base.
        rotation: from the directions of that link to those of the base, shape (3, 3).
        held: angles of the joints that the model lacks [rad or m].

    Raises:
        ModelError: Pinocchio cannot read the file, or a quantity differs.
    """
    try:
        raw = pin.buildModelFromXML(_mechanism(file), pin.JointModelFreeFlyer())
    except (ValueError, RuntimeError, OSError, ElementTree.ParseError) as error:
        raise ModelError(f"{file}: Pinocchio cannot read it: {error}") from error
    mass, raw_mass = float(model.body_mass.sum()), float(pin.computeTotalMass(raw))
    if abs(mass - raw_mass) > MASS_TOLERANCE * raw_mass:
        raise ModelError(
            f"{file}: mass changed in conversion, got {mass:.6f} kg; expected {raw_mass:.6f} kg"
        )
    ranges = {model.joint(k).name: model.jnt_range[k] for k in range(1, model.njnt)}
    off_zero = {name: 0.3 * low + 0.7 * high for name, (low, high) in ranges.items()}
    for angles in (dict.fromkeys(ranges, 0.0), off_zero):
        expected = _raw_positions(raw, base, rotation, {**held, **angles})
        for name, position in _positions(model, angles).items():
            error_size = float(np.abs(position - expected[name]).max())
            if error_size > LENGTH_TOLERANCE:
                quantity = f"origin of joint '{name}'" if name else "CoM"
                raise ModelError(
                    f"{file}: {quantity} changed in conversion by {error_size:.2g} m, got "
                    f"{np.round(position, 6).tolist()} m; expected "
                    f"{np.round(expected[name], 6).tolist()} m"
                )


def _mechanism(file: Path) -> str:
    """Text of the links and joints only; Pinocchio refuses some limits and shapes."""
    robot = ElementTree.fromstring(file.read_bytes())
    for element in list(robot):
        if element.tag not in ("link", "joint"):
            robot.remove(element)
        for part in list(element):
            if part.tag in ("visual", "collision"):
                element.remove(part)
            elif part.tag == "limit":
                part.attrib.update(effort="1", velocity="1")
    return ElementTree.tostring(robot, encoding="unicode")


def _positions(model: mujoco.MjModel, angles: Mapping[str, float]) -> dict[str, Array]:
    """Joint origins and, under an empty name, the CoM in the base, shape (3,) [m]."""
    data = mujoco.MjData(model)
    mujoco.mj_resetData(model, data)
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    base = int(model.jnt_bodyid[0])
    points = {name: data.xanchor[model.joint(name).id] for name in angles}
    points[""] = data.subtree_com[base]
    turn = data.xmat[base].reshape(3, 3)
    return {name: turn.T @ (point - data.xpos[base]) for name, point in points.items()}


def _raw_positions(
    raw: pin.Model, base: str, rotation: Array, angles: Mapping[str, float]
) -> dict[str, Array]:
    """CoM (under an empty name) and joint origins in the base, of the file, shape (3,) [m]."""
    step = np.zeros(raw.nv)
    for name, angle in angles.items():
        step[raw.idx_vs[raw.getJointId(name)]] = angle
    q = pin.integrate(raw, pin.neutral(raw), step)
    data = raw.createData()
    pin.framesForwardKinematics(raw, data, q)
    frame = data.oMf[raw.getFrameId(base, pin.BODY)]
    points = {"": pin.centerOfMass(raw, data, q)}
    points |= {name: data.oMi[raw.getJointId(name)].translation for name in angles}
    return {name: rotation @ frame.actInv(np.array(point)) for name, point in points.items()}
