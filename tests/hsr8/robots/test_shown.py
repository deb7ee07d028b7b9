"""Shapes of a robot for people and for its camera."""

import mujoco
import numpy as np
import pytest

from hsr8.robots import shown
from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import SOLES
from hsr8.robots.shown import (
    CELL,
    HIDDEN_GROUP,
    SHOWN_GROUP,
    VISUAL_GROUPS,
    camera_spec,
    visual_model,
)
from tests.hsr8.robots.mesh_humanoid import write_robot

MESH = int(mujoco.mjtGeom.mjGEOM_MESH)


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    return load_robot(write_robot(tmp_path_factory.mktemp("robot")))


def posed(model):
    data = mujoco.MjData(model)
    data.qpos[3:] = np.random.default_rng(2).normal(size=model.nq - 3)
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    mujoco.mj_kinematics(model, data)
    return data


def corners(model, data, geom):
    """Vertices of a mesh geom in the world (n, 3) [m]."""
    mesh = model.mesh(int(model.geom_dataid[geom]))
    first = int(mesh.vertadr[0])
    vertices = model.mesh_vert[first : first + int(mesh.vertnum[0])]
    return vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]


def test_simpler_meshes_are_where_those_of_the_file_are(robot):
    full, simple = robot.spec.copy().compile(), visual_model(robot)
    assert (full.nq, full.ngeom) == (simple.nq, simple.ngeom)
    assert simple.mesh_facenum.sum() < full.mesh_facenum.sum()
    before, after = posed(full), posed(simple)
    cell = CELL * robot.model.measures().leg
    for geom in np.flatnonzero(full.geom_type == MESH):
        a, b = corners(full, before, geom), corners(simple, after, geom)
        np.testing.assert_allclose(a.min(axis=0), b.min(axis=0), atol=2.0 * cell)
        np.testing.assert_allclose(a.max(axis=0), b.max(axis=0), atol=2.0 * cell)
        assert full.geom_rgba[geom].tolist() == simple.geom_rgba[geom].tolist()


def test_a_robot_of_many_triangles_is_simplified_further(robot, monkeypatch):
    monkeypatch.setattr(shown, "MAX_TRIANGLES", 2000)
    model = shown._visual.__wrapped__(robot).compile()
    drawn = model.geom_dataid[model.geom_type == MESH]
    assert 200 < model.mesh_facenum[drawn].sum() <= 2000


def test_a_body_without_visual_shapes_shows_its_solid_ones(robot):
    model = visual_model(robot)
    assert [int(model.geom(name).group[0]) for name in SOLES] == [SHOWN_GROUP] * 2
    for body in map(model.body, ("torso", "l_knee_link")):
        shapes = range(body.geomadr[0], body.geomadr[0] + body.geomnum[0])
        drawn = [model.geom_type[g] for g in shapes if model.geom_group[g] in VISUAL_GROUPS]
        assert set(drawn) == {MESH}


def test_the_camera_sees_pale_solid_shapes_in_the_place_of_meshes(robot):
    model = camera_spec(robot).compile()
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    assert solid.sum() > 4
    assert set(model.geom_group[solid]) == {SHOWN_GROUP}
    assert set(model.geom_group[model.geom_type == MESH]) == {HIDDEN_GROUP}
    colors = model.geom_rgba[solid, :3]
    assert np.ptp(colors, axis=1).max() < 0.3
    assert model.mesh_facenum.sum() == 4 * model.nmesh


def test_physics_is_equal_in_the_shapes_of_the_camera(robot):
    full, seen = robot.spec.copy().compile(), camera_spec(robot).compile()
    for name in ("body_mass", "body_inertia", "body_ipos", "geom_contype", "geom_conaffinity"):
        np.testing.assert_array_equal(getattr(full, name), getattr(seen, name))


def test_the_shapes_of_the_default_robot_are_those_of_its_file():
    robot = load_robot("hsr8")
    file = robot.spec.copy().compile()
    for model in (visual_model(robot), camera_spec(robot).compile()):
        for name in ("geom_group", "geom_type", "geom_size", "geom_pos", "geom_rgba", "mat_rgba"):
            np.testing.assert_array_equal(getattr(model, name), getattr(file, name))
