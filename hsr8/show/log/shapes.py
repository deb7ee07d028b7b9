"""Geoms of a model as Rerun shapes.

All geoms of one kind share an entity, and one row has all their poses, which costs a fifth of one
transform per body.
"""

from typing import Any

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from walking.model import Sole

Array = NDArray[np.float64]
Geoms = NDArray[np.intp]

_BOX, _CAPSULE, _CYLINDER, _ELLIPSOID = (
    int(mujoco.mjtGeom.mjGEOM_BOX),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE),
    int(mujoco.mjtGeom.mjGEOM_CYLINDER),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID),
)
_SPHERE = int(mujoco.mjtGeom.mjGEOM_SPHERE)
KINDS = {"boxes": (_BOX,), "capsules": (_CAPSULE,), "cylinders": (_CYLINDER,)} | {
    "ellipsoids": (_ELLIPSOID, _SPHERE)
}
ARCHETYPES: dict[str, Any] = {
    "boxes": rr.Boxes3D,
    "capsules": rr.Capsules3D,
    "cylinders": rr.Cylinders3D,
    "ellipsoids": rr.Ellipsoids3D,
}


def batches_of(model: mujoco.MjModel, chosen: NDArray[np.bool_]) -> dict[str, Geoms]:
    """Return the geoms in the mask `chosen` (ngeom,) by kind, without kinds that have none."""
    batches = {
        kind: np.flatnonzero(chosen & np.isin(model.geom_type, types))
        for kind, types in KINDS.items()
    }
    return {kind: geoms for kind, geoms in batches.items() if len(geoms)}


def shapes(model: mujoco.MjModel, kind: str, geoms: Geoms, **pose: Array) -> Any:
    """Return the Rerun archetype of geoms of a kind with sizes, colours and, if given, poses."""
    size = model.geom_size[geoms]
    style: dict[str, Any] = {
        "colors": colors(model, geoms),
        "fill_mode": rr.components.FillMode.Solid,
        **pose,
    }
    sizes: dict[str, Array] = {"lengths": 2.0 * size[:, 1], "radii": size[:, 0]}
    if kind == "boxes":
        sizes = {"half_sizes": size}
    if kind == "ellipsoids":
        spheres = model.geom_type[geoms] == _SPHERE
        sizes = {"half_sizes": np.where(spheres[:, None], size[:, :1], size)}
    return ARCHETYPES[kind](**sizes, **style)


def colors(model: mujoco.MjModel, geoms: NDArray[np.intp]) -> NDArray[np.uint8]:
    """Return the colours of geoms or of their materials (n, 4)."""
    rgba = np.array(model.geom_rgba[geoms])
    material = model.geom_matid[geoms]
    if (material >= 0).any():
        rgba[material >= 0] = model.mat_rgba[material[material >= 0]]
    result: NDArray[np.uint8] = np.round(255.0 * rgba).astype(np.uint8)
    return result


def sole_outline(sole: Sole) -> Array:
    """Return the outline of a sole in the frame of the foot (5, 2) [m]."""
    corners = np.array([(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)])
    outline: Array = (sole.centre, 0.0) + corners * (sole.half_length, sole.half_width)
    return outline


def raised(points: Array, height: float) -> Array:
    """Return points (n, 2) at a height (n, 3) [m]."""
    return np.column_stack([points, np.full(len(points), height)])


def poses(
    model: mujoco.MjModel, kind: str, geoms: Geoms, positions: Array, rotations: Array
) -> dict[str, Array]:
    """Return Rerun's components for n poses of m geoms of a kind.

    Args:
        model: compiled world.
        kind: boxes, capsules, cylinders or ellipsoids.
        geoms: ids (m,).
        positions: positions of all geoms (n, ngeom, 3) [m].
        rotations: quaternions w-x-y-z of all bodies (n, nbody, 4) [1].
    """
    position = positions[:, geoms]
    w, x, y, z = np.moveaxis(rotations[:, model.geom_bodyid[geoms]], 2, 0)
    a, b, c, d = model.geom_quat[geoms].T
    quaternion = np.stack(
        [
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
            w * a - x * b - y * c - z * d,
        ],
        axis=-1,
    )
    name = "centers"
    if kind == "capsules":
        # Rerun's capsule starts at its origin, MuJoCo's is centred there.
        x, y, z, w = np.moveaxis(quaternion, 2, 0)
        axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)
        position = position - model.geom_size[geoms, 1, None] * axis
        name = "translations"
    return {name: position.reshape(-1, 3), "quaternions": quaternion.reshape(-1, 4)}
