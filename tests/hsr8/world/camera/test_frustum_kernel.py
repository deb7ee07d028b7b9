import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.world.camera.frustum_kernel import outside

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
    missed = outside(positions, eye, rotation, normals, reach, boxes, halves)
    inward = rotation.reshape(3, 3) @ normals.T
    depth = (positions - eye) @ inward
    wanted = (depth < -reach[:, None]).any(axis=1)
    wanted[boxes] = (depth[boxes] < -(halves @ np.abs(inward))).any(axis=1)
    assert np.array_equal(missed, wanted)
    assert missed.any()


def test_a_corner_of_a_box_that_reaches_in_is_not_missed():
    positions, eye, rotation, normals, reach, boxes, halves = scene()
    corners = np.stack(np.meshgrid(*[[-1, 1]] * 3), -1).reshape(-1, 3)
    inside = (positions[boxes] - eye)[:, None] + corners * halves[:, None]
    within = (inside @ (rotation.reshape(3, 3) @ normals.T) >= 0.0).all(axis=2).any(axis=1)
    missed = outside(positions, eye, rotation, normals, reach, boxes, halves)[boxes]
    assert not (missed & within).any()
