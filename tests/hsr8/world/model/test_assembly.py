import mujoco
import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.world.body.physics import place_robot
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex
from hsr8.world.model.models import models_dir
from walking.body.joints import JOINT_NAMES


@pytest.fixture(scope="module")
def layout():
    return draw_layout(load_scenario("course"), 7)


@pytest.fixture(scope="module")
def models(layout):
    return {q: assemble(layout, q, Optics(160, 120)) for q in ("vision", "show")}


def names(model, kind, count):
    return [mujoco.mj_id2name(model, kind, i) for i in range(count)]


def test_both_qualities_share_state_joints_actuators_sensors_and_movers(models):
    vision, show = models["vision"], models["show"]
    assert (vision.nq, vision.nv, vision.nu, vision.nmocap) == (
        show.nq,
        show.nv,
        show.nu,
        show.nmocap,
    )
    for kind, count in (
        (mujoco.mjtObj.mjOBJ_JOINT, vision.njnt),
        (mujoco.mjtObj.mjOBJ_ACTUATOR, vision.nu),
        (mujoco.mjtObj.mjOBJ_SENSOR, vision.nsensor),
        (mujoco.mjtObj.mjOBJ_BODY, vision.nbody),
        (mujoco.mjtObj.mjOBJ_CAMERA, vision.ncam),
    ):
        assert names(vision, kind, count) == names(show, kind, count)
    np.testing.assert_array_equal(vision.body_mass, show.body_mass)
    np.testing.assert_array_equal(vision.key_qpos, show.key_qpos)


def test_everything_has_a_name(models):
    for model in models.values():
        assert all(names(model, mujoco.mjtObj.mjOBJ_GEOM, model.ngeom))
        assert all(names(model, mujoco.mjtObj.mjOBJ_LIGHT, model.nlight))


def test_the_robot_is_the_same_as_alone(models):
    model = models["vision"]
    assert [model.actuator(i).name for i in range(model.nu)] == [f"{n}_act" for n in JOINT_NAMES]
    assert model.opt.timestep == 0.0025
    assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET


def test_obstacles_and_beacons_are_where_the_layout_says(models, layout):
    for model in models.values():
        index = ModelIndex.of(model, len(layout.static), len(layout.movers))
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        places = data.geom_xpos[index.obstacle_geoms]
        wanted = [[*o.position, 0.5 * o.height] for o in layout.obstacles]
        np.testing.assert_allclose(places, wanted, atol=1e-12)
        radii = model.geom_size[index.obstacle_geoms, 0]
        np.testing.assert_allclose(radii, [o.radius for o in layout.obstacles])
        for beacon in layout.beacons:
            top = data.geom(f"beacon_{beacon.top}_{beacon.bottom}_top")
            np.testing.assert_allclose(top.xpos, [*beacon.position, 0.45])


def test_movers_go_where_their_law_says_and_statics_stay(models, layout):
    model = models["vision"]
    index = ModelIndex.of(model, len(layout.static), len(layout.movers))
    data = mujoco.MjData(model)
    data.mocap_pos[index.mover_mocap, :2] = layout.motion().positions(12.3)
    mujoco.mj_kinematics(model, data)
    places = data.geom_xpos[index.obstacle_geoms, :2]
    wanted = [(o.motion.position(12.3) if o.motion else o.position) for o in layout.obstacles]
    np.testing.assert_allclose(places, wanted, atol=1e-9)


def test_the_robot_stands_on_the_floor_without_warnings(models, layout):
    model = models["vision"]
    data = mujoco.MjData(model)
    place_robot(model, data, np.array(layout.start))
    data.ctrl[:] = model.key_ctrl[model.key("walk_ready").id]
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    soles = {model.geom("l_sole").id, model.geom("r_sole").id}
    floor = model.geom("floor").id
    touching = {g for pair in data.contact.geom for g in pair if floor in pair} - {floor}
    assert touching == soles


@pytest.mark.parametrize("geom", ["l_sole", "torso_collision", "l_forearm_collision"])
def test_obstacles_are_solid_for_every_part_of_the_robot(models, geom):
    model = models["vision"]
    for other in ("obstacle_00", "mover_00", "beacon_yellow_cyan_top"):
        one, two = model.geom(geom), model.geom(other)
        assert (one.contype & two.conaffinity) | (two.contype & one.conaffinity)


def test_a_mover_pushes_a_standing_robot():
    hand = (
        'world.mover=[{motion="line", start=[-1.2, 0.0], heading_deg=180, speed=0.3, radius=0.1}]'
    )
    layout = draw_layout(load_scenario("walk", [hand, "robot.speed.vx=0.3"]), 0)
    model = assemble(layout, "vision", Optics())
    index = ModelIndex.of(model, 0, 1)
    data, movers = mujoco.MjData(model), layout.motion()
    place_robot(model, data, np.array(layout.start))
    data.ctrl[:] = model.key_ctrl[model.key("walk_ready").id]
    for k in range(400):
        data.mocap_pos[index.mover_mocap, :2] = movers.positions(k * model.opt.timestep)
        mujoco.mj_step(model, data)
    assert data.qpos[index.root_qpos] < layout.start[0] - 0.05
    assert data.warning.number.sum() == 0


def test_optics_reach_the_head_camera_and_the_lights(layout):
    usual = assemble(layout, "vision", Optics())
    dim = assemble(layout, "vision", Optics(200, 100, np.radians(45.0), 0.5))
    camera = dim.camera("egocentric")
    assert camera.fovy[0] == pytest.approx(45.0)
    assert dim.cam_resolution[camera.id].tolist() == [200, 100]
    assert (dim.vis.global_.offwidth, dim.vis.global_.offheight) == (200, 100)
    np.testing.assert_allclose(dim.light_diffuse, 0.5 * usual.light_diffuse)


@pytest.mark.gl
def test_the_head_camera_sees_a_bright_field_and_no_void(models, layout):
    model = models["vision"]
    data = mujoco.MjData(model)
    place_robot(model, data, np.array(layout.start))
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, height=120, width=160) as renderer:
        renderer.update_scene(data, camera="egocentric")
        image = renderer.render()
    lower = image[80:].astype(int)
    assert 90 < lower.mean() < 220
    assert image.max() < 255


@pytest.mark.parametrize("quality", ["vision", "show"])
def test_the_field_models_open_by_themselves(quality):
    model = mujoco.MjModel.from_xml_path(str(models_dir() / "field" / f"{quality}.xml"))
    assert model.nq == 7 + len(JOINT_NAMES)
    assert model.geom("floor").contype[0] == 3
