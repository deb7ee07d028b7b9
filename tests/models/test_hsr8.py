"""HSR-VIII's MJCF follows the conventions of MuJoCo Menagerie and its README."""

from itertools import product
from pathlib import Path

import mujoco
import numpy as np
import pytest

from walking.body.tree import JOINT_NAMES

HERE = Path(__file__).parents[2] / "models" / "hsr8"
COUNTS = {
    "body": "nbody",
    "joint": "njnt",
    "geom": "ngeom",
    "site": "nsite",
    "camera": "ncam",
    "light": "nlight",
    "texture": "ntex",
    "material": "nmat",
    "pair": "npair",
    "exclude": "nexclude",
    "actuator": "nu",
    "sensor": "nsensor",
    "key": "nkey",
}
PADS = [f"{foot}_sole_{pad}_force" for foot in "lr" for pad in ("fl", "fr", "bl", "br")]
MIRROR = np.array([1.0, -1.0, 1.0])
VISUAL_GROUP = 2


@pytest.fixture(scope="module")
def robot():
    return mujoco.MjModel.from_xml_path(str(HERE / "hsr8.xml"))


@pytest.fixture
def standing():
    scene = mujoco.MjModel.from_xml_path(str(HERE / "scene.xml"))
    data = mujoco.MjData(scene)
    mujoco.mj_resetDataKeyframe(scene, data, scene.key("walk_ready").id)
    return scene, data


def at_key(model, key):
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    mujoco.mj_forward(model, data)
    return data


def names(model, kind):
    return [getattr(model, kind)(i).name for i in range(getattr(model, COUNTS[kind]))]


def pairs(model, kind):
    """Left and right parts of one kind."""
    lefts = [name for name in names(model, kind) if name.startswith("l_")]
    assert lefts
    find = getattr(model, kind)
    return [(name, find(name), find("r" + name[1:])) for name in lefts]


def test_actuators_follow_the_joints_in_order_and_range(robot):
    joints = robot.actuator_trnid[:, 0]
    assert tuple(robot.joint(i).name for i in joints) == JOINT_NAMES
    assert names(robot, "actuator") == [f"{name}_act" for name in JOINT_NAMES]
    assert robot.jnt_limited[joints].all()
    assert robot.actuator_ctrlrange == pytest.approx(robot.jnt_range[joints])
    assert (robot.dof_armature[6:] > 0).all()
    assert (robot.dof_damping[6:] > 0).all()


def test_mass_and_height_are_the_published_ones(robot):
    data = at_key(robot, "home")
    assert robot.body_mass.sum() == pytest.approx(5.5, abs=0.01)
    head = robot.geom("head_visual").id
    half = np.sqrt(((data.geom_xmat[head].reshape(3, 3)[2] * robot.geom_size[head]) ** 2).sum())
    assert data.geom_xpos[head, 2] + half == pytest.approx(0.528, abs=0.003)


@pytest.mark.parametrize("key", ["home", "walk_ready"])
def test_keyframe_has_flat_feet_and_keeps_all_limits(robot, key):
    data, frame = at_key(robot, key), robot.key(key)
    for foot in (data.site("l_foot"), data.site("r_foot")):
        assert foot.xpos[2] == pytest.approx(0, abs=5e-4)
        assert foot.xmat[8] == pytest.approx(1, abs=1e-6)
    address = robot.jnt_qposadr[robot.actuator_trnid[:, 0]]
    lower, upper = robot.actuator_ctrlrange.T
    assert frame.ctrl == pytest.approx(frame.qpos[address])
    assert ((lower <= frame.ctrl) & (frame.ctrl <= upper)).all()
    assert np.linalg.norm(frame.qpos[3:7]) == pytest.approx(1)


def test_left_mirrors_right_in_bodies(robot):
    for name, left, right in pairs(robot, "body"):
        assert left.mass == pytest.approx(right.mass), name
        assert left.inertia == pytest.approx(right.inertia), name
        assert left.pos == pytest.approx(right.pos * MIRROR), name
        assert left.ipos == pytest.approx(right.ipos * MIRROR), name


def test_left_mirrors_right_in_joints_and_actuators(robot):
    """Pitch axes are equal on both sides; roll and yaw axes are opposite."""
    for name, left, right in pairs(robot, "joint"):
        assert left.axis == pytest.approx(right.axis), name
        expected = right.range if abs(left.axis[1]) > 0.5 else -right.range[::-1]
        assert left.range == pytest.approx(expected), name
        for field in ("armature", "damping", "frictionloss"):
            assert getattr(left, field) == pytest.approx(getattr(right, field)), (name, field)
    for name, left, right in pairs(robot, "actuator"):
        for field in ("forcerange", "gainprm", "biasprm"):
            assert getattr(left, field) == pytest.approx(getattr(right, field)), (name, field)


def test_no_geom_adds_mass():
    """Inertias are explicit: a change of a shape never changes the dynamics."""
    spec = mujoco.MjSpec.from_file(str(HERE / "hsr8.xml"))
    assert all(body.explicitinertial for body in spec.bodies[1:])
    assert all(geom.mass == 0 for geom in spec.geoms)


def test_colors_stay_out_of_the_obstacle_classes(robot):
    """Vision takes saturated colours for obstacles and beacons."""
    visual = robot.geom_group == VISUAL_GROUP
    colors = robot.mat_rgba[robot.geom_matid[visual], :3]
    assert (1 - colors.min(axis=1) / colors.max(axis=1) < 0.15).all()


def test_the_head_does_not_occlude_its_camera(robot):
    """Rays through the whole image leave the head, at any pan and tilt."""
    data = at_key(robot, "home")
    head = robot.body("head_tilt_link").id
    camera = data.camera("egocentric")
    visible = np.arange(mujoco.mjNGROUP) == VISUAL_GROUP
    tall = np.tan(np.radians(robot.camera("egocentric").fovy[0]) / 2)
    for u, v in product(np.linspace(-4 / 3, 4 / 3, 9), np.linspace(-1, 1, 7)):
        ray = camera.xmat.reshape(3, 3) @ np.array([u * tall, v * tall, -1.0])
        hit = np.array([-1], dtype=np.int32)
        mujoco.mj_ray(robot, data, camera.xpos, ray, visible.astype(np.uint8), 1, -1, hit)
        assert hit[0] < 0 or robot.geom_bodyid[hit[0]] != head, (u, v)


def test_walk_ready_stands(standing):
    scene, data = standing
    mujoco.mj_step(scene, data, nstep=400)
    root = scene.key("walk_ready").qpos[:3]
    assert data.body("base_link").xmat[8] > np.cos(0.05)
    assert data.qpos[:2] == pytest.approx(root[:2], abs=0.01)
    assert data.qpos[2] == pytest.approx(root[2], abs=0.005)
    force = sum(data.sensor(pad).data[0] for pad in PADS)
    assert force == pytest.approx(scene.body_mass.sum() * 9.81, rel=0.05)


@pytest.mark.parametrize("yaw", [0.3, -2.7])
def test_pads_measure_the_whole_load_at_any_heading(standing, yaw):
    """The contact points are at the corners of the soles, at the border of the pads."""
    scene, data = standing
    data.qpos[:2] = 1.7 * np.sin(yaw), 0.9 * np.cos(yaw)
    data.qpos[3:7] = np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)
    soles = [scene.geom(f"{foot}_sole").id for foot in "lr"]
    force, ratios = np.zeros(6), []
    for _ in range(200):
        mujoco.mj_step(scene, data)
        mujoco.mj_forward(scene, data)
        load = 0.0
        for index in range(data.ncon):
            if np.isin(data.contact[index].geom, soles).any():
                mujoco.mj_contactForce(scene, data, index, force)
                load += force[0]
        ratios.append(sum(data.sensor(pad).data[0] for pad in PADS) / load)
    assert ratios == pytest.approx([1.0] * len(ratios), rel=1e-6)
