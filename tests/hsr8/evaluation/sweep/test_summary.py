import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.evaluation.sweep.summary import summarize, worst_first


def test_counts(row):
    rows = [
        row(1),
        row(2, success=False, outcome="failed", collisions=2, collisions_moving=1, falls=1),
        row(3, arrival_error_deg=20.0, attempts=2),
        {"seed": 4, "outcome": "crashed", "attempts": 2},
        {"seed": 5, "outcome": "refused"},
        row(6, success=False, outcome="diverged", exit_reason="diverged"),
    ]
    summary = summarize(rows)
    assert summary.runs == 5
    assert (summary.refused, summary.crashed, summary.diverged, summary.retried) == (1, 1, 1, 2)
    assert (summary.success.count, summary.success.of) == (2, 5)
    assert (summary.without_fall.count, summary.without_fall.of) == (3, 4)
    assert (summary.arrived.count, summary.arrived.of) == (1, 2)
    assert summary.collisions == {"all": 2, "moving": 1, "static": 0, "closing": 0}
    assert summary.collisions_per_run == pytest.approx(0.5)
    assert summary.collisions_per_metre == pytest.approx(2 / 40)
    assert summary.falls == 1
    assert summary.ended == {"goal": 3, "crashed": 1, "diverged": 1}
    assert summary.quantities["time_to_goal_s"].n == 2
    assert summary.quantities["min_clearance_m"].n == 4


def test_nothing_is_no_mistake():
    summary = summarize([])
    assert summary.runs == 0
    assert summary.quantities == {}
    assert worst_first([]) == []


@settings(max_examples=25)
@given(st.permutations(range(6)))
def test_the_order_of_the_rows_does_not_matter(row_order):
    rows = [
        {"seed": s, "outcome": "passed", "success": s > 2, "min_clearance_m": 0.1 * s, "falls": 0}
        for s in range(6)
    ]
    mixed = [rows[k] for k in row_order]
    assert summarize(mixed) == summarize(rows)
    assert worst_first(mixed) == worst_first(rows)


def test_worst_first(row):
    rows = [
        row(1),
        row(2, min_clearance_m=0.01),
        row(3, success=False, outcome="failed"),
        row(4, collisions=1, success=False),
        row(5, collisions=3, success=False),
        row(6, falls=1, success=False),
        row(7, outcome="diverged"),
        {"seed": 8, "outcome": "crashed"},
        {"seed": 9, "outcome": "refused"},
    ]
    assert [r["seed"] for r in worst_first(rows)] == [8, 7, 6, 5, 4, 3, 2, 1]
