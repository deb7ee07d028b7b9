"""Prepared model, and the places of the links of its file in the bodies that move them."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.parts.skeleton import matrix_of

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """Link of a file in a prepared model.

    Attributes:
        body: body that it is a part of.
        pose: pose of its origin in that body (4, 4) [m].
    """

    body: str
    pose: Array


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Prepared model.

    Attributes:
        spec: MuJoCo model.
        root: body with the free joint.
        base: link of the base, a part of `root` or fixed to it.
        places: places of the links that are a part of another body, by name.
        held: reason of each joint that is held.
        held_above: those above each foot.
        notes: derived facts, a line each.
    """

    spec: mujoco.MjSpec
    root: str
    base: str
    places: Mapping[str, Place]
    held: Mapping[str, str]
    held_above: Mapping[str, tuple[str, ...]]
    notes: tuple[str, ...]

    def where(self, link: str) -> Place:
        """Return the place of a link of the file."""
        return self.places.get(link, Place(link, np.eye(4)))


def places_of(spec: mujoco.MjSpec, root: str) -> dict[str, Place]:
    """Return the place of every body below the root that has no joint, in the one that moves it."""
    places: dict[str, Place] = {}
    for body in spec.bodies[1:]:
        if body.joints or body.name == root:
            continue
        above = places.get(body.parent.name, Place(body.parent.name, np.eye(4)))
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = matrix_of(orientation(spec, body)), body.pos
        with np.errstate(invalid="ignore"):  # wrong numbers are reported later
            places[body.name] = Place(above.body, above.pose @ pose)
    return places


def orientation(spec: mujoco.MjSpec, body: mujoco.MjsBody) -> Array:
    """Return the stated orientation of a body in its parent, a quaternion (4,)."""
    if body.alt.type == mujoco.mjtOrientation.mjORIENTATION_QUAT:
        quat = np.array(body.quat, float)
        normalised: Array = quat / np.linalg.norm(quat)
        return normalised
    return np.array(
        mujoco.MjSpec.resolve_orientation(
            degree=bool(spec.compiler.degree),
            sequence=spec.compiler.eulerseq,
            orientation=body.alt,
        )
    )
