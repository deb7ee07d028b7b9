from hsr8.sweep.progress import SweepProgress
from hsr8.sweep.report import (
    problem,
    report,
    report_of_values,
)
from hsr8.sweep.summary import summarize


def test_the_page_has_proportions_worst_runs_and_commands_to_repeat_them(definition, result):
    rows = [result(1000), result(1001, success=False, outcome="failed", collisions=1)]
    page = report(definition, rows, "hsr8 sweep course --seeds 1000:1002")
    assert page.startswith("# `course`: 2 seeds, 1000 to 1001\n")
    assert "    hsr8 sweep course --seeds 1000:1002\n" in page
    assert "| success | 1 of 2, 50.0 % (9.5 to 90.5 %) |" in page
    assert "- seed 1001: 1 collision; clearance 0.1 m\n" in page
    assert "  `hsr8 run course --set 'a=[1, 2]' --seed 1001`\n" in page
    assert "seed 1000:" not in page
    assert "| 1000 | passed | yes | 0 | 0 |" in page


def test_a_good_sweep_lists_the_smallest_clearances(definition, result):
    rows = [result(s, min_clearance_m=0.01 * s) for s in range(1, 9)]
    page = report(definition, rows, "")
    assert page.index("- seed 1: clearance 0.01 m") < page.index("- seed 2:")
    assert "- seed 4:" not in page


def test_refused_seeds_are_listed_separately(definition, result):
    rows = [result(1), {"seed": 7, "outcome": "refused", "error": "no room\nfor 12 obstacles"}]
    page = report(definition, rows, "")
    assert "2 seeds, 1 to 7, with gaps" in page
    assert "success | 1 of 1" in page
    assert "- 7: no room\n" in page


def test_an_empty_sweep_has_a_page(definition):
    assert "no runs yet" in report(definition, [], "")


def test_problems_in_words(result):
    assert problem(result(1)) == ""
    assert problem(result(1, collisions=2, falls=1, success=False)) == "1 fall; 2 collisions"
    assert problem(result(1, success=False, exit_reason="timeout")) == "timeout at 0.0 s"
    assert problem(result(1, outcome="failed")) == "criteria not met"
    assert problem({"outcome": "crashed", "error": "killed by SIGKILL: \nmore"}).startswith(
        "crashed: killed by SIGKILL"
    )


def test_values_are_lines(result):
    summaries = {
        "a=1": summarize([result(1), result(2, success=False, falls=1)]),
        "a=2": summarize([]),
    }
    page = report_of_values("a", summaries, "hsr8 sweep x --vary a=1,2", "hsr8 1")
    assert "| `a=1` | 2 | 50% |" in page
    assert "| `a=2` | 0 |" in page


def test_every_run_has_a_line_where_there_is_no_terminal(result, capsys):
    progress = SweepProgress(5, 2)
    progress.on_result(result(7))
    progress.on_result(result(8, success=False, collisions=1), "crowd")
    progress.on_result({"seed": 9, "outcome": "crashed", "error": "killed by SIGKILL"})
    progress.refresh()
    progress.close()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 3
    assert lines[0].startswith("3/5 runs   1 succeeded, 0 failed, 0 crashed")
    assert lines[0].endswith("seed 7: success")
    assert lines[1].endswith("crowd seed 8: 1 collision")
    assert "1 succeeded, 1 failed, 1 crashed" in lines[2]
    assert "killed by SIGKILL" in lines[2]
