import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.sweep.summary import summarize

OUTCOMES = ["success", "timeout", "collision", "fall", "crashed", "refused"]


@pytest.mark.parametrize("outcome", OUTCOMES[1:5])
def test_a_failure_scores_zero(make_run, outcome):
    part = summarize([make_run(1, outcome)])
    assert (part.runs, part.success.count, part.spl, part.optimal_time_ratio) == (1, 0, 0.0, 0.0)
    assert "time_to_goal_s" not in part.quantities


def test_rates_are_of_the_runs_that_did_not_crash(make_run):
    part = summarize([make_run(k, outcome) for k, outcome in enumerate(OUTCOMES)])
    assert (part.runs, part.refused, part.success.count) == (5, 1, 1)
    for rate in (part.collision, part.timeout, part.fall):
        assert (rate.count, rate.n) == (1, 4)
    assert part.quantities["min_clearance_m"].n == 4


def test_length_and_time_are_compared_with_the_certificate(make_run):
    part = summarize([make_run(1, path_length_m=20.0, time_to_goal_s=40.0), make_run(2, "timeout")])
    assert part.spl == pytest.approx(0.25)
    assert part.optimal_time_ratio == pytest.approx(0.75)


def test_worlds_without_a_certified_path_score_successes_only(make_run):
    unknown = {"certified_time_s": None, "certified_length_m": None}
    part = summarize([make_run(1, **unknown), make_run(2)])
    assert part.success.count == 2
    assert part.spl == pytest.approx(0.8)
    assert summarize([make_run(1, **unknown)]).spl is None


def test_without_runs_nothing_is_measured(make_run):
    part = summarize([make_run(1, "refused")])
    assert (part.runs, part.success.n, part.spl, part.quantities) == (0, 0, None, {})


@given(outcomes=st.lists(st.sampled_from(OUTCOMES), min_size=1), length=st.floats(0.1, 99.0))
def test_spl_is_between_0_and_the_success_rate(make_run, outcomes, length):
    runs = [make_run(1, outcome, path_length_m=length) for outcome in outcomes]
    part = summarize(runs)
    if part.spl is not None:
        assert 0.0 <= part.spl <= part.success.fraction + 1e-12
