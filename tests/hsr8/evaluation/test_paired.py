import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.evaluation.paired import compare_paired

VALUES = st.lists(st.floats(-100, 100).map(lambda v: round(v, 3)), min_size=2, max_size=12)


@settings(max_examples=8, deadline=None)
@given(VALUES, st.floats(0.5, 10.0))
def test_a_shift_is_found_exactly(values, shift):
    a = np.array(values)
    found = compare_paired(a, a + shift)
    assert found.mean == pytest.approx(shift)
    assert (found.low, found.high) == pytest.approx((shift, shift))
    assert found.n == len(values)


@settings(max_examples=8, deadline=None)
@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=6))
def test_swapping_turns_it_round(pairs):
    a, b = np.array(pairs, float).T
    one, other = compare_paired(a, b), compare_paired(b, a)
    assert one.mean == -other.mean
    assert (one.low, one.high) == pytest.approx((-other.high, -other.low))
    assert one.p_value == pytest.approx(other.p_value)
    assert one.low <= one.mean <= one.high


def test_the_same_is_no_difference():
    a = np.array([1.0, 2.0, 3.0])
    found = compare_paired(a, a)
    assert (found.mean, found.low, found.high, found.p_value) == (0.0, 0.0, 0.0, 1.0)


def test_a_clear_difference_is_significant_and_noise_is_not():
    rng = np.random.default_rng(3)
    a, noise = rng.normal(size=(2, 40))
    assert compare_paired(a, a + 1.0 + 0.3 * noise).p_value < 1e-6
    assert compare_paired(a, a + noise - noise.mean()).p_value > 0.05


@pytest.mark.parametrize("b", [[1.0], [1.0, np.nan], [[1.0, 2.0]]])
def test_what_does_not_pair_is_refused(b):
    with pytest.raises(ValueError):
        compare_paired(np.array([1.0, 2.0]), np.array(b))
