import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.evaluation.efficiency import optimal_time_ratio, spl

POSITIVE = st.floats(0.1, 1000.0)


@given(st.booleans(), POSITIVE, POSITIVE)
def test_spl_is_between_0_and_success(success, shortest, actual):
    assert 0.0 <= spl(success, shortest, actual) <= success


@given(st.booleans(), POSITIVE)
def test_the_shortest_path_and_time_score_the_success(success, shortest):
    assert spl(success, shortest, shortest) == success
    assert optimal_time_ratio(success, shortest, shortest) == success


@given(POSITIVE, POSITIVE, POSITIVE)
def test_detours_cost_in_proportion_and_shortcuts_count_in_the_time_ratio_only(a, b, factor):
    shortest, longest = sorted((a, b))
    assert spl(True, shortest, longest) == pytest.approx(shortest / longest)
    assert spl(True, longest, shortest) == 1.0
    assert optimal_time_ratio(True, a, factor * a) == pytest.approx(1.0 / factor)
