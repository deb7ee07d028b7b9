import pytest

from hsr8.evaluation.verdict import exit_code, judge
from hsr8.scenario.schema import Criteria

GOOD = {"falls": 0, "collisions": 0, "goal_reached": True, "via_points_passed": 4}
ALL = Criteria(max_falls=0, max_collisions=0, goal_reached=True, min_via_points=4)


def test_a_good_run_passes_everything():
    checks = judge(ALL, GOOD)
    assert len(checks) == 4
    assert all(check.passed for check in checks)
    assert exit_code("goal", checks) == 0


@pytest.mark.parametrize(
    ("key", "value"),
    [("falls", 1), ("collisions", 1), ("goal_reached", False), ("via_points_passed", 3)],
)
def test_each_criterion_can_fail_alone(key, value):
    checks = judge(ALL, GOOD | {key: value})
    assert sum(not check.passed for check in checks) == 1
    assert exit_code("timeout", checks) == 1


def test_what_is_not_asked_is_not_judged():
    checks = judge(Criteria(max_falls=0), GOOD | {"collisions": 9, "goal_reached": False})
    assert [check.name for check in checks] == ["falls"]
    assert exit_code("timeout", checks) == 0


@pytest.mark.parametrize(("reason", "code"), [("interrupted", 130), ("diverged", 3)])
def test_how_it_ended_comes_before_what_was_reached(reason, code):
    assert exit_code(reason, judge(ALL, GOOD)) == code
