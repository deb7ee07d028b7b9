import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.sweep.bench.comparison import compare_entries
from hsr8.sweep.comparison_page import page, to_json

OUTCOMES = st.lists(
    st.sampled_from(["success", "timeout", "collision", "crashed"]), min_size=4, max_size=4
)


@settings(max_examples=8)
@given(OUTCOMES, OUTCOMES, OUTCOMES)
def test_swapping_the_entries_negates_every_difference(make_entry, a, b, c):
    one, other = make_entry("a", a, b), make_entry("b", c, a)
    forth, back = compare_entries(one, other), compare_entries(other, one)
    pairs = [*zip(forth.metrics, back.metrics, strict=True)]
    pairs += [(forth.families[f], back.families[f]) for f in forth.families]
    for d, e in pairs:
        assert d.metric == e.metric
        assert d.difference == pytest.approx(-e.difference)
        assert (d.low, d.high) == pytest.approx((-e.high, -e.low))
        assert d.p_value == pytest.approx(e.p_value)
        assert (d.only_a, d.only_b) == (e.only_b, e.only_a)


def test_worlds_pair_by_family_and_seed(make_entry):
    a = make_entry("a", course=("success", "timeout", "success"), crowd=("success",))
    b = make_entry("b", course=("success", "success", "refused"), crowd=("collision",) * 2)
    comparison = compare_entries(a, b)
    assert comparison.seeds == ("course 1000", "course 1001", "crowd 1000")
    success = comparison.metrics[0]
    assert (success.metric, success.test, success.n) == ("success", "McNemar", 3)
    assert (success.only_a, success.only_b) == (("crowd 1000",), ("course 1001",))
    assert {f: d.n for f, d in comparison.families.items()} == {"course": 2, "crowd": 1}
    assert next(d for d in comparison.metrics if d.metric == "spl").test == "Wilcoxon"


def test_a_crash_is_a_failure_and_nothing_else_is_known(make_entry):
    comparison = compare_entries(make_entry(), make_entry(course=("crashed",) * 4))
    numbers = {d.metric: d.n for d in comparison.metrics}
    assert numbers["success"] == numbers["spl"] == 8
    assert numbers["collision"] == numbers["min_clearance_m"] == 4


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"suite_hash": "0"}, "hash of the suite differs, got 0; expected 123abc"),
        ({"runs": {"course": []}}, "no common world: A has 8, B has 0"),
    ],
)
def test_entries_of_different_suites_are_refused(make_entry, change, message):
    with pytest.raises(UsageError, match=message):
        compare_entries(make_entry(), make_entry("mine", **change))


def test_entries_of_different_worlds_are_refused(make_entry, make_run):
    other = make_entry("mine", runs={"course": [make_run(1000, certified_time_s=61.0)]})
    with pytest.raises(UsageError, match=r"worlds for course 1000: .* is 60.0 in A, 61.0 in B"):
        compare_entries(make_entry(), other)


def test_settings_and_versions_that_differ_are_listed(make_entry):
    settings = {"robot.body": ('"kinematic"', '"full"'), "navigation.planner.method": ("1", "2")}
    other = make_entry("mine", settings=settings, versions={"hsr8": "0.2.0", "mine.py:M": "77"})
    value = to_json(compare_entries(make_entry(), other))
    assert value["settings"] | value["versions"] == {
        "hsr8": ["0.1.0", "0.2.0"],
        "code": ["1", "-"],
        "mujoco": ["4.0.0", "-"],
        "mine.py:M": ["-", "77"],
        "robot.body": ['"kinematic"', '"full"'],
        "navigation.planner.method": ["1", "2"],
    }


def test_the_page_and_the_json_hold_the_same_numbers(make_entry):
    comparison = compare_entries(make_entry("a"), make_entry("b", course=("timeout",) * 4))
    text = page([comparison], "hsr8 bench compare a b")
    assert "| course | 4 | 100.0 % | 0.0 % | -100.0 [" in text
    assert "| `success` | 8 | 100.0 % | 50.0 % | -50.0 points |" in text
    assert "Settings and versions are equal." in text
    value = json.loads(json.dumps(to_json(comparison)))
    assert value["results"]["success"]["difference"] == -0.5
    assert value["families"]["course"]["b"] == 0.0
