import numpy as np
import pytest

from hsr8.world.truth.clearance_kernel import gap_bounds


def world(seed):
    """Random arguments of `gap_bounds`: 5 obstacles and 9 geoms of the robot among 20."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(20)
    sizes, spheres = rng.uniform(0.05, 0.1, 5), rng.uniform(0.01, 0.1, 9)
    return rng.normal(size=(20, 3)), order[:5], sizes, order[5:14], spheres


@pytest.mark.parametrize("seed", range(10))
def test_compiled_and_plain_agree(seed):
    plain = gap_bounds.py_func(*world(seed))
    assert gap_bounds(*world(seed)) == pytest.approx(plain, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("seed", range(10))
def test_bounds_are_distances_seen_from_above(seed):
    places, obstacles, radii, geoms, spheres = world(seed)
    away = places[obstacles, None, :2] - places[None, geoms, :2]
    gaps = np.linalg.norm(away, axis=2) - spheres - radii[:, None]
    assert gap_bounds(places, obstacles, radii, geoms, spheres) == pytest.approx(gaps)
