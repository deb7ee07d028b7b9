"""Meshes of a robot in the log."""

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.shown import VISUAL_GROUPS, visual_model
from hsr8.show.log.robot import RobotShapes, followed_entity
from hsr8.show.log.stream import LogStream
from tests.hsr8.robots.mesh_humanoid import write_robot
from tests.hsr8.show.log.reading import Log

MESH = int(mujoco.mjtGeom.mjGEOM_MESH)
TIMES = [0.0, 0.1, 0.2]


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    return load_robot(write_robot(tmp_path_factory.mktemp("robot")))


@pytest.fixture(scope="module")
def qpos(robot):
    configurations = np.random.default_rng(3).normal(size=(3, visual_model(robot).nq))
    configurations[:, 3:7] /= np.linalg.norm(configurations[:, 3:7], axis=1, keepdims=True)
    return list(configurations)


@pytest.fixture(scope="module")
def log(robot, qpos, tmp_path_factory):
    file = tmp_path_factory.mktemp("log") / "log.rrd"
    stream = LogStream("test")
    stream.save(file)
    RobotShapes(stream, robot).log(stream, np.array(TIMES), np.array(qpos))
    stream.disconnect()
    assert file.stat().st_size < 1e7
    return Log(file)


def test_vertices_in_the_log_are_those_of_the_model(robot, qpos, log):
    model = visual_model(robot)
    data = mujoco.MjData(model)
    for k, configuration in enumerate(qpos):
        data.qpos[:] = configuration
        mujoco.mj_kinematics(model, data)
        for name in ("base", "l_knee_link"):
            entity = f"/world/robot/{name}"
            local = np.array(log.table(entity, "Mesh3D:vertex_positions").rows[0])
            (translation,) = log.table(entity, "Transform3D:translation").rows[k]
            (quaternion,) = log.table(entity, "Transform3D:quaternion").rows[k]
            matrix = np.empty(9)
            mujoco.mju_quat2Mat(matrix, np.roll(quaternion, 1).astype(float))
            logged = local @ matrix.reshape(3, 3).T + translation
            geoms = [g for g in np.flatnonzero(model.geom_type == MESH) if _part(model, g) == name]
            expected = np.vstack([_corners(model, data, g) for g in geoms])
            assert np.abs(logged.min(axis=0) - expected.min(axis=0)).max() < 1e-5
            assert np.abs(logged.max(axis=0) - expected.max(axis=0)).max() < 1e-5


def test_meshes_have_unit_normals_the_colors_of_their_geoms_and_valid_triangles(log):
    entity = "/world/robot/base"
    normals = np.array(log.table(entity, "Mesh3D:vertex_normals").rows[0])
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-3)
    assert len(np.unique(log.table(entity, "Mesh3D:vertex_colors").rows[0])) == 2
    triangles = np.array(log.table(entity, "Mesh3D:triangle_indices").rows[0])
    assert triangles.max() < len(normals)


def test_every_visible_geom_of_the_robot_is_in_the_log(robot, log):
    model = visual_model(robot)
    shown = set()
    for geom in np.flatnonzero(np.isin(model.geom_group, VISUAL_GROUPS)):
        if model.geom_type[geom] == MESH:
            shown.add(f"/world/robot/{_part(model, geom)}")
    assert shown | {"/world/robot/boxes"} <= set(log.entities())


def test_views_follow_a_part_that_is_in_the_log(robot, log):
    assert followed_entity(visual_model(robot), robot.roles.base) in log.entities()
    hsr8 = load_robot("hsr8")
    assert followed_entity(visual_model(hsr8), hsr8.roles.base) == "/world/robot/ellipsoids"


def _part(model, geom):
    """Name of the rigid part of a geom: the torso is fixed to the base."""
    return model.body(int(model.body_weldid[model.geom_bodyid[geom]])).name


def _corners(model, data, geom):
    mesh = model.mesh(int(model.geom_dataid[geom]))
    first = int(mesh.vertadr[0])
    vertices = model.mesh_vert[first : first + int(mesh.vertnum[0])]
    return vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
