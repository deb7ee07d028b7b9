"""HSR-VIII's MJCF keeps Menagerie's conventions and the promises of its README."""

from itertools import product
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.stats import qmc

from walking.body.joints import JOINT_NAMES

HERE = Path(__file__).parents[2] / "models" / "hsr8"
OBJECTS = [
    "body",
    "joint",
    "geom",
    "site",
    "camera",
    "light",
    "texture",
    "material",
    "pair",
    "exclude",
    "actuator",
    "sensor",
    "key",
]
COUNTS = {
    "camera": "ncam",
    "texture": "ntex",
    "material": "nmat",
    "actuator": "nu",
    "joint": "njnt",
}
MIRROR = np.array([1.0, -1.0, 1.0])
VISUAL_GROUP = 2


@pytest.fixture(scope="module", params=["hsr8.xml", "scene.xml"])
def model(request: pytest.FixtureRequest) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_path(str(HERE / request.param))


@pytest.fixture(scope="module")
def robot() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_path(str(HERE / "hsr8.xml"))


@pytest.fixture
def standing() -> tuple[mujoco.MjModel, mujoco.MjData]:
    scene = mujoco.MjModel.from_xml_path(str(HERE / "scene.xml"))
    data = mujoco.MjData(scene)
    mujoco.mj_resetDataKeyframe(scene, data, scene.key("walk_ready").id)
    return scene, data


def names(model: mujoco.MjModel, kind: str) -> list[str]:
    count = getattr(model, COUNTS.get(kind, f"n{kind}"))
    return [getattr(model, kind)(i).name for i in range(count)]


def mirror_rotation(quaternion: np.ndarray) -> np.ndarray:
    """The rotation seen in a mirror across the x-z plane, with a non-negative first element."""
    w, x, y, z = quaternion
    mirrored = np.array([w, -x, y, -z])
    return mirrored if w >= 0 else -mirrored


@pytest.mark.parametrize("kind", OBJECTS)
def test_everything_is_named(model: mujoco.MjModel, kind: str) -> None:
    assert all(names(model, kind))


@pytest.mark.parametrize("name", ["README.md", "CHANGELOG.md", "LICENSE", "scene.xml", "hsr8.png"])
def test_directory_is_complete(name: str) -> None:
    assert (HERE / name).stat().st_size > 0


def test_picture_is_light() -> None:
    assert (HERE / "hsr8.png").stat().st_size < 300_000


def test_actuators_follow_the_order_of_the_joints(robot: mujoco.MjModel) -> None:
    assert tuple(robot.joint(i).name for i in robot.actuator_trnid[:, 0]) == JOINT_NAMES
    assert names(robot, "actuator") == [f"{name}_act" for name in JOINT_NAMES]


def test_control_range_is_the_joint_range(robot: mujoco.MjModel) -> None:
    joints = robot.actuator_trnid[:, 0]
    assert robot.jnt_limited[joints].all()
    assert robot.actuator_ctrlrange == pytest.approx(robot.jnt_range[joints])


def test_every_joint_has_armature_and_damping(robot: mujoco.MjModel) -> None:
    assert (robot.dof_armature[6:] > 0).all()
    assert (robot.dof_damping[6:] > 0).all()


def test_mass_and_height_are_the_published_ones(robot: mujoco.MjModel) -> None:
    data = mujoco.MjData(robot)
    mujoco.mj_resetDataKeyframe(robot, data, robot.key("home").id)
    mujoco.mj_kinematics(robot, data)
    assert robot.body_mass.sum() == pytest.approx(5.5, abs=0.01)
    head = robot.geom("head_visual").id
    half = np.sqrt(((data.geom_xmat[head].reshape(3, 3)[2] * robot.geom_size[head]) ** 2).sum())
    assert data.geom_xpos[head, 2] + half == pytest.approx(0.528, abs=0.003)
    soles = [data.site(f"{side}_foot").xpos[2] for side in "lr"]
    assert soles == pytest.approx([0, 0], abs=1e-6)


@pytest.mark.parametrize(("key", "side"), [*product(["home", "walk_ready"], "lr")])
def test_keyframe_stands_flat_on_the_floor(robot: mujoco.MjModel, key: str, side: str) -> None:
    data = mujoco.MjData(robot)
    mujoco.mj_resetDataKeyframe(robot, data, robot.key(key).id)
    mujoco.mj_kinematics(robot, data)
    foot = data.site(f"{side}_foot")
    assert foot.xpos[2] == pytest.approx(0, abs=5e-4)
    assert foot.xmat[8] == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("key", ["home", "walk_ready"])
def test_keyframe_keeps_all_limits(robot: mujoco.MjModel, key: str) -> None:
    frame = robot.key(key)
    address = robot.jnt_qposadr[robot.actuator_trnid[:, 0]]
    lower, upper = robot.actuator_ctrlrange.T
    assert frame.ctrl == pytest.approx(frame.qpos[address])
    assert (frame.ctrl >= lower).all()
    assert (frame.ctrl <= upper).all()
    assert np.linalg.norm(frame.qpos[3:7]) == pytest.approx(1)


def test_left_mirrors_right_in_bodies(robot: mujoco.MjModel) -> None:
    lefts = [name for name in names(robot, "body") if name.startswith("l_")]
    assert lefts
    for name in lefts:
        left, right = robot.body(name), robot.body("r" + name[1:])
        assert left.mass == pytest.approx(right.mass), name
        assert left.inertia == pytest.approx(right.inertia), name
        assert left.pos == pytest.approx(right.pos * MIRROR), name
        assert left.ipos == pytest.approx(right.ipos * MIRROR), name


def test_left_mirrors_right_in_joints(robot: mujoco.MjModel) -> None:
    """A pitch turns alike on both sides; roll and yaw turn the other way."""
    lefts = [name for name in JOINT_NAMES if name.startswith("l_")]
    for name in lefts:
        left, right = robot.joint(name), robot.joint("r" + name[1:])
        assert left.axis == pytest.approx(right.axis), name
        pitch = abs(left.axis[1]) > 0.5
        expected = right.range if pitch else -right.range[::-1]
        assert left.range == pytest.approx(expected), name
        for field in ("armature", "damping", "frictionloss"):
            assert getattr(left, field) == pytest.approx(getattr(right, field)), (name, field)
        ours, theirs = robot.actuator(f"{name}_act"), robot.actuator(f"r{name[1:]}_act")
        for field in ("forcerange", "gainprm", "biasprm"):
            assert getattr(ours, field) == pytest.approx(getattr(theirs, field)), (name, field)


def test_left_mirrors_right_in_shapes(robot: mujoco.MjModel) -> None:
    lefts = [name for name in names(robot, "geom") if name.startswith("l_")]
    assert lefts
    for name in lefts:
        left, right = robot.geom(name), robot.geom("r" + name[1:])
        assert left.type == right.type, name
        assert left.size == pytest.approx(right.size), name
        assert left.pos == pytest.approx(right.pos * MIRROR), name
        assert left.matid == right.matid, name
        # Shapes are alike under half turns, so compare the axes of the frames up to their signs.
        a, b = (np.empty(9), np.empty(9))
        mujoco.mju_quat2Mat(a, left.quat)
        mujoco.mju_quat2Mat(b, mirror_rotation(right.quat))
        assert np.abs(a) == pytest.approx(np.abs(b), abs=1e-6), name


def test_visuals_are_only_for_looking(robot: mujoco.MjModel) -> None:
    visual = robot.geom_group == VISUAL_GROUP
    assert visual.any()
    assert not robot.geom_contype[visual].any()
    assert not robot.geom_conaffinity[visual].any()
    assert (robot.geom_matid[visual] >= 0).all()
    named = np.array([name.endswith("_visual") for name in names(robot, "geom")])
    assert (named == visual).all()


def test_no_geom_adds_mass(robot: mujoco.MjModel) -> None:
    """Every inertia is written out: changing a shape never changes the dynamics."""
    spec = mujoco.MjSpec.from_file(str(HERE / "hsr8.xml"))
    assert all(body.explicitinertial for body in spec.bodies[1:])
    assert all(geom.mass == 0 for geom in spec.geoms)


def test_colors_stay_out_of_the_obstacle_classes(robot: mujoco.MjModel) -> None:
    """The robot's own eyes take saturated colours for obstacles and beacons."""
    visual = robot.geom_group == VISUAL_GROUP
    colors = robot.mat_rgba[robot.geom_matid[visual], :3]
    saturation = 1 - colors.min(axis=1) / colors.max(axis=1)
    assert (saturation < 0.15).all()


def test_nothing_of_the_head_stands_before_the_camera(robot: mujoco.MjModel) -> None:
    """Corner rays and centre ray of the camera leave the head freely, at any pan and tilt."""
    data = mujoco.MjData(robot)
    mujoco.mj_resetDataKeyframe(robot, data, robot.key("home").id)
    mujoco.mj_forward(robot, data)
    head = robot.body("head_tilt_link").id
    camera = data.camera("egocentric")
    seen = np.arange(mujoco.mjNGROUP) == VISUAL_GROUP
    tall = np.tan(np.radians(robot.camera("egocentric").fovy[0]) / 2)
    for u, v in product(np.linspace(-4 / 3, 4 / 3, 9), np.linspace(-1, 1, 7)):
        ray = camera.xmat.reshape(3, 3) @ np.array([u * tall, v * tall, -1.0])
        hit = np.array([-1], dtype=np.int32)
        mujoco.mj_ray(robot, data, camera.xpos, ray, seen.astype(np.uint8), 1, -1, hit)
        assert hit[0] < 0 or robot.geom_bodyid[hit[0]] != head, (u, v)


def test_control_noise_raises_no_warning(
    standing: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    """One second of quasi-random set-points within all limits, 25 of them per second."""
    scene, data = standing
    lower, upper = scene.actuator_ctrlrange.T
    noise = qmc.Halton(scene.nu, rng=np.random.default_rng(0)).random(25)
    for control in lower + noise * (upper - lower):
        data.ctrl = control
        mujoco.mj_step(scene, data, nstep=16)
    assert data.time == pytest.approx(1)
    assert not data.warning.number.any()
    assert np.isfinite(data.qpos).all()


def test_walk_ready_stands(standing: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    scene, data = standing
    mujoco.mj_step(scene, data, nstep=400)
    root = scene.key("walk_ready").qpos[:3]
    assert data.body("base_link").xmat[8] > np.cos(0.05)
    assert data.qpos[:2] == pytest.approx(root[:2], abs=0.01)
    assert data.qpos[2] == pytest.approx(root[2], abs=0.005)
    weight = scene.body_mass.sum() * 9.81
    pads = [
        data.sensor(f"{foot}_sole_{pad}_force").data[0]
        for foot in "lr"
        for pad in ("fl", "fr", "bl", "br")
    ]
    assert sum(pads) == pytest.approx(weight, rel=0.05)


@pytest.mark.parametrize("yaw", [0.3, 1.1, 2.0, -2.7])
def test_pads_feel_the_whole_load_wherever_the_feet_point(
    standing: tuple[mujoco.MjModel, mujoco.MjData], yaw: float
) -> None:
    """The floor pushes at the very corners of the soles, where rounding decides on in or out."""
    scene, data = standing
    data.qpos[:2] = 1.7 * np.sin(yaw), 0.9 * np.cos(yaw)
    data.qpos[3:7] = np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)
    soles = [scene.geom(f"{foot}_sole").id for foot in "lr"]
    force, ratios = np.zeros(6), []
    for _ in range(200):
        mujoco.mj_step(scene, data)
        mujoco.mj_forward(scene, data)
        pushed = 0.0
        for index in range(data.ncon):
            if np.isin(data.contact[index].geom, soles).any():
                mujoco.mj_contactForce(scene, data, index, force)
                pushed += force[0]
        felt = sum(
            data.sensor(f"{foot}_sole_{pad}_force").data[0]
            for foot in "lr"
            for pad in ("fl", "fr", "bl", "br")
        )
        ratios.append(felt / pushed)
    assert ratios == pytest.approx([1.0] * len(ratios), rel=1e-6)
