import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import FEET, HEAD_CAMERA, SOLES
from hsr8.show.log.robot import RobotShapes
from hsr8.show.log.shapes import batches_of, colors, sole_outline
from hsr8.show.log.stream import LogStream
from hsr8.show.log.world import WorldShapes
from tests.hsr8.show.log.reading import Log


@pytest.fixture(scope="module")
def robot(model):
    return model.body_rootid[model.geom_bodyid] == model.body("base_link").id


def test_every_visible_geom_of_the_robot_is_in_one_batch(model, robot):
    visible = robot & (model.geom_group == 2)
    geoms = np.concatenate([*batches_of(model, visible).values()])
    assert sorted(geoms.tolist()) == np.flatnonzero(visible).tolist()


class Records(dict):
    """Table of records."""

    def __len__(self):
        return len(self["time"])


def test_logged_shapes_are_where_the_geoms_are(model, layout, tmp_path):
    rng, data = np.random.default_rng(3), mujoco.MjData(model)
    qpos = rng.normal(size=(3, model.nq))
    qpos[:, 3:7] /= np.linalg.norm(qpos[:, 3:7], axis=1, keepdims=True)
    stream = LogStream("test")
    stream.save(tmp_path / "log.rrd")
    times, n = np.arange(3.0), len(layout.obstacles)
    records = {"time": times, "qpos": qpos, "obstacle_positions": np.zeros((3, n, 2))}
    WorldShapes(stream, model, layout).log(stream, Records(records))
    RobotShapes(stream, load_robot("hsr8")).log(stream, times, qpos)
    stream.disconnect()
    log = Log(tmp_path / "log.rrd")
    cameras = log.table("/world/camera", "Transform3D:translation").rows
    visible = (model.body_rootid[model.geom_bodyid] == model.body("base_link").id) & (
        model.geom_group == 2
    )
    for k, configuration in enumerate(qpos):
        data.qpos[:] = configuration
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        assert cameras[k][0] == pytest.approx(data.camera(HEAD_CAMERA).xpos)
        for kind, geoms in batches_of(model, visible).items():
            archetype = f"{kind.capitalize()}3D"
            name = "translations" if kind == "capsules" else "centers"
            entity = f"/world/robot/{kind}"
            positions = log.table(entity, f"{archetype}:{name}").rows[k]
            for geom, position, quaternion in zip(
                geoms,
                positions,
                log.table(entity, f"{archetype}:quaternions").rows[k],
                strict=True,
            ):
                matrix = np.empty(9)
                mujoco.mju_quat2Mat(matrix, np.roll(quaternion, 1).astype(float))
                assert matrix == pytest.approx(data.geom_xmat[geom], abs=1e-5)
                half = model.geom_size[geom, 1] if kind == "capsules" else 0.0
                centre = position + half * matrix[2::3]
                assert centre == pytest.approx(data.geom_xpos[geom], abs=1e-5)


def test_colors_come_from_the_material(model):
    red = model.geom("field/obstacle_00").id
    material = model.geom_matid[red]
    assert material >= 0
    expected = np.round(255 * model.mat_rgba[material]).tolist()
    assert colors(model, np.array([red]))[0].tolist() == expected


def test_a_missing_kind_has_no_batch(model):
    assert [*batches_of(model, model.geom_type == mujoco.mjtGeom.mjGEOM_BOX)] == ["boxes"]
    assert batches_of(model, np.zeros(model.ngeom, bool)) == {}


@pytest.mark.parametrize("side", [0, 1])
def test_the_outline_of_a_sole_is_that_of_its_geom_from_above(model, side):
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    outline = sole_outline(load_robot("hsr8").model.sole)
    foot, sole = data.site(FEET[side]), data.geom(SOLES[side])
    drawn = foot.xpos[:2] + outline @ foot.xmat.reshape(3, 3)[:2, :2].T
    half = model.geom(SOLES[side]).size[:2]
    signs = np.array([(u, v) for u in (-1.0, 1.0) for v in (-1.0, 1.0)])
    corners = sole.xpos[:2] + (signs * half) @ sole.xmat.reshape(3, 3)[:2, :2].T
    distance = np.hypot(*(drawn[:, None] - corners[None]).transpose(2, 0, 1))
    assert drawn[0].tolist() == drawn[-1].tolist()
    assert sorted(distance[:-1].argmin(axis=1).tolist()) == [0, 1, 2, 3]
    assert distance.min(axis=1) == pytest.approx(0.0, abs=1e-9)
