"""Table of planned swings."""

import numpy as np
import pytest

from walking.gait import swing_kernel

ZMP_OFFSET = (0.01, 0.003)


def draw(seed, count):
    """A generator, and swings that begin with one under way: the arguments of `swings`."""
    rng = np.random.default_rng(seed)
    feet = rng.uniform(-0.3, 0.3, (3 + count, 4))
    feet[:, 3] = np.arange(3 + count) % 2
    support, origin, landing = map(tuple, feet[:3].tolist())
    now, later = (int(rng.integers(-40, 20)), 0.02, count > 0), (40, 68, 0.025)
    return rng, ((support, origin, landing), feet[3:], now, later, ZMP_OFFSET)


def test_every_foot_swings_from_where_it_stands_to_where_it_stands_next():
    feet, steps, _, later, zmp_offset = draw(4, 4)[1]
    support, origin, landing = feet
    table = swing_kernel.swings(feet, steps, (-3, 0.02, True), later, zmp_offset)
    assert table[:, 0].tolist() == [-3.0, 40.0, 108.0, 176.0]
    assert table[:, 1].tolist() == [0.02, 0.025, 0.025, 0.025]
    starts, goals = [origin, support, landing, *steps[1:]], [landing, *steps[1:]]
    np.testing.assert_array_equal(table[:, 2:5], np.array(starts)[:4, :3])
    np.testing.assert_array_equal(table[:, 5:8], np.array(goals)[:, :3])
    for row, (x, y, yaw, left) in zip(table, [support, landing, *steps[1:]], strict=False):
        under = complex(x, y) + np.exp(1j * yaw) * complex(
            ZMP_OFFSET[0], ZMP_OFFSET[1] * (1.0 - 2.0 * left)
        )
        assert complex(*row[8:]) == pytest.approx(under, abs=1e-15)
    held = swing_kernel.swings(feet, steps, (-3, 0.02, False), later, zmp_offset)
    np.testing.assert_array_equal(held, table[1:])
