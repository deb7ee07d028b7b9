import numpy as np
import pytest

from hsr8.world.clearance_kernel import nearest


def world(seed):
    """Random arguments of `nearest`: 5 obstacles and 9 geoms of the robot among 20."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(20)
    robot = rng.normal(size=3)
    sizes, spheres = rng.uniform(0.05, 0.1, 5), rng.uniform(0.01, 0.1, 9)
    return rng.normal(size=(20, 3)), robot, order[:5], sizes, order[5:14], spheres, np.zeros(9)


@pytest.mark.parametrize("seed", range(10))
def test_compiled_and_plain_agree(seed):
    compiled, plain = world(seed), world(seed)
    assert nearest(*compiled) == nearest.py_func(*plain)
    assert np.array_equal(compiled[-1], plain[-1])


@pytest.mark.parametrize("seed", range(10))
def test_gap_and_bounds_are_distances_seen_from_above(seed):
    places, robot, obstacles, radii, geoms, spheres, bounds = world(seed)
    gap, found = nearest(places, robot, obstacles, radii, geoms, spheres, bounds)
    gaps = np.linalg.norm(places[obstacles, :2] - robot[:2], axis=1) - radii
    assert found == np.argmin(gaps)
    assert gap == pytest.approx(gaps.min())
    away = np.linalg.norm(places[geoms, :2] - places[obstacles[found], :2], axis=1)
    assert bounds == pytest.approx(away - spheres - radii[found])
