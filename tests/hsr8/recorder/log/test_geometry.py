import mujoco
import numpy as np
import pytest

from hsr8.recorder.log.geometry import (
    BASE,
    batches_of,
    colors,
    multiply,
    rotate,
    sole_outline,
    xyzw,
)


def _unit(rng, n):
    q = rng.normal(size=(n, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def test_quaternion_helpers_agree_with_mujoco():
    rng = np.random.default_rng(0)
    a, b, v = _unit(rng, 20), _unit(rng, 20), rng.normal(size=(20, 3))
    for i in range(20):
        product, turned = np.empty(4), np.empty(3)
        mujoco.mju_mulQuat(product, a[i], b[i])
        mujoco.mju_rotVecQuat(turned, v[i], a[i])
        np.testing.assert_allclose(multiply(a, b)[i], product, atol=1e-12)
        np.testing.assert_allclose(rotate(a, v)[i], turned, atol=1e-12)
    assert xyzw(np.array([1.0, 2.0, 3.0, 4.0])).tolist() == [2.0, 3.0, 4.0, 1.0]


@pytest.fixture(scope="module")
def robot(model):
    return model.body_rootid[model.geom_bodyid] == model.body(BASE).id


def test_every_visible_geom_of_the_robot_is_in_one_batch(model, robot):
    visible = robot & (model.geom_group == 2)
    geoms = np.concatenate([batch.geoms for batch in batches_of(model, visible)])
    assert sorted(geoms.tolist()) == np.flatnonzero(visible).tolist()


def test_poses_of_geoms_follow_their_bodies(model, robot):
    """In any configuration, body pose and offset give MuJoCo's own geom pose."""
    data = mujoco.MjData(model)
    data.qpos[:] = np.random.default_rng(3).normal(size=model.nq)
    mujoco.mj_normalizeQuat(model, data.qpos)
    mujoco.mj_kinematics(model, data)
    for batch in batches_of(model, robot & (model.geom_group == 2)):
        turn = data.xquat[batch.bodies]
        position = data.xpos[batch.bodies] + rotate(turn, batch.offset)
        if batch.kind == "capsules":
            half = np.zeros_like(position)
            half[:, 2] = model.geom_size[batch.geoms, 1]
            position = position + rotate(multiply(turn, batch.rotation), half)
        np.testing.assert_allclose(position, data.geom_xpos[batch.geoms], atol=1e-9)


def test_colors_come_from_the_material(model):
    red = model.geom("obstacle_00").id
    material = model.geom_matid[red]
    assert material >= 0
    expected = np.round(255 * model.mat_rgba[material]).tolist()
    assert colors(model, np.array([red]))[0].tolist() == expected


def test_a_missing_kind_has_no_batch(model):
    assert [b.kind for b in batches_of(model, model.geom_type == mujoco.mjtGeom.mjGEOM_BOX)] == [
        "boxes"
    ]
    assert batches_of(model, np.zeros(model.ngeom, bool)) == []


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_outline_of_a_sole_is_that_of_its_geom_from_above(model, side):
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    outline = sole_outline(model, side)
    foot, sole = data.site(f"{side}_foot"), data.geom(f"{side}_sole")
    drawn = foot.xpos[:2] + outline @ foot.xmat.reshape(3, 3)[:2, :2].T
    half = model.geom(f"{side}_sole").size[:2]
    signs = np.array([(u, v) for u in (-1.0, 1.0) for v in (-1.0, 1.0)])
    corners = sole.xpos[:2] + (signs * half) @ sole.xmat.reshape(3, 3)[:2, :2].T
    distance = np.hypot(*(drawn[:, None] - corners[None]).transpose(2, 0, 1))
    assert drawn[0].tolist() == drawn[-1].tolist()
    assert sorted(distance[:-1].argmin(axis=1).tolist()) == [0, 1, 2, 3]
    assert distance.min(axis=1) == pytest.approx(0.0, abs=1e-9)
