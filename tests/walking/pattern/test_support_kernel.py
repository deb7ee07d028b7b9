"""Where the floor can push, compiled: against the same in plain Python."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.pattern import support_kernel


@settings(max_examples=30)
@given(st.integers(0, 10**6))
def test_compiled_it_is_what_it_says(plainly, seed):
    rng = np.random.default_rng(seed)
    turns = rng.uniform(-1.0, 1.0, 2)
    soles = [(*rng.normal(0.0, 0.05, 2), np.cos(turn), np.sin(turn)) for turn in turns]
    region = np.array([*soles[0], *soles[seed % 2], 0.05, 0.03])
    corners = rng.normal(0.0, 0.1, (5, 2))
    ways = np.roll(corners, -1, axis=0) - corners
    edges = np.column_stack([corners, ways, np.hypot(*ways.T)])
    x, y = rng.normal(0.0, 0.1, 2).tolist()
    for name, table in (("fraction", region), ("clip", region), ("depth", edges)):
        assert getattr(support_kernel, name)(table, x, y) == plainly(
            support_kernel, name, table, x, y
        )
