"""Straight movers together, compiled, against the same in plain Python and in NumPy."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.field import motion_kernel


@given(st.integers(0, 10**6), st.integers(0, 6))
def test_compiled_it_is_what_it_says(seed, count):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-np.pi, np.pi, count)
    length = np.where(rng.random(count) < 0.5, np.inf, rng.uniform(0.3, 3.0, count))
    origin, way = (
        rng.uniform(-3.0, 3.0, (count, 2)),
        np.column_stack([np.cos(angle), np.sin(angle)]),
    )
    speed, offset = rng.uniform(0.0, 0.5, count), rng.uniform(0.0, 6.0, count)
    lanes, times = (origin, way, speed, length, offset), rng.uniform(0.0, 600.0, 4)
    gone = np.mod(offset + speed * times[:, None], 2.0 * length)
    along = np.minimum(gone, 2.0 * length - gone)
    rate = np.where(gone[0] < length, speed, -speed)
    for positions, velocities in (
        (motion_kernel.positions, motion_kernel.velocities),
        (motion_kernel.positions.py_func, motion_kernel.velocities.py_func),
    ):
        np.testing.assert_array_equal(positions(times, lanes), origin + along[..., None] * way)
        np.testing.assert_array_equal(velocities(times[0], lanes), rate[:, None] * way)
