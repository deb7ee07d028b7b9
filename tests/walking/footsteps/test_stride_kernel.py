"""Strides of a velocity."""

from math import cos, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.footsteps import stride_kernel

LIMITS = (0.085, 0.042, 0.3)
HALF, GAP, HEEL, TOE, WIDTH = BUILD = (0.042, 0.012, -0.0425, 0.0625, 0.03)
TIME = 0.34
velocities = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(-2.0, 2.0))


@given(velocities)
def test_a_mirrored_velocity_swaps_the_strides(velocity):
    vx, vy, wz = velocity
    here, there, moved = stride_kernel.strides(velocity, TIME, LIMITS, BUILD)
    mirrored = stride_kernel.strides((vx, -vy, -wz), TIME, LIMITS, BUILD)
    assert mirrored == ((there[0], -there[1], -there[2]), (here[0], -here[1], -here[2]), moved)


@given(velocities)
def test_two_footsteps_move_the_stance_by_the_velocity_where_no_limit_binds(velocity):
    right, left, moved = stride_kernel.strides(velocity, TIME, LIMITS, BUILD)
    vx, vy, wz = velocity
    longest = (abs(vx) * TIME, 2.0 * abs(vy) * TIME, 2.0 * abs(wz) * TIME)
    if moved or any(np.array(longest) > LIMITS):
        return
    middle, heading = 0.0, 0.0
    for (x, y, turned), stance in ((right, -HALF), (left, HALF)):
        # From the middle of the stance to that of the next, from the support foot's side.
        displacement = x + 1j * y - 1j * stance - 1j * stance * np.exp(1j * turned)
        middle += np.exp(-0.5j * turned) * displacement
        heading += turned
    assert middle == pytest.approx(2.0 * TIME * (vx + 1j * vy), abs=1e-12)
    assert heading == pytest.approx(2.0 * TIME * wz, abs=1e-12)


@given(st.floats(-0.2, 0.2), st.floats(-0.5, 0.5), st.sampled_from((-1.0, 1.0)))
def test_a_clear_landing_has_every_corner_beside_the_other_sole(y, turned, side):
    result = stride_kernel.clear(y, turned, side, GAP, (HEEL, TOE, WIDTH))
    inner = min(
        side * (result + sin(turned) * u + cos(turned) * v)
        for u in (HEEL, TOE)
        for v in (-WIDTH, WIDTH)
    )
    assert inner >= WIDTH + GAP - 1e-12
    assert result == y or inner == pytest.approx(WIDTH + GAP, abs=1e-12)
