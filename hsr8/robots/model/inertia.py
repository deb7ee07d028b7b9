"""Inertias of the bodies of a model file: completed where missing, refused where impossible."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.file.key_mistake import RepairableError
from hsr8.robots.parts.prepared import moving_body
from hsr8.robots.parts.skeleton import matrix_of, quaternion_of

Array = NDArray[np.float64]

MIN_MASS, MIN_GYRATION = 1e-8, 0.01  # of a moving body without mass: [kg], radius of gyration [m]
TOLERANCE = 1e-6  # of the triangle inequality, by the largest principal moment [1]
MAX_LISTED = 6  # bodies in a note
DENSITY = 1000.0  # of the ball whose inertia replaces an impossible one [kg/m³]


def complete_inertias(spec: mujoco.MjSpec, root: str, source: str, *, repair: bool) -> list[str]:
    """Check the stated inertias of a model, and complete them; return notes.

    A body that moves without a mass receives a negligible one.

    Args:
        spec: specification, changed in place.
        root: body with the free joint.
        source: file of the model, which begins the messages.
        repair: whether impossible inertias are replaced by that of a ball of equal mass.

    Raises:
        ModelError: inertias are impossible; the message lists all of them.
    """
    groups: dict[str, list[mujoco.MjsBody]] = {}
    for body in spec.bodies[1:]:
        if not (np.isfinite(body.mass) and body.mass >= 0.0):
            raise ModelError(
                f"{source}: body {body.name!r}: mass, got {body.mass:g} kg; expected 0 or more"
            )
        groups.setdefault(moving_body(body, root), []).append(body)
    inferred = spec.compiler.inertiafromgeom != mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    empty, wrong = list[str](), dict[str, Array]()
    for name, bodies in groups.items():
        heavy = [body for body in bodies if body.mass > 0.0 and body.explicitinertial]
        wrong |= _replace_impossible(heavy, name)
        if not heavy and not any(inferred and b.geoms and not b.explicitinertial for b in bodies):
            moments = np.full(3, MIN_MASS * MIN_GYRATION**2)
            _set(spec.body(name), MIN_MASS, np.zeros(3), moments, np.eye(3))
            empty.append(name)
    if wrong and not repair:
        raise RepairableError(f"{source}: {_refusal(wrong)}", repair_inertia=True)
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


def _replace_impossible(bodies: list[mujoco.MjsBody], moving: str) -> dict[str, Array]:
    """Replace the impossible inertias of bodies; return their moments.

    Args:
        bodies: bodies that move together.
        moving: that of them that has joints; the others may be points.
    """
    wrong = dict[str, Array]()
    for body in bodies:
        moments, axes = np.linalg.eigh(_tensor(body))
        if not moments.any() and body.name != moving:
            continue
        if not _possible(moments):
            wrong[body.name] = moments
            _set(body, float(body.mass), np.array(body.ipos), _ball(body.mass), np.eye(3))
        elif moments[0] + moments[1] < moments[2]:  # rounding of the file
            moments = moments + 2.0 * TOLERANCE * moments[2]
            _set(body, body.mass, body.ipos, moments, axes * np.sign(np.linalg.det(axes)))
    return wrong


def _possible(moments: Array) -> bool:
    """Return whether a rigid body can have principal moments in rising order (3,) [kg m²]."""
    smallest, middle, largest = moments.tolist()
    return (
        bool(np.isfinite(moments).all())
        and smallest > 0.0
        and (smallest + middle >= (1.0 - TOLERANCE) * largest)
    )


def _ball(mass: float) -> Array:
    """Return the principal moments of a ball of water of some mass (3,) [kg m²]."""
    radius = (0.75 * mass / (np.pi * DENSITY)) ** (1.0 / 3.0)
    return np.full(3, 0.4 * mass * radius**2)


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
