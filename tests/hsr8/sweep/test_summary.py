import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.sweep.summary import summarize, worst_first


def test_counts(result):
    rows = [
        result(1),
        result(2, success=False, outcome="failed", collisions=2, collisions_moving=1, falls=1),
        result(3, arrival_error_deg=20.0, attempts=2),
        {"seed": 4, "outcome": "crashed", "attempts": 2},
        {"seed": 5, "outcome": "refused"},
        result(6, success=False, outcome="diverged", exit_reason="diverged"),
    ]
    summary = summarize(rows)
    assert summary.runs == 5
    assert (summary.refused, summary.crashed, summary.diverged, summary.repeated) == (1, 1, 1, 2)
    assert (summary.success.count, summary.success.n) == (2, 5)
    assert (summary.fall.count, summary.fall.n) == (1, 4)
    assert (summary.arrived.count, summary.arrived.n) == (1, 2)
    assert summary.counts["collisions"] == 2
    assert summary.counts["collisions_moving"] == 1
    assert summary.collisions_per_run == pytest.approx(0.5)
    assert summary.collisions_per_m == pytest.approx(2 / 40)
    assert summary.counts["falls"] == 1
    assert summary.exit_reasons == {"goal": 3, "crashed": 1, "diverged": 1}
    assert summary.quantities["time_to_goal_s"].n == 2
    assert summary.quantities["min_clearance_m"].n == 4


def test_an_empty_sweep_has_a_summary():
    summary = summarize([])
    assert summary.runs == 0
    assert summary.quantities == {}
    assert worst_first([]) == []


@settings(max_examples=25)
@given(st.permutations(range(6)))
def test_the_order_of_the_results_does_not_matter(order):
    rows = [
        {"seed": s, "outcome": "passed", "success": s > 2, "min_clearance_m": 0.1 * s, "falls": 0}
        for s in range(6)
    ]
    mixed = [rows[k] for k in order]
    assert summarize(mixed) == summarize(rows)
    assert worst_first(mixed) == worst_first(rows)


def test_worst_first(result):
    rows = [
        result(1),
        result(2, min_clearance_m=0.01),
        result(3, success=False, outcome="failed"),
        result(4, collisions=1, success=False),
        result(5, collisions=3, success=False),
        result(6, falls=1, success=False),
        result(7, outcome="diverged"),
        {"seed": 8, "outcome": "crashed"},
        {"seed": 9, "outcome": "refused"},
    ]
    assert [r["seed"] for r in worst_first(rows)] == [8, 7, 6, 5, 4, 3, 2, 1]
