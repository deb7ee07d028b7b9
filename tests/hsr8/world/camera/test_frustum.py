import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.robots.loaded import load_robot
from hsr8.world.body.kinematic import KinematicBody
from hsr8.world.camera.frustum import Frustum, culled
from hsr8.world.field.layout import Obstacle

RING = [
    Obstacle((1.2 * np.cos(angle), 1.2 * np.sin(angle)), 0.08, 0.3, "red")
    for angle in np.radians(np.arange(0, 360, 30))
]
SHAPE = (60, 80)


@pytest.fixture
def body(world, silent):
    layout, model = world(*RING)
    return KinematicBody(model, load_robot("hsr8"), layout, silent, np.random.default_rng(0))


def look(body, pan, tilt):
    body.data.joint("head_pan").qpos[0] = pan
    body.data.joint("head_tilt").qpos[0] = tilt
    body.update_kinematics()


@pytest.mark.gl
def test_without_what_it_misses_every_picture_is_the_same(body):
    model, rng = body.model, np.random.default_rng(1)
    frustum, usual = Frustum(model, "egocentric", SHAPE[1] / SHAPE[0]), model.geom_group.copy()
    with mujoco.Renderer(model, *SHAPE) as renderer:
        for pan, tilt in rng.uniform((-1.5, -1.0), (1.5, 0.3), (12, 2)):
            look(body, pan, tilt)
            missed = frustum.outside(body.data)
            assert missed.any()
            images = []
            for groups in (usual, np.where(missed, 5, usual)):
                model.geom_group[:] = groups
                renderer.update_scene(body.data, camera="egocentric")
                images.append(renderer.render())
            assert np.array_equal(*images)


RNG = np.random.default_rng(0)
NORMALS = np.array([[-0.8, 0, -0.6], [0.8, 0, -0.6], [0, -0.9, -0.4], [0, 0.9, -0.4], [0, 0, -1]])


def scene(geoms=60, boxes=5):
    rotation = Rotation.random(random_state=RNG.integers(1 << 30)).as_matrix()
    positions, eye = RNG.normal(0.0, 2.0, (geoms, 3)), RNG.normal(0.0, 1.0, 3)
    reach = RNG.uniform(0.0, 1.0, geoms)
    chosen = RNG.choice(geoms, boxes, replace=False)
    reach[chosen] = np.inf
    halves = RNG.uniform(0.0, 1.5, (boxes, 3))
    return positions, eye, rotation.ravel(), NORMALS, reach, chosen.astype(np.intp), halves


@pytest.mark.parametrize("_", range(5))
def test_culled_geoms_are_beyond_a_side(_):
    positions, eye, rotation, normals, reach, boxes, halves = scene()
    missed = culled(positions, eye, rotation, normals, reach, boxes, halves)
    inward = rotation.reshape(3, 3) @ normals.T
    depth = (positions - eye) @ inward
    wanted = (depth < -reach[:, None]).any(axis=1)
    wanted[boxes] = (depth[boxes] < -(halves @ np.abs(inward))).any(axis=1)
    assert np.array_equal(missed, wanted)
    assert missed.any()
