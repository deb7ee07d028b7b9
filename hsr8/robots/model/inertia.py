"""Inertias of the bodies of a model file: completed where missing, refused where impossible."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.file.key_mistake import RepairableError
from hsr8.robots.file.read import ModelFile
from hsr8.robots.parts.places import Place
from hsr8.robots.parts.skeleton import matrix_of, quaternion_of

Array = NDArray[np.float64]

MIN_MASS, MIN_GYRATION = 1e-8, 0.01  # of a moving body without mass: [kg], radius of gyration [m]
TOLERANCE = 1e-6  # of the triangle inequality, by the largest principal moment [1]
ROUNDING = 1e-9  # of it, in a body that is not fused [1]
MAX_LISTED = 6  # bodies in a note
DENSITY = 1000.0  # of the ball whose inertia replaces an impossible one [kg/m³]


def complete_inertias(
    spec: mujoco.MjSpec, places: Mapping[str, Place], source: ModelFile, *, repair: bool
) -> list[str]:
    """Check the stated inertias of a model, and complete them; return notes.

    Those of links in a URDF file are moved to the body that they will be a part of. A body that
    moves without a mass receives a negligible one.

    Args:
        spec: specification, changed in place.
        places: places of the bodies without joints.
        source: file of the model.
        repair: whether impossible inertias are replaced by that of a ball of equal mass.

    Raises:
        ModelError: inertias are impossible; the message lists all of them.
    """
    groups: dict[str, list[mujoco.MjsBody]] = {}
    for body in spec.bodies[1:]:
        if not (np.isfinite(body.mass) and body.mass >= 0.0):
            raise ModelError(
                f"{source.file}: body {body.name!r}: mass, got {body.mass:g} kg; expected 0 or more"
            )
        carrier = places[body.name].body if body.name in places else body.name
        groups.setdefault(carrier, []).append(body)
    empty, wrong = list[str](), dict[str, Array]()
    for name, bodies in groups.items():
        heavy = [body for body in bodies if body.mass > 0.0 and body.explicitinertial]
        if source.is_urdf and heavy:
            wrong |= _fuse(spec.body(name), bodies, heavy, places)
        elif heavy:
            wrong |= _replace_impossible(heavy)
        elif source.is_urdf or not any(b.geoms and not b.explicitinertial for b in bodies):
            moments = np.full(3, MIN_MASS * MIN_GYRATION**2)
            _set(spec.body(name), MIN_MASS, np.zeros(3), moments, np.eye(3))
            empty.append(name)
    if wrong and not repair:
        raise RepairableError(f"{source.file}: {_refusal(wrong)}", repair_inertia=True)
    notes = []
    if empty:
        names = ", ".join(empty[:MAX_LISTED])
        notes.append(f"{len(empty)} bodies without mass, given {MIN_MASS:g} kg: {names}")
    if wrong:
        names = ", ".join(wrong)
        notes.append(f"{len(wrong)} impossible inertias replaced by that of a ball: {names}")
    return notes


def _refusal(wrong: Mapping[str, Array]) -> str:
    """Return the message about bodies with impossible principal moments (3,) [kg m²]."""
    listed = ", ".join(
        f"{name!r} ({' '.join(f'{moment:.3g}' for moment in moments)})"
        for name, moments in wrong.items()
    )
    one = len(wrong) == 1
    return (
        f"impossible {'inertia' if one else 'inertias'}, got {len(wrong)} "
        f"{'body' if one else 'bodies'} with principal moments [kg m²] {listed}; expected positive "
        "moments, each at most the sum of the others: correct <inertial>, or state "
        "repair_inertia = true"
    )


def _fuse(
    carrier: mujoco.MjsBody,
    bodies: list[mujoco.MjsBody],
    heavy: list[mujoco.MjsBody],
    places: Mapping[str, Place],
) -> dict[str, Array]:
    """Move the masses of bodies to their carrier; return impossible moments by the heaviest."""
    mass, com, inertia = _fused(heavy, places)
    moments, axes = np.linalg.eigh(inertia)
    wrong = {}
    if not _possible(moments, TOLERANCE):
        wrong[max(heavy, key=lambda body: float(body.mass)).name] = moments
        moments = _ball(mass)
    if moments[0] + moments[1] < moments[2] * (1.0 + TOLERANCE):  # rounding of the file
        moments = moments + 2.0 * TOLERANCE * moments[2]
    for body in bodies:
        body.mass, body.explicitinertial = 0.0, False
    _set(carrier, mass, com, moments, axes * np.sign(np.linalg.det(axes)))
    return wrong


def _replace_impossible(bodies: list[mujoco.MjsBody]) -> dict[str, Array]:
    """Replace the impossible inertias of bodies; return their moments."""
    wrong = dict[str, Array]()
    for body in bodies:
        moments = np.asarray(np.linalg.eigvalsh(_tensor(body)), float)
        if not _possible(moments, ROUNDING):
            wrong[body.name] = moments
            _set(body, float(body.mass), np.array(body.ipos), _ball(body.mass), np.eye(3))
    return wrong


def _possible(moments: Array, tolerance: float) -> bool:
    """Return whether a rigid body can have principal moments in rising order (3,) [kg m²]."""
    smallest, middle, largest = moments.tolist()
    return (
        bool(np.isfinite(moments).all())
        and smallest > 0.0
        and (smallest + middle >= (1.0 - tolerance) * largest)
    )


def _ball(mass: float) -> Array:
    """Return the principal moments of a ball of water of some mass (3,) [kg m²]."""
    radius = (0.75 * mass / (np.pi * DENSITY)) ** (1.0 / 3.0)
    return np.full(3, 0.4 * mass * radius**2)


def _fused(bodies: list[mujoco.MjsBody], places: Mapping[str, Place]) -> tuple[float, Array, Array]:
    """Return mass [kg], centre of mass (3,) [m] and inertia (3, 3) [kg m²] of fused bodies."""
    poses = [places[b.name].pose if b.name in places else np.eye(4) for b in bodies]
    masses = np.array([b.mass for b in bodies], float)
    coms = np.array(
        [pose[:3, :3] @ b.ipos + pose[:3, 3] for b, pose in zip(bodies, poses, strict=True)]
    )
    com = masses @ coms / masses.sum()
    inertia = np.zeros((3, 3))
    for body, pose, mass, away in zip(bodies, poses, masses, coms - com, strict=True):
        turn = pose[:3, :3]
        inertia += turn @ _tensor(body) @ turn.T
        inertia += mass * (away @ away * np.eye(3) - np.outer(away, away))
    return float(masses.sum()), com, inertia


def _tensor(body: mujoco.MjsBody) -> Array:
    """Return the stated inertia of a body, in its directions (3, 3) [kg m²]."""
    xx, yy, zz, xy, xz, yz = np.array(body.fullinertia).tolist()
    local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if not np.isfinite(xx):
        local = np.diag(np.array(body.inertia))
    quat = np.array(body.iquat, float)
    rotation = matrix_of(quat / np.linalg.norm(quat))
    tensor: Array = rotation @ local @ rotation.T
    return tensor


def _set(body: mujoco.MjsBody, mass: float, com: Array, moments: Array, axes: Array) -> None:
    """State the inertia of a body: principal moments (3,) [kg m²] about the columns of axes."""
    body.mass, body.ipos, body.iquat, body.inertia = mass, com, quaternion_of(axes), moments
    body.fullinertia = np.full(6, np.nan)
    body.ialt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
    body.explicitinertial = True
