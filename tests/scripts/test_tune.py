"""Tuning: parameter sets are valid, the best one wins, and finished runs are kept."""

import argparse
from concurrent.futures import ThreadPoolExecutor
from typing import get_args

import pytest
import tune

from hsr8.scenario.loader import load_scenario
from navigation.parameters.planner import Method

ARMS = [arm for study in ("baselines", "paper") for arm in tune.arms(study)]
EFFORT = argparse.Namespace(candidates=6, seeds=2, finalists=2, more=3)


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_every_set_is_a_valid_scenario_within_its_ranges(arm):
    for values in arm.sets(3):
        assert all(low <= values[key] <= high for key, (low, _, high) in arm.ranges.items())
        load_scenario("course", arm.words(values))


def test_the_study_of_the_paper_has_a_row_for_each_order_of_the_weights():
    given = [load_scenario("course", arm.words({})).navigation for arm in tune.arms("paper")]
    assert [navigation.planner.method for navigation in given] == ["paper", "paper"]
    assert [navigation.planner.paper.weights for navigation in given] == ["printed", "exchanged"]


def test_every_planner_but_that_of_the_paper_is_tuned():
    assert {arm.name for arm in tune.arms("baselines")} == set(get_args(Method)) - {"paper"}


@pytest.fixture
def walks(monkeypatch):
    """Runs whose score is the larger, the nearer a parameter is to its maximum."""
    made = []

    def walk(words, seed):
        made.append((words, seed))
        margin = float(next(word for word in words if ".margin=" in word).partition("=")[2])
        return {"score": round(margin, 4), "success": False, "time": 1.0}

    monkeypatch.setattr(tune, "ProcessPoolExecutor", ThreadPoolExecutor)
    monkeypatch.setattr(tune, "walk", walk)
    return made


def test_the_set_with_the_best_score_wins_and_the_study_continues(walks, tmp_path):
    (arm,) = (arm for arm in ARMS if arm.name == "orca")
    line = tune.tune(tune.Study(tmp_path / "runs.jsonl"), arm, EFFORT)
    best = max(values["margin"] for values in arm.sets(EFFORT.candidates))
    assert f"`margin` {best:g}" in line
    assert len(set(walks)) == len(walks) == 5 * 2 + 2 * 3 + 5  # by hand: all seeds at once

    walks.clear()
    assert tune.tune(tune.Study(tmp_path / "runs.jsonl"), arm, EFFORT) == line
    assert not walks
