"""Robot in the log: its primitive shapes in batches, its meshes per rigid part."""

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.shown import VISUAL_GROUPS, visual_model
from hsr8.show.log.shapes import ARCHETYPES, batches_of, colors, poses, shapes
from hsr8.show.log.stream import LogStream

Array = NDArray[np.float64]

ROOT = "/world/robot"
_MESH = int(mujoco.mjtGeom.mjGEOM_MESH)


class RobotShapes:
    """Visual shapes of the robot.

    Args:
        log: recording, which receives the shapes.
        robot: robot to draw.
    """

    def __init__(self, log: LogStream, robot: LoadedRobot) -> None:
        self._model = model = visual_model(robot)
        self._data = mujoco.MjData(model)
        visible = np.isin(model.geom_group, VISUAL_GROUPS) & (model.geom_bodyid > 0)
        self._batches = batches_of(model, visible)
        for kind, geoms in self._batches.items():
            log.log(f"{ROOT}/{kind}", shapes(model, kind, geoms), static=True)
        parts = model.body_weldid[model.geom_bodyid]
        meshes = visible & (model.geom_type == _MESH)
        self._parts = np.unique(parts[meshes])
        mujoco.mj_kinematics(model, self._data)
        for part in self._parts.tolist():
            mesh = mesh_of(model, self._data, part, np.flatnonzero(meshes & (parts == part)))
            log.log(part_path(model, part), mesh, static=True)

    def log(self, log: LogStream, times: Array, qpos: Array) -> None:
        """Log n rows: times [s], configurations (n, nq)."""
        data, n = self._data, len(times)
        positions = np.empty((n, self._model.ngeom, 3))
        part_positions = np.empty((n, len(self._parts), 3))
        rotations = np.empty((n, self._model.nbody, 4))
        for row, configuration in enumerate(qpos):
            data.qpos[:] = configuration
            mujoco.mj_kinematics(self._model, data)
            positions[row], rotations[row] = data.geom_xpos, data.xquat
            part_positions[row] = data.xpos[self._parts]
        for kind, geoms in self._batches.items():
            counts = np.full(n, len(geoms))
            columns = poses(self._model, kind, geoms, positions, rotations)
            log.rows(f"{ROOT}/{kind}", ARCHETYPES[kind], times, counts, **columns)
        part_rotations = rotations[:, self._parts][..., [1, 2, 3, 0]]
        for k, part in enumerate(self._parts.tolist()):
            log.rows(
                part_path(self._model, part),
                rr.Transform3D,
                times,
                translation=part_positions[:, k],
                quaternion=part_rotations[:, k],
            )


def followed_entity(model: mujoco.MjModel, base: str) -> str:
    """Return the entity of a robot that views follow: the part of the base, else a batch."""
    meshes = (model.geom_type == _MESH) & np.isin(model.geom_group, VISUAL_GROUPS)
    parts = np.unique(model.body_weldid[model.geom_bodyid[meshes]])
    if len(parts):
        part = int(model.body_weldid[model.body(base).id])
        return part_path(model, part if part in parts else int(parts[0]))
    kinds = [*batches_of(model, np.isin(model.geom_group, VISUAL_GROUPS))]
    return f"{ROOT}/{'ellipsoids' if 'ellipsoids' in kinds or not kinds else kinds[0]}"


def part_path(model: mujoco.MjModel, body: int) -> str:
    """Return the entity of the rigid part of a body."""
    return f"{ROOT}/{rr.escape_entity_path_part(model.body(body).name or f'part {body}')}"


def mesh_of(
    model: mujoco.MjModel, data: mujoco.MjData, part: int, geoms: NDArray[np.intp]
) -> rr.Mesh3D:
    """Return the meshes of a rigid part as one mesh in the frame of its body.

    Args:
        model: model of the robot.
        data: state of the robot with positions of all bodies and geoms.
        part: body id of the rigid part.
        geoms: ids of the mesh geoms of the part (n,).
    """
    frame, origin = data.xmat[part].reshape(3, 3), data.xpos[part]
    corners, normals, triangles, count = [], [], [], 0
    for geom in geoms.tolist():
        turn = frame.T @ data.geom_xmat[geom].reshape(3, 3)
        offset = frame.T @ (data.geom_xpos[geom] - origin)
        vertex, normal, triangle = _mesh(model, int(model.geom_dataid[geom]))
        corners.append(vertex @ turn.T + offset)
        normals.append(normal @ turn.T)
        triangles.append(triangle + count)
        count += len(vertex)
    shades = np.repeat(colors(model, geoms), [len(part) for part in corners], axis=0)
    return rr.Mesh3D(
        vertex_positions=np.concatenate(corners),
        vertex_normals=np.concatenate(normals),
        triangle_indices=np.concatenate(triangles),
        vertex_colors=shades,
    )


def _mesh(model: mujoco.MjModel, number: int) -> tuple[Array, Array, NDArray[np.int64]]:
    """Return vertices (n, 3) [m], their normals (n, 3) and triangles (m, 3) of a mesh.

    A vertex on an edge, which has several normals, is repeated.
    """
    vertex, normal = model.mesh_vertadr[number], model.mesh_normaladr[number]
    face = int(model.mesh_faceadr[number])
    faces = slice(face, face + int(model.mesh_facenum[number]))
    pairs = np.column_stack([model.mesh_face[faces].ravel(), model.mesh_facenormal[faces].ravel()])
    unique, triangles = np.unique(pairs, axis=0, return_inverse=True)
    corners = model.mesh_vert[vertex + unique[:, 0]].astype(np.float64)
    normals = model.mesh_normal[normal + unique[:, 1]].astype(np.float64)
    return corners, normals, triangles.reshape(-1, 3)
