import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navigation.angles import wrap, wrap_array, wrapped

angles = st.floats(-1e4, 1e4)


@given(angles)
def test_wrap_keeps_the_direction_and_the_interval(a):
    w = wrap(a)
    assert -math.pi < w <= math.pi
    assert math.isclose(math.cos(w), math.cos(a), abs_tol=1e-9)
    assert math.isclose(math.sin(w), math.sin(a), abs_tol=1e-9)


@given(angles)
def test_array_version_agrees_with_the_scalar_one(a):
    w = float(wrap_array([a])[0])
    assert -math.pi < w <= math.pi
    assert abs(wrap(w - wrap(a))) < 1e-9


@pytest.mark.parametrize("a", [math.pi, -math.pi, 3 * math.pi, np.nextafter(math.pi, 4.0)])
def test_the_seam_belongs_to_plus_pi(a):
    assert wrap(math.pi) == math.pi
    assert wrap(-math.pi) == math.pi
    assert -math.pi < float(wrap_array(a)) <= math.pi


@pytest.mark.parametrize("a", [0.0, 3.0, math.pi, -math.pi, 7.0, -40.0])
def test_the_compiled_version_agrees_with_the_scalar_one(a):
    assert wrapped(a) == pytest.approx(wrap(a), abs=1e-12)


def test_array_version_leaves_its_argument_alone():
    a = np.array([4.0, -4.0])
    wrap_array(a)
    assert a.tolist() == [4.0, -4.0]
