from contextlib import closing

import mujoco
import numpy as np
import pytest

from hsr8.world.camera.offscreen import Offscreen

CAMERA, WIDTH, HEIGHT = "egocentric", 96, 72
pytestmark = pytest.mark.gl


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
