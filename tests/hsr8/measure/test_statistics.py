import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.measure.statistics import (
    Proportion,
    compare_successes,
    compare_values,
    holm,
    optimal_time_ratio,
    spl,
)

SUCCESSES = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=60)
VALUES = st.lists(st.floats(-100, 100).map(lambda v: round(v, 3)), min_size=2, max_size=12)


@settings(max_examples=8, deadline=None)
@given(VALUES, st.floats(0.5, 10.0))
def test_a_shift_is_found_exactly(values, shift):
    a = np.array(values)
    found = compare_values(a, a + shift)
    assert found.difference == pytest.approx(shift)
    assert (found.low, found.high) == pytest.approx((shift, shift))
    assert found.n == len(values)


@settings(max_examples=8, deadline=None)
@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=6))
def test_swapping_turns_it_round(pairs):
    a, b = np.array(pairs, float).T
    one, other = compare_values(a, b), compare_values(b, a)
    assert one.difference == -other.difference
    assert (one.low, one.high) == pytest.approx((-other.high, -other.low))
    assert one.p_value == pytest.approx(other.p_value)
    assert one.low <= one.difference <= one.high


def test_the_same_is_no_difference():
    a = np.array([1.0, 2.0, 3.0])
    found = compare_values(a, a)
    assert (found.difference, found.low, found.high, found.p_value) == (0.0, 0.0, 0.0, 1.0)


def test_a_clear_difference_is_significant_and_noise_is_not():
    rng = np.random.default_rng(3)
    a, noise = rng.normal(size=(2, 40))
    assert compare_values(a, a + 1.0 + 0.3 * noise).p_value < 1e-6
    assert compare_values(a, a + noise - noise.mean()).p_value > 0.05


@pytest.mark.parametrize("b", [[1.0], [1.0, np.nan], [[1.0, 2.0]]])
def test_what_does_not_pair_is_refused(b):
    with pytest.raises(ValueError):
        compare_values(np.array([1.0, 2.0]), np.array(b))


def successes(pairs):
    return compare_successes(*zip(*pairs, strict=True))


@settings(max_examples=30, deadline=None)
@given(SUCCESSES)
def test_swapping_proportions_negates_the_difference_and_keeps_the_p_value(pairs):
    one, other = successes(pairs), successes([(b, a) for a, b in pairs])
    assert one.difference == -other.difference == pytest.approx(one.b - one.a)
    assert (one.n, one.a, one.b) == (len(pairs), other.b, other.a)
    assert one.p_value == pytest.approx(other.p_value)
    assert (one.low, one.high) == pytest.approx((-other.high, -other.low))
    assert -1.0 <= one.low <= one.difference <= one.high <= 1.0
    assert 0.0 < one.p_value <= 1.0


@settings(max_examples=30, deadline=None)
@given(SUCCESSES, st.integers(1, 50))
def test_seeds_with_equal_outcomes_do_not_change_the_p_value(pairs, more):
    assert successes(pairs + [(True, True)] * more).p_value == successes(pairs).p_value


def test_discordant_pairs_are_a_binomial_test():
    better, equal = [(False, True)] * 5, [(True, True)] * 90
    assert successes([*equal, *better]).p_value == pytest.approx(2 * 0.5**5)
    assert successes([(True, False), (False, True)]).p_value == 1.0
    assert successes(equal).p_value == 1.0


def test_the_interval_is_wilson_s():
    some = Proportion.counted(19, 20)
    assert (some.low, some.high) == pytest.approx((0.7639, 0.9911), abs=1e-4)
    assert str(some) == "19 of 20, 95.0 % (76.4 to 99.1 %)"
    assert Proportion.counted(0, 5).low == 0.0
    assert Proportion.counted(5, 5).high == 1.0


def test_without_runs_the_interval_is_everything():
    assert Proportion.counted(0, 0) == Proportion(0, 0, 0.0, 0.0, 1.0)
    assert str(Proportion.counted(0, 0)) == "none"


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


@given(st.lists(st.floats(0.0, 1.0), max_size=8))
def test_holm_rejects_as_the_step_down_procedure(p_values):
    """At any level, the smallest p-values are rejected as long as p (n - rank) is at most it."""
    for level in (0.01, 0.05, 0.5):
        rejected = 0
        for rank, p in enumerate(sorted(p_values)):
            if min(1.0, p * (len(p_values) - rank)) > level:
                break
            rejected += 1
        assert sum(p <= level for p in holm(p_values)) == rejected
