import pytest

from hsr8.recording.verdict import evaluate_criteria, exit_code
from hsr8.scenario.schema import Criteria

GOOD = {"falls": 0, "collisions": 0, "goal_reached": True, "via_points_passed": 4}
ALL = Criteria(max_falls=0, max_collisions=0, goal_reached=True, min_via_points=4)


def test_a_good_run_meets_every_criterion():
    criteria = evaluate_criteria(ALL, GOOD)
    assert len(criteria) == 4
    assert all(criterion.met for criterion in criteria)
    assert exit_code("goal", criteria) == 0


@pytest.mark.parametrize(
    ("key", "value"),
    [("falls", 1), ("collisions", 1), ("goal_reached", False), ("via_points_passed", 3)],
)
def test_each_criterion_can_fail_alone(key, value):
    criteria = evaluate_criteria(ALL, GOOD | {key: value})
    assert sum(not criterion.met for criterion in criteria) == 1
    assert exit_code("timeout", criteria) == 1


def test_what_is_not_asked_is_not_judged():
    criteria = evaluate_criteria(
        Criteria(max_falls=0), GOOD | {"collisions": 9, "goal_reached": False}
    )
    assert [criterion.name for criterion in criteria] == ["falls"]
    assert exit_code("timeout", criteria) == 0


@pytest.mark.parametrize(("reason", "code"), [("interrupted", 130), ("diverged", 3)])
def test_the_exit_reason_takes_precedence_over_the_criteria(reason, code):
    assert exit_code(reason, evaluate_criteria(ALL, GOOD)) == code
