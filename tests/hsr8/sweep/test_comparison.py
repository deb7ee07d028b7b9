import csv
from dataclasses import replace

import numpy as np
import pytest

import hsr8
from hsr8.errors import UsageError
from hsr8.measure.statistics import holm
from hsr8.scenario.loader import load_scenario
from hsr8.sweep.comparison import Side, compare, open_side
from hsr8.sweep.comparison_page import draw, latex, page, to_json, write_csv
from hsr8.sweep.definition import Definition
from hsr8.sweep.folder import SweepFolder
from hsr8.sweep.job import Job
from navigation.decision import MotionDecision

SCENARIO = """
name = "here"
duration = 3.0
[world]
brightness = 1.0
n_static = 3
[mission]
kind = "course"
"""
DEFINITION = Definition("here", ("hsr8", "run", "here"), "1", "abc", "x86_64", {}, SCENARIO)


STAND_INS = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 0.5}


class Still:
    """Stands."""

    def plan(self, belief, task):
        return MotionDecision(np.zeros(3))


def _run(seed, success=True, time=50.0, **more):
    time = time if success else None
    return {"seed": seed, "outcome": "passed", "success": success, "time_to_goal_s": time, **more}


def _side(runs, **change):
    definition = replace(DEFINITION, **change)
    return Side("somewhere", "", {run["seed"]: run for run in runs}, definition)


def test_success_is_compared_on_common_seeds():
    a = _side([_run(s, success=s > 4) for s in range(10)])
    b = _side([_run(s) for s in range(2, 12)])
    comparison = compare(a, b)
    assert comparison.seeds == tuple(range(2, 10))
    success = comparison.metrics[0]
    assert (success.metric, success.test, success.n) == ("success", "McNemar", 8)
    assert success.only_b == (2, 3, 4)
    assert success.only_a == ()
    assert success.difference == pytest.approx(3 / 8)
    assert success.p_value == pytest.approx(2 * 0.5**3)


def test_times_count_where_both_arrived():
    a = _side([_run(s, success=s != 1, time=50.0) for s in range(4)])
    b = _side([_run(s, success=s != 2, time=52.0 + s) for s in range(4)])
    time = next(r for r in compare(a, b).metrics if r.metric == "time_to_goal_s")
    assert (time.test, time.n) == ("Wilcoxon", 2)
    assert time.difference == pytest.approx(3.5)


def test_a_crash_is_a_failure_and_says_nothing_else():
    a = _side([_run(1, collisions=0), {"seed": 2, "outcome": "crashed"}])
    b = _side([_run(1, collisions=2), _run(2, collisions=2)])
    metrics = {r.metric: r for r in compare(a, b).metrics}
    assert metrics["success"].only_b == (2,)
    assert metrics["collisions"].n == 1


def test_what_is_no_finite_number_was_not_measured():
    a = _side([_run(1, min_clearance_m=float("nan")), _run(2, min_clearance_m="near")])
    b = _side([_run(1, min_clearance_m=1.0), _run(2, min_clearance_m=1.0)])
    assert [r.metric for r in compare(a, b).metrics] == ["success", "time_to_goal_s"]


def test_swapping_turns_every_difference_round():
    a = _side([_run(s, success=s % 3 > 0, collisions=s % 2) for s in range(9)])
    b = _side([_run(s, success=s % 4 > 0, collisions=s % 5) for s in range(9)])
    for one, other in zip(compare(a, b).metrics, compare(b, a).metrics, strict=True):
        assert one.difference == pytest.approx(-other.difference)
        assert one.p_value == pytest.approx(other.p_value)
        assert (one.low, one.high) == pytest.approx((-other.high, -other.low))


def test_what_differs_between_the_two_is_told():
    dark = SCENARIO.replace("brightness = 1.0", "brightness = 0.5") + "[camera]\nperiod_ms = 80\n"
    b = _side([_run(1)], scenario=dark, hsr8="2", code="def")
    comparison = compare(_side([_run(1)]), b)
    assert comparison.settings["camera.period_ms"] == ("60", "80")
    assert set(comparison.settings) == {"camera.period_ms", "world.brightness"}
    assert comparison.versions == {"hsr8": ("1", "2"), "code": ("abc", "def")}
    text = page([comparison], "hsr8 compare a b")
    assert "| `camera.period_ms` | 60 | 80 |" in text
    assert "| `hsr8` | 1 | 2 |" in text
    assert to_json(comparison)["settings"]["world.brightness"] == ["1.0", "0.5"]


def test_a_planner_of_ones_own_is_a_difference(tmp_path):
    for name, planner in (("theirs", None), ("mine", Still())):
        hsr8.run("quick", seed=3, settings=STAND_INS, out=tmp_path / name, planner=planner)
    theirs, mine = open_side(tmp_path / "theirs"), open_side(tmp_path / "mine")
    call = f"hsr8.run(planner={__name__}.Still)"
    assert compare(theirs, mine).versions == {"decisions": ("-", call)}
    assert (
        compare(_side([_run(1)]), _side([_run(1)], command_words=(call,))).versions["decisions"][1]
        == call
    )
    assert compare(mine, mine).versions == compare(theirs, theirs).versions == {}


def test_a_key_that_is_new_is_no_difference():
    """What an older version did not know has its default."""
    full = SCENARIO + '[navigation]\nprofile = "extended"\n'
    assert compare(_side([_run(1)]), _side([_run(1)], scenario=full)).settings == {}


def test_other_worlds_do_not_pair():
    other = SCENARIO.replace("n_static = 3", "n_static = 4")
    with pytest.raises(UsageError, match=r"world.n_static: 3 in A, 4 in B"):
        compare(_side([_run(1)]), _side([_run(1)], scenario=other))


def test_no_common_seed_and_unknown_metrics_are_told():
    with pytest.raises(UsageError, match="A has 1 to 2, B has 5 to 5"):
        compare(_side([_run(1), _run(2)]), _side([_run(5)]))
    with pytest.raises(UsageError, match="did you mean 'success'"):
        compare(_side([_run(1)]), _side([_run(1)]), ["sucess"])


def test_sweeps_are_opened_without_what_could_not_run(tmp_path):
    folder = SweepFolder.open(tmp_path / "s", DEFINITION)
    for result in (_run(1, mean={"vx": 0.1}), {"seed": 2, "outcome": "refused"}):
        seed = result["seed"]
        run = folder.claim(seed, 1, 1.0)
        folder.finish(Job(load_scenario("quick"), str(folder.path), run, "", 1.0), result)
    side = open_side(tmp_path / "s")
    assert list(side.runs) == [1]
    assert side.runs[1]["mean.vx"] == 0.1


def test_other_folders_are_refused_and_parts_are_named(tmp_path):
    with pytest.raises(UsageError, match="not a folder of a sweep or a run"):
        open_side(tmp_path)
    SweepFolder.open(tmp_path / "a=1", DEFINITION)
    with pytest.raises(UsageError, match="one of its parts: a=1"):
        open_side(tmp_path)


@pytest.fixture
def arms():
    """Comparisons of a reference with two arms over ten seeds."""
    a = _side([_run(s, min_clearance_m=0.1) for s in range(10)])
    worse = _side([_run(s, success=s > 6, min_clearance_m=0.05) for s in range(10)])
    better = _side([_run(s, min_clearance_m=0.1 + 0.01 * s) for s in range(10)])
    names = ["success", "min_clearance_m"]
    return [compare(a, arm, names) for arm in (replace(worse, name="w"), replace(better, name="b"))]


def test_every_output_has_all_arms_and_their_corrected_tests(arms, tmp_path):
    write_csv(arms, tmp_path / "a.csv")
    rows = list(csv.DictReader((tmp_path / "a.csv").open()))
    assert [(row["arm"], row["metric"]) for row in rows] == [
        (arm, metric) for arm in "wb" for metric in ("success", "min_clearance_m")
    ]
    raw = [float(row["p_value"]) for row in rows]
    assert [float(row["p_holm"]) for row in rows] == holm(raw)
    assert [float(row["difference"]) for row in rows] == [
        metric.difference for comparison in arms for metric in comparison.metrics
    ]
    assert page(arms, "hsr8 compare a w b").count("| `min_clearance_m` | 10 |") == 2
    assert latex(arms).count("\\\\\n") == 5
    assert "min\\_clearance\\_m" in latex(arms)
    draw(arms, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
