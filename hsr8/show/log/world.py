"""True world in the log: floor, obstacles, movers, via points, path, footsteps, head camera."""

from math import cos, sin

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.derived import WorldFrame
from hsr8.recording.table import Table
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.robots.shown import VISUAL_GROUPS
from hsr8.show.log.camera import CAMERA
from hsr8.show.log.shapes import batches_of, poses, raised, shapes
from hsr8.show.log.stream import LogStream
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import FIELD

Array = NDArray[np.float64]

STATIC = {  # prefix of the names by entity; walls for the robot's camera are left out
    "/world/beacons": f"{FIELD}beacon",
    "/world/obstacles": f"{FIELD}obstacle",
    "/world/rim": f"{FIELD}rim",
    "/world/bumps": f"{FIELD}bump",
}
PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)
APRON = 1.0  # margin of the floor around the field, both sides together, at scale 1 [m]
FLOOR_COLOR = (206, 204, 198, 255)
SOLE_HEIGHT = 0.004  # height of drawn footsteps [m]
PATH_HEIGHT = 0.003  # height of the drawn path [m]
MAX_LABELS = 12  # more via points than this are shown without numbers
LABEL_GAP = 0.06  # between a via point and its name [m]


class WorldShapes:
    """Shapes of the world without the robot: static objects once, movers over time.

    Args:
        log: recording, which receives the static objects.
        model: compiled world.
        layout: layout of the world.
    """

    def __init__(self, log: LogStream, model: mujoco.MjModel, layout: Layout) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._camera = model.camera(HEAD_CAMERA).id
        self._n_movers = len(layout.movers)
        mujoco.mj_kinematics(model, self._data)
        visible = np.isin(model.geom_group, VISUAL_GROUPS) & (model.geom_type != PLANE)
        mobile = model.body_mocapid[model.geom_bodyid] >= 0
        self._movers = batches_of(model, mobile & visible)
        for kind, geoms in self._movers.items():
            log.log("/world/movers", shapes(model, kind, geoms), static=True)
        names = [model.geom(k).name for k in range(model.ngeom)]
        for path, prefix in STATIC.items():
            chosen = np.array([name.startswith(prefix) for name in names])
            for kind, geoms in batches_of(model, visible & ~mobile & chosen).items():
                world = self._data.geom_xpos[None], self._data.xquat[None]
                pose = poses(model, kind, geoms, *world)
                log.log(f"{path}/{kind}", shapes(model, kind, geoms, **pose), static=True)
        width, depth = (side + APRON * layout.scale for side in layout.field_size)
        floor = rr.Boxes3D(
            half_sizes=[[width / 2, depth / 2, 0.005]],
            centers=[[0.0, 0.0, -0.006]],
            colors=[FLOOR_COLOR],
            fill_mode=rr.components.FillMode.Solid,
        )
        log.log("/world/floor", floor, static=True)

    def log(self, log: LogStream, records: Table) -> None:
        """Log movers and the true pose of the head camera."""
        data, n = self._data, len(records)
        positions, rotations = np.empty((n, 3)), np.empty((n, 4))
        for row, configuration in enumerate(records["qpos"]):
            data.qpos[:] = configuration
            mujoco.mj_kinematics(self._model, data)
            mujoco.mj_comPos(self._model, data)
            mujoco.mj_camlight(self._model, data)
            positions[row] = data.cam_xpos[self._camera]
            mujoco.mju_mat2Quat(rotations[row], data.cam_xmat[self._camera])
        # MuJoCo's camera looks along -z with y up, Rerun's along z with y down: half a turn about x
        # of the quaternion w-x-y-z, and its order x-y-z-w.
        turned = rotations[:, [0, 3, 2, 1]] * (1.0, 1.0, -1.0, -1.0)
        log.rows(CAMERA, rr.Transform3D, records["time"], translation=positions, quaternion=turned)
        obstacles = records["obstacle_positions"]
        movers = obstacles[:, obstacles.shape[1] - self._n_movers :].reshape(-1, 2)
        for geoms in self._movers.values():
            height = float(self._model.geom_size[geoms[0], 1])
            log.rows(
                "/world/movers",
                rr.Cylinders3D,
                records["time"],
                np.full(n, self._n_movers),
                centers=raised(movers, height),
            )


def log_via_points(log: LogStream, layout: Layout) -> None:
    """Log the via points, the goal and the heading there."""
    points = np.asarray(layout.waypoints, float).reshape(-1, 2)
    if len(points) == 0:
        return
    goal, few = None if layout.endless else layout.goal_heading, len(points) <= MAX_LABELS
    marks = rr.Points3D(
        raised(points, 0.01),
        radii=layout.scale * (0.03 if few else 0.012),
        colors=[palette.TARGET],
    )
    log.log("/world/via_points", marks, static=True)
    if few:
        names = [str(k + 1) for k in range(len(points))]
        if not layout.endless:
            names[-1] = "goal"
        # The viewer writes a name below its point; at the via point it would hide the mark.
        below = raised(points - (0.0, LABEL_GAP * layout.scale), 0.01)
        labels = rr.Points3D(
            below, radii=0.0, colors=[palette.TARGET], labels=names, show_labels=True
        )
        log.log("/world/via_points/names", labels, static=True)
    if goal is not None:
        heading = rr.Arrows3D(
            origins=[[*points[-1].tolist(), 0.01]],
            vectors=[[0.25 * layout.scale * cos(goal), 0.25 * layout.scale * sin(goal), 0.0]],
            colors=[palette.TARGET],
            radii=0.01,
        )
        log.log("/world/via_points/heading", heading, static=True)


def log_footsteps(log: LogStream, records: Table, times: Array, sole: Array) -> None:
    """Log planned footsteps, transformed with the true pose.

    Args:
        log: recording.
        records: one row for each of `times`.
        times: times of camera frames (n,) [s].
        sole: outline of a sole in the frame of the foot (m, 2) [m].
    """
    steps, frame = records["footsteps"], WorldFrame(records)
    rows, left = steps.parents, steps["left"]
    yaws = steps["yaw"] + frame.turn[rows]
    c, s = np.cos(yaws), np.sin(yaws)
    outlines = np.full((len(steps), len(sole), 3), SOLE_HEIGHT)
    outlines[..., :2] = sole @ np.moveaxis(np.array([[c, s], [-s, c]]), 2, 0)
    positions = frame.point(np.column_stack([steps["x"], steps["y"]]), rows)
    outlines[..., :2] += positions[:, None]
    colors = palette.packed_all((palette.RIGHT_FOOT, palette.LEFT_FOOT))
    log.rows(
        "/world/footsteps",
        rr.LineStrips3D,
        times,
        steps.counts,
        strips=outlines,
        colors=colors[left.astype(np.intp)],
        radii=np.full(len(steps), 0.004),
    )
