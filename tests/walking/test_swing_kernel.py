"""The compiled reaction of the legs against the same in plain Python."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walking import swing_kernel


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(0, 4))
def test_compiled_it_is_what_it_says(plainly, seed, count):
    rng = np.random.default_rng(seed)
    swings = rng.uniform(-0.1, 0.1, (count, 10))
    swings[:, 0] = np.arange(count) * 60 + rng.integers(-40, 20)
    moments = tuple(tuple(rng.normal(0.0, 100.0, 6).tolist()) for _ in range(2))
    state = tuple(rng.normal(0.0, 0.01, 4).tolist())
    asked = (swings, *moments, (7e-4, 0.012, 3e-4), state, (7.2, 0.005))
    found, plain = swing_kernel.react(*asked), plainly(swing_kernel, "react", *asked)
    np.testing.assert_allclose(found, plain, rtol=1e-12, atol=1e-15)
