"""Geoms of the model as Rerun shapes: static scene, and batches for movers.

All geoms of one kind share an entity, and one row has all their poses, which costs a fifth of one
transform per body.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.robots.normal_form import HEAD_CAMERA
from hsr8.robots.shown import VISUAL_GROUPS
from hsr8.world.model.assembly import FIELD
from walking.body.sole import Sole

Array = NDArray[np.float64]

STATIC = {  # prefix of the names by entity; walls for the robot's camera are left out
    "/world/beacons": f"{FIELD}beacon",
    "/world/obstacles": f"{FIELD}obstacle",
    "/world/rim": f"{FIELD}rim",
    "/world/bumps": f"{FIELD}bump",
}
_BOX, _CAPSULE, _CYLINDER, _ELLIPSOID = (
    int(mujoco.mjtGeom.mjGEOM_BOX),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE),
    int(mujoco.mjtGeom.mjGEOM_CYLINDER),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID),
)
_SPHERE, _PLANE = int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_PLANE)
KINDS = {"boxes": (_BOX,), "capsules": (_CAPSULE,), "cylinders": (_CYLINDER,)} | {
    "ellipsoids": (_ELLIPSOID, _SPHERE)
}
FLOOR_COLOR = (206, 204, 198, 255)


@dataclass(frozen=True, slots=True)
class Batch:
    """Geoms of one kind.

    Attributes:
        kind: boxes, capsules, cylinders or ellipsoids.
        geoms: ids (n,).
    """

    kind: str
    geoms: NDArray[np.intp]


def batches_of(model: mujoco.MjModel, chosen: NDArray[np.bool_]) -> list[Batch]:
    """Return the geoms in the mask `chosen` (ngeom,), one batch per kind."""
    batches = []
    for kind, types in KINDS.items():
        geoms = np.flatnonzero(chosen & np.isin(model.geom_type, types))
        if len(geoms):
            batches.append(Batch(kind, geoms))
    return batches


def shapes(model: mujoco.MjModel, batch: Batch, **pose: Array) -> Any:
    """Return the Rerun archetype with sizes, colours and, if given, poses."""
    size = model.geom_size[batch.geoms]
    style: dict[str, Any] = {
        "colors": colors(model, batch.geoms),
        "fill_mode": rr.components.FillMode.Solid,
        **pose,
    }
    if batch.kind == "boxes":
        return rr.Boxes3D(half_sizes=size, **style)
    if batch.kind == "capsules":
        return rr.Capsules3D(lengths=2.0 * size[:, 1], radii=size[:, 0], **style)
    if batch.kind == "cylinders":
        return rr.Cylinders3D(lengths=2.0 * size[:, 1], radii=size[:, 0], **style)
    spheres = model.geom_type[batch.geoms] == _SPHERE
    return rr.Ellipsoids3D(half_sizes=np.where(spheres[:, None], size[:, :1], size), **style)


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


def _belongs(model: mujoco.MjModel, prefix: str) -> NDArray[np.bool_]:
    """Return the mask of geoms whose names begin with `prefix` (ngeom,)."""
    return np.array([model.geom(i).name.startswith(prefix) for i in range(model.ngeom)])


def poses(
    model: mujoco.MjModel, batch: Batch, positions: Array, rotations: Array
) -> dict[str, Array]:
    """Return Rerun's components for n poses of a batch of m geoms.

    Args:
        model: compiled world.
        batch: the geoms.
        positions: of all geoms (n, ngeom, 3) [m].
        rotations: quaternions w-x-y-z of all bodies (n, nbody, 4).
    """
    position = positions[:, batch.geoms]
    w, x, y, z = np.moveaxis(rotations[:, model.geom_bodyid[batch.geoms]], 2, 0)
    a, b, c, d = model.geom_quat[batch.geoms].T
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
    if batch.kind == "capsules":
        # Rerun's capsule starts at its origin, MuJoCo's is centred there.
        x, y, z, w = np.moveaxis(quaternion, 2, 0)
        axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)
        position = position - model.geom_size[batch.geoms, 1, None] * axis
        name = "translations"
    return {name: position.reshape(-1, 3), "quaternions": quaternion.reshape(-1, 4)}


class Scene:
    """Layer of the true world without the robot: static objects once, movers over time.

    Args:
        stream: recording.
        model: compiled world.
        extent: size of the floor along x and y [m].
    """

    def __init__(
        self, stream: BlockStream, model: mujoco.MjModel, extent: tuple[float, float]
    ) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        self._camera = model.camera(HEAD_CAMERA).id
        mujoco.mj_kinematics(model, self._data)
        visible = np.isin(model.geom_group, VISUAL_GROUPS) & (model.geom_type != _PLANE)
        mobile = model.body_mocapid[model.geom_bodyid] >= 0
        self._movers = batches_of(model, mobile & visible)
        self._mover_channel = Channel(stream, "/world/movers", rr.Cylinders3D)
        for batch in self._movers:
            stream.log("/world/movers", shapes(model, batch), static=True)
        for path, prefix in STATIC.items():
            self._log_static(stream, path, visible & ~mobile & _belongs(model, prefix))
        stream.log(
            "/world/floor",
            rr.Boxes3D(
                half_sizes=[[extent[0] / 2, extent[1] / 2, 0.005]],
                centers=[[0.0, 0.0, -0.006]],
                colors=[FLOOR_COLOR],
                fill_mode=rr.components.FillMode.Solid,
            ),
            static=True,
        )

    def _log_static(self, stream: BlockStream, path: str, chosen: NDArray[np.bool_]) -> None:
        for batch in batches_of(self._model, chosen):
            pose = poses(self._model, batch, self._data.geom_xpos[None], self._data.xquat[None])
            stream.log(f"{path}/{batch.kind}", shapes(self._model, batch, **pose), static=True)

    def add(self, times: Sequence[float], qpos: Array, movers: Array) -> tuple[Array, Array]:
        """Add n rows: times [s], configurations (n, nq), mover positions in W (n, m, 2) [m].

        Returns:
            True positions (n, 3) [m] and quaternions x-y-z-w (n, 4) of the head camera.
        """
        data = self._data
        positions, rotations = np.empty((len(qpos), 3)), np.empty((len(qpos), 4))
        for position, rotation, configuration in zip(positions, rotations, qpos, strict=True):
            data.qpos[:] = configuration
            mujoco.mj_kinematics(self._model, data)
            mujoco.mj_comPos(self._model, data)
            mujoco.mj_camlight(self._model, data)
            position[:] = data.cam_xpos[self._camera]
            mujoco.mju_mat2Quat(rotation, data.cam_xmat[self._camera])
        for batch in self._movers:
            centres = np.concatenate(movers)
            heights = np.full(len(centres), self._model.geom_size[batch.geoms[0], 1])
            self._mover_channel.add_rows(
                times, list(map(len, movers)), centers=np.column_stack([centres, heights])
            )
        return positions, rotations[:, [1, 2, 3, 0]]
