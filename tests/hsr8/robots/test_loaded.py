"""A loaded robot has the kinematics, dynamics and servos of its model file."""

from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from hsr8.robots.defaults import defaults_of
from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import Camera
from tests.hsr8.robots.robot_parts import part, setting
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from walking.constants import robot_record
from walking.data import Data
from walking.estimate.body import measure
from walking.parameters import WalkingParameters

ROBOTS = {
    "plain": SmallHumanoid(),
    "other order": SmallHumanoid(hip="pry", ankle="rp", flip=True),
    "oblique hips": SmallHumanoid(oblique=0.3, offset=0.02),
    "waist": SmallHumanoid(waist="y"),
    "no head": SmallHumanoid(head=""),
}
SITES = ("hsr8/l_foot", "hsr8/r_foot", "hsr8/camera")


def frames(robot):
    """Frames of left foot, right foot and camera."""
    return *robot.model.tree.feet, robot.model.tree.camera


def robot_table(robot):
    """Defaults of a scenario with a robot."""
    return defaults_of(str(robot.file.with_suffix(".toml"))).table


@pytest.fixture
def load(tmp_path):
    """Loads a generated robot, with changes to its MJCF."""

    def make(robot, *changes, keys=""):
        element = robot.element()
        for change in changes:
            change(element)
        (tmp_path / "robot.xml").write_text(ElementTree.tostring(element, encoding="unicode"))
        left, right = robot.feet()
        text = f'model = "robot.xml"\nfeet = ["{left}", "{right}"]\n'
        if robot.head:
            text += 'head = ["head_yaw", "head_pitch"]\n'
        text += keys
        (tmp_path / "robot.toml").write_text(text)
        return load_robot(str(tmp_path / "robot.toml"))

    return make


@pytest.mark.parametrize("name", ROBOTS)
def test_kinematics_and_centre_of_mass_are_those_of_mujoco(load, name):
    robot = load(ROBOTS[name])
    model = robot.spec.copy().compile()
    data, rng = mujoco.MjData(model), np.random.default_rng(4)
    for joint, angle in robot.held.items():
        data.joint(joint).qpos[0] = angle
    joints = robot.model.names
    angles = robot.model.ready + rng.uniform(-0.2, 0.2, len(joints))
    for joint, angle in zip(joints, angles.tolist(), strict=True):
        data.joint(joint).qpos[0] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    base = data.body(robot.roles.base)
    turned = base.xmat.reshape(3, 3).T
    com = turned @ (data.subtree_com[model.body(robot.roles.base).id] - base.xpos)
    np.testing.assert_allclose(robot.model.com(angles), com, rtol=0.0, atol=1e-12)
    assert robot.model.mass == pytest.approx(model.body_subtreemass[1], rel=1e-12)
    walks, constants = np.zeros(1, Data), robot_record(robot.model, robot.parameters)
    upright, rest = np.array([1.0, 0.0, 0.0, 0.0]), (np.zeros(3), np.zeros((2, 4)))
    measure(walks, angles, upright, *rest, robot.model.links, robot.model.order, constants)
    for measured, frame, site in zip(walks[0]["body"]["frames"], frames(robot), SITES, strict=True):
        rotation, position = robot.model.frame_pose(frame, angles)
        np.testing.assert_array_equal(measured, [*rotation.ravel(), *position])
        place = data.site(site)
        np.testing.assert_allclose(position, turned @ (place.xpos - base.xpos), atol=1e-12)
        np.testing.assert_allclose(rotation, turned @ place.xmat.reshape(3, 3), atol=1e-12)
    for leg, six, side in zip(robot.model.legs, (slice(0, 6), slice(6, 12)), "lr", strict=True):
        foot = leg.pose(angles[six])
        place = turned @ (data.site(f"hsr8/{side}_foot").xpos - base.xpos)
        np.testing.assert_allclose((foot.x, foot.y, foot.z), place, rtol=0.0, atol=1e-12)
        solved, error = leg.angles(foot)
        assert error < 1e-9
        np.testing.assert_allclose(solved, angles[six], atol=1e-8)


def test_neighbours_that_overlap_in_the_ready_posture_do_not_collide(load):
    def solid(root):
        for body in ("base", "l_hip_pitch_link", "r_hip_pitch_link"):
            part(root, "body", body).find("geom").attrib.update(contype="1", conaffinity="1")

    excluded = load(SmallHumanoid(), solid).spec.excludes
    pairs = {frozenset((pair.bodyname1, pair.bodyname2)) for pair in excluded}
    assert pairs == {frozenset(("base", f"{side}_hip_pitch_link")) for side in "lr"}
    assert not load(SmallHumanoid()).spec.excludes


def test_a_larger_mass_makes_the_walk_no_different_in_shape(load):
    light, heavy = load(SmallHumanoid()), load(SmallHumanoid(mass=1.5))
    np.testing.assert_allclose(light.model.ready[:12], heavy.model.ready[:12], atol=1e-6)
    assert heavy.model.mass == pytest.approx(1.5 * light.model.mass)


@pytest.mark.parametrize("fov", [None, 30.0])
def test_the_image_of_a_camera_without_a_neck_ends_above_the_horizon(load, fov):
    keys = "" if fov is None else f"vertical_fov_deg = {fov}\n"
    robot = load(SmallHumanoid(head=""), keys=keys)
    rotation, _ = robot.model.frame_pose(robot.model.tree.camera, robot.model.ready)
    elevation = np.degrees(np.arcsin(rotation[2, 2]))
    assert elevation + 0.5 * (fov or Camera().vertical_fov_deg) == pytest.approx(8.0, abs=1e-2)
    gaze = robot_table(robot)["navigation"]["gaze"]
    assert gaze["fixed_tilt"] == pytest.approx(np.radians(elevation))


def test_a_camera_that_the_model_names_keeps_its_field_of_view(load):
    lens = setting("camera", "eye", fovy="35")
    for keys, fov in (("", 35.0), ("vertical_fov_deg = 50.0", 50.0)):
        robot = load(SmallHumanoid(), lens, keys=f'camera = "eye"\n{keys}\n')
        assert robot_table(robot)["camera"] == {"vertical_fov_deg": fov}


@pytest.mark.parametrize(("effort", "limited"), [(60.0, False), (0.02, True)])
def test_the_head_accelerates_as_its_torque_allows(load, effort, limited):
    weak = setting("position", "head_pitch", forcerange=f"{-effort} {effort}")
    robot = load(SmallHumanoid(), weak)
    model = robot.spec.copy().compile()
    data, matrix = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, matrix)
    dof = int(model.joint("head_pitch").dofadr[0])
    usual = WalkingParameters().head.max_acceleration
    acceleration = robot_table(robot)["walking"]["head"]["max_acceleration"]
    assert (acceleration < usual) == limited
    assert acceleration == pytest.approx(min(usual, 0.5 * effort / matrix[dof, dof]), rel=5e-3)
