from contextlib import closing
from copy import copy

import cv2
import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import Camera, CameraNoise
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.camera.offscreen import Offscreen
from hsr8.world.camera.rendered import RenderedCamera, angular_velocity
from vision.camera import PinholeCamera
from vision.detector import Detector
from vision.parameters import VisionParameters
from walking.body.tree import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD
from walking.state import HeadCameraPose, JointTargets

CLEAN = Camera(noise=CameraNoise(pixel=0.0, exposure=0.0))
pytestmark = pytest.mark.gl


def test_an_image_shows_the_world_as_it_is_now(body):
    with closing(RenderedCamera(body.model, CLEAN, np.random.default_rng(0))) as camera:
        before = camera.capture(body)()
        again = camera.capture(body)()
        body.data.joint("head_pan").qpos[0] = 0.5
        body.data.qpos[:2] += 2.0
        turned = camera.capture(body)()
        body.data.joint("head_pan").qpos[0] = 0.0
        body.data.qpos[:2] -= 2.0
        back = camera.capture(body)()
    assert before.shape == (240, 320, 3)
    assert before.dtype == np.uint8
    assert np.array_equal(before, again)
    assert not np.array_equal(before, turned)
    assert np.array_equal(before, back)  # the previous pose has no effect


def test_vision_locates_the_obstacle(body):
    with closing(RenderedCamera(body.model, CLEAN, np.random.default_rng(0))) as camera:
        image = camera.capture(body)()
    fixed = body.data.camera("egocentric")
    rotation = fixed.xmat.reshape(3, 3) * (1.0, -1.0, -1.0)
    pinhole = PinholeCamera.from_vertical_fov(320, 240, np.radians(70.0))
    pose = HeadCameraPose(rotation, fixed.xpos.copy(), 0.0, -0.3)
    detections = Detector(pinhole, VisionParameters()).detect(image, pose)
    red = [d for d in detections if d.label == "red"]
    assert len(red) == 1
    assert np.isclose(red[0].distance, np.hypot(1.0, 0.2), atol=0.02)
    assert np.isclose(red[0].bearing, np.arctan2(0.2, 1.0), atol=0.01)
    assert np.isclose(red[0].radius, 0.08, atol=0.005)


@pytest.mark.parametrize("read_at_once", [True, False])
def test_noise_follows_the_order_of_captures_not_of_reads(body, read_at_once):
    settings = Camera(noise=CameraNoise(pixel=3.0, exposure=0.1))

    def third(*at_once):
        model = copy(body.model)  # whose lights a camera dims
        with closing(RenderedCamera(model, settings, np.random.default_rng(1))) as camera:
            for wait in at_once:
                read = camera.capture(body)
                if wait:
                    read()
            return read()

    assert np.array_equal(third(read_at_once, False, True), third(True, True, True))


def attitude(body):
    body.update_kinematics()
    return body.data.camera("egocentric").xmat.reshape(3, 3) * (1.0, -1.0, -1.0)


@pytest.mark.parametrize("kind", [KinematicBody, PhysicsBody])
def test_the_camera_turns_as_its_attitude_does(world, silent, kind):
    layout, model = world()
    body = kind(model, load_robot("hsr8"), layout, silent, np.random.default_rng(0))
    position = body.sense().joint_position.copy()
    pan, tilt, hip = (JOINT_NAMES.index(n) for n in ("head_pan", "head_tilt", "l_hip_yaw"))
    for _ in range(20):
        position[pan] += 0.01
        position[tilt] -= 0.004
        position[hip] += 0.001  # the foot stays, so the trunk turns
        before = attitude(body)
        body.apply(JointTargets(position.copy(), position.copy()))
        after = attitude(body)
        rate = angular_velocity(body.model, body.data)
    mean = cv2.Rodrigues(before.T @ after)[0].ravel() / CONTROL_PERIOD
    assert np.linalg.norm(mean) > 1.5
    assert rate == pytest.approx(mean, abs=0.06)


@pytest.mark.parametrize("shutter", [0.0, 10.0])
def test_only_a_turning_camera_with_an_open_shutter_smears(body, shutter):
    settings = CLEAN.model_copy(update={"shutter_ms": shutter})
    with closing(RenderedCamera(body.model, settings, np.random.default_rng(0))) as camera:
        still = camera.capture(body)()
        body.data.joint("head_pan").qvel[0] = 5.0
        turned = camera.capture(body)()
    with closing(RenderedCamera(body.model, CLEAN, np.random.default_rng(0))) as camera:
        assert np.array_equal(still, camera.capture(body)())
    assert np.array_equal(still, turned) == (shutter == 0.0)


CAMERA, WIDTH, HEIGHT = "egocentric", 96, 72


def look_aside(body):
    body.data.joint("head_pan").qpos[0] += 0.4
    body.update_kinematics()


def test_it_draws_what_mujoco_s_own_renderer_draws(body):
    with (
        closing(Offscreen(body.model, CAMERA, WIDTH, HEIGHT)) as offscreen,
        mujoco.Renderer(body.model, HEIGHT, WIDTH) as renderer,
    ):
        for _ in range(3):
            look_aside(body)
            offscreen.begin(body.data)
            renderer.update_scene(body.data, camera=CAMERA)
            assert np.array_equal(offscreen.read(), renderer.render())


def test_neither_the_world_nor_another_picture_changes_one_that_was_begun(body):
    with (
        closing(Offscreen(body.model, CAMERA, WIDTH, HEIGHT)) as offscreen,
        mujoco.Renderer(body.model, HEIGHT, WIDTH) as renderer,
    ):
        offscreen.begin(body.data)
        at_once = offscreen.read()
        offscreen.begin(body.data)
        look_aside(body)
        renderer.update_scene(body.data, camera=CAMERA)
        other = renderer.render()
        late = offscreen.read()
    assert np.array_equal(at_once, late)
    assert not np.array_equal(late, other)
    assert late.base is None  # its own memory
