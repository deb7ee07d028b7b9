from dataclasses import replace

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.model.normal_form import SOLES
from hsr8.scenario.loader import load_scenario
from hsr8.world.body.physics import place_robot
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex
from walking.body.tree import JOINT_NAMES


@pytest.fixture(scope="module")
def layout():
    return draw_layout(load_scenario("course"), 7)


@pytest.fixture(scope="module")
def models(layout):
    return {
        q: assemble(load_robot("hsr8"), layout, q, Optics(160, 120)) for q in ("vision", "show")
    }


def names(model, kind, count):
    return [mujoco.mj_id2name(model, kind, i) for i in range(count)]


def ready(model, layout):
    data = mujoco.MjData(model)
    place_robot(model, data, load_robot("hsr8"), np.array(layout.start))
    return data


def test_both_qualities_share_state_joints_actuators_sensors_and_movers(models):
    vision, show = models["vision"], models["show"]
    for size in ("nq", "nv", "nu", "nmocap"):
        assert getattr(vision, size) == getattr(show, size)
    for kind, count in (
        (mujoco.mjtObj.mjOBJ_JOINT, vision.njnt),
        (mujoco.mjtObj.mjOBJ_ACTUATOR, vision.nu),
        (mujoco.mjtObj.mjOBJ_SENSOR, vision.nsensor),
        (mujoco.mjtObj.mjOBJ_BODY, vision.nbody),
        (mujoco.mjtObj.mjOBJ_CAMERA, vision.ncam),
    ):
        assert names(vision, kind, count) == names(show, kind, count)
    for quantity in ("body_mass", "body_inertia", "dof_armature", "actuator_gainprm", "qpos0"):
        np.testing.assert_array_equal(getattr(vision, quantity), getattr(show, quantity))


def test_the_world_keeps_the_robot_and_names_everything(models):
    for model in models.values():
        assert all(names(model, mujoco.mjtObj.mjOBJ_GEOM, model.ngeom))
        assert all(names(model, mujoco.mjtObj.mjOBJ_LIGHT, model.nlight))
        assert names(model, mujoco.mjtObj.mjOBJ_ACTUATOR, 26) == [f"{n}_act" for n in JOINT_NAMES]
        assert model.opt.timestep == 0.0025
        assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET


NAMED = ("BODY", "GEOM", "SITE", "CAMERA", "LIGHT", "MATERIAL", "TEXTURE", "MESH")


def all_names(model):
    """Names of all parts of a model, with their kind."""
    kinds = [getattr(mujoco.mjtObj, f"mjOBJ_{kind}") for kind in NAMED]
    counts = (model.nbody, model.ngeom, model.nsite, model.ncam, model.nlight)
    counts += (model.nmat, model.ntex, model.nmesh)
    pairs = zip(kinds, counts, strict=True)
    return {(k, name) for k, count in pairs for name in names(model, k, count) if name}


@pytest.mark.parametrize("quality", ["vision", "show"])
def test_a_robot_may_have_the_names_of_the_field(layout, quality):
    robot = load_robot("hsr8")
    plain = assemble(robot, layout, quality, Optics())
    field = [part for part in all_names(plain) if part[1].startswith("field/")]
    assert len(field) > 20
    spec = robot.spec.copy()
    trunk = spec.body(robot.roles.trunk)
    for kind, name in ((kind, name.removeprefix("field/")) for kind, name in field):
        if kind == mujoco.mjtObj.mjOBJ_BODY:
            body = trunk.add_body(name=name, mass=1e-3, inertia=[1e-6, 1e-6, 1e-6])
            body.explicitinertial = True
        elif kind == mujoco.mjtObj.mjOBJ_GEOM:
            visual = {"contype": 0, "conaffinity": 0, "mass": 0.0}
            trunk.add_geom(name=name, size=[0.01, 0.0, 0.0], **visual)
        elif kind == mujoco.mjtObj.mjOBJ_CAMERA:
            trunk.add_camera(name=name)
        elif kind == mujoco.mjtObj.mjOBJ_LIGHT:
            trunk.add_light(name=name)
        elif kind == mujoco.mjtObj.mjOBJ_MATERIAL:
            spec.add_material(name=name)
    model = assemble(replace(robot, spec=spec), layout, quality, Optics())
    index = ModelIndex.of(model, robot, len(layout.static), len(layout.movers))
    assert len(index.beacon_geoms) == len(layout.beacons)
    assert len(index.bumps) == len(layout.bumps)
    assert not {int(g) for g in index.obstacle_geoms} & set(index.robot_geoms.tolist())


@pytest.mark.parametrize("quality", ["vision", "show"])
def test_obstacles_and_beacons_have_the_poses_of_the_layout(models, layout, quality):
    model = models[quality]
    index = ModelIndex.of(model, load_robot("hsr8"), len(layout.static), len(layout.movers))
    data = mujoco.MjData(model)
    for time in (0.0, 12.3):
        data.mocap_pos[index.mover_mocap, :2] = layout.motion().positions(time)
        mujoco.mj_kinematics(model, data)
        expected = [
            [*(o.motion.position(time) if o.motion else o.position), 0.5 * o.height]
            for o in layout.obstacles
        ]
        np.testing.assert_allclose(data.geom_xpos[index.obstacle_geoms], expected, atol=1e-9)
    radii = model.geom_size[index.obstacle_geoms, 0]
    np.testing.assert_allclose(radii, [o.radius for o in layout.obstacles])
    for beacon in layout.beacons:
        top = data.geom(f"field/beacon_{beacon.top}_{beacon.bottom}_top")
        np.testing.assert_allclose(top.xpos, [*beacon.position, 0.45])


def test_the_robot_stands_on_the_floor_without_warnings(models, layout):
    model = models["vision"]
    data = ready(model, layout)
    mujoco.mj_step(model, data, nstep=100)
    assert data.warning.number.sum() == 0
    floor = model.geom("field/floor").id
    touching = {g for pair in data.contact.geom for g in pair if floor in pair} - {floor}
    assert touching == {model.geom(sole).id for sole in SOLES}


@pytest.mark.parametrize("geom", [*SOLES, "torso_collision", "l_forearm_collision"])
def test_obstacles_are_solid_for_every_part_of_the_robot(models, geom):
    model = models["vision"]
    for other in ("field/obstacle_00", "field/mover_00", "field/beacon_yellow_cyan_top"):
        one, two = model.geom(geom), model.geom(other)
        assert (one.contype & two.conaffinity) | (two.contype & one.conaffinity)


def test_optics_change_the_head_camera_and_the_lights(layout):
    normal = assemble(load_robot("hsr8"), layout, "vision", Optics())
    dim = assemble(load_robot("hsr8"), layout, "vision", Optics(200, 100, np.radians(45.0), 0.5))
    camera = dim.camera("egocentric")
    assert camera.fovy[0] == pytest.approx(45.0)
    assert dim.cam_resolution[camera.id].tolist() == [200, 100]
    assert (dim.vis.global_.offwidth, dim.vis.global_.offheight) == (200, 100)
    np.testing.assert_allclose(dim.light_diffuse, 0.5 * normal.light_diffuse)
