import numpy as np

from navigation.belief.association_kernel import overlapping


def test_overlapping_are_the_pairs_nearer_than_their_radii():
    rng = np.random.default_rng(1)
    centres, radii = rng.uniform(-1, 1, (12, 2)), rng.uniform(0.1, 0.3, 12)
    apart = np.hypot(*(centres[:, None] - centres).transpose(2, 0, 1))
    wanted = np.argwhere(np.triu(apart < radii[:, None] + radii, 1))
    assert np.array_equal(overlapping(centres, radii), wanted)
    assert np.array_equal(overlapping.py_func(centres, radii), wanted)
    assert 3 < len(wanted) < 60
