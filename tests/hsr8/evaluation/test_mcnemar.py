import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.evaluation.mcnemar import PairedOutcomes

SUCCESSES = st.lists(st.tuples(st.booleans(), st.booleans()), max_size=60)


def _count(pairs):
    return PairedOutcomes.count([a for a, _ in pairs], [b for _, b in pairs])


@settings(max_examples=30, deadline=None)
@given(SUCCESSES)
def test_swapping_turns_the_difference_round_and_keeps_the_p_value(pairs):
    one, other = _count(pairs), _count([(b, a) for a, b in pairs])
    assert one.difference == -other.difference
    assert one.p_value() == pytest.approx(other.p_value())
    low, high = one.interval()
    assert other.interval() == pytest.approx((-high, -low))
    assert -1.0 <= low <= one.difference <= high <= 1.0
    assert 0.0 < one.p_value() <= 1.0


@settings(max_examples=30, deadline=None)
@given(SUCCESSES, st.integers(1, 50))
def test_seeds_that_did_not_change_do_not_touch_the_p_value(pairs, more):
    assert _count(pairs + [(True, True)] * more).p_value() == _count(pairs).p_value()


def test_only_one_way_is_a_run_of_coins():
    assert PairedOutcomes(90, 0, 5, 5).p_value() == pytest.approx(2 * 0.5**5)
    assert PairedOutcomes(3, 2, 2, 1).p_value() == 1.0
    assert PairedOutcomes(3, 0, 0, 1).p_value() == 1.0


def test_counts():
    pairs = [(True, True), (True, False), (False, True), (False, True), (False, False)]
    assert _count(pairs) == PairedOutcomes(1, 1, 2, 1)
    assert _count(pairs).difference == pytest.approx(0.2)
