import json
import re
import shlex
from pathlib import Path

import pytest

from hsr8.cli.main import entry
from hsr8.sweep.bench.entry import read_entry
from hsr8.sweep.folder import SweepFolder

SUITE = """
name = "tiny"
version = 1
quick = "1000"
full = "1000:1003"
settings = ["robot.body=kinematic", "camera.source=analytic", "duration=0.3"]

[families]
quick = "a"
course = "b"
"""
PLANNER = """
import numpy as np
from navigation.decision import MotionDecision

class Still:
    def plan(self, belief, task):
        return MotionDecision(np.zeros(3))
"""


@pytest.fixture
def bench(tmp_path, monkeypatch):
    """Command line of the benchmark with the tiny suite, in a new folder."""
    monkeypatch.chdir(tmp_path)
    Path("tiny.toml").write_text(SUITE)
    Path("mine.py").write_text(PLANNER)
    return ["bench", "--suite", "tiny.toml", "--quiet"]


@pytest.mark.usefixtures("sweeps_in_process")
def test_the_same_command_gives_the_same_file(bench, capsys):
    """Also with the planner of a user, and the comparison."""
    mine = ["--name", "mine", "--set", "plugin.planner=mine.py:Still"]
    for more in (["--out", "a"], ["--out", "b"], mine):
        assert entry([*bench, "--quick", *more]) == 0
    assert Path("a/bench.json").read_bytes() == Path("b/bench.json").read_bytes()
    default, still = read_entry(Path("a")), read_entry(Path("bench/tiny/mine"))
    assert {f: [r["seed"] for r in runs] for f, runs in default.runs.items()} == {
        "quick": [1000],
        "course": [1000],
    }
    assert all(r["certified_time_s"] > 10.0 for runs in default.runs.values() for r in runs)
    assert set(still.settings) == {"plugin.planner"}
    assert "mine.py:Still" in still.versions
    capsys.readouterr()
    assert entry(["bench", "compare", "a", "bench/tiny/mine", "--json"]) == 0
    comparison = json.loads(capsys.readouterr().out)
    assert comparison["seeds"] == ["course 1000", "quick 1000"]
    assert comparison["settings"]["plugin.planner"] == ['""', '"mine.py:Still"']
    assert entry(["bench", "compare", "a/bench.json", "bench/tiny/mine"]) == 0
    assert "- B: `mine`, suite tiny 1" in capsys.readouterr().out


def test_full_keeps_the_runs_of_quick(bench, instant):
    quick = instant()
    assert entry([*bench, "--quick"]) == 0
    assert [job.seed for job in quick.ran] == [1000, 1000]
    full = instant()
    assert entry(bench) == 0
    assert sorted(job.seed for job in full.ran) == [1001, 1001, 1002, 1002]
    made = read_entry(Path("bench/tiny/default"))
    assert (made.seeds, made.scores()["all"].runs) == ("full", 6)
    again = instant()
    assert entry([*bench, "--quick"]) == 0
    assert again.ran == []
    assert read_entry(Path("bench/tiny/default")).scores()["all"].runs == 2


def test_the_command_continues_after_ctrl_c(bench, instant, capsys):
    stopped = instant({1001: KeyboardInterrupt()})
    assert entry([*bench, "--out", "a b", "--set", "navigation.planner.method=orca"]) == 130
    assert stopped.closed
    assert not list(Path().rglob("bench.json"))
    (command,) = re.findall("continue with: hsr8 (.*)", capsys.readouterr().err)
    again = instant()
    assert entry(shlex.split(command)) == 0
    assert sorted(job.seed for job in again.ran) == [1000, 1001, 1001, 1002, 1002]
    assert read_entry(Path("a b")).name == "navigation.planner.method=orca"


def test_the_command_of_an_entry_names_neither_folder_nor_workers(bench, instant):
    instant()
    more = ["--set", "navigation.planner.method=orca", "--body", "full", "--name", "orca"]
    assert entry([*bench, *more, "--out", "here", "--workers", "3", "--keep", "all"]) == 0
    made = read_entry(Path("here"))
    assert made.command == (
        "hsr8 bench --name orca --set navigation.planner.method=orca --body full --suite tiny.toml"
    )
    assert set(made.settings) == {"navigation.planner.method", "robot.body"}


def test_a_run_of_the_suite_is_repeated_by_its_command(bench, instant):
    instant()
    entry([*bench, "--quick", "--camera", "omnidirectional"])
    folder = SweepFolder.read(Path("bench/tiny/camera.source=omnidirectional/quick"))
    assert folder.results()[0]["command"] == (
        "hsr8 run quick --set robot.body=kinematic camera.source=analytic duration=0.3 "
        "camera.source=omnidirectional --seed 1000"
    )


@pytest.mark.parametrize(
    ("outcomes", "code"),
    [
        ({}, 0),
        ({1000: "failed"}, 0),
        ({1000: "crashed"}, 3),
        ({1000: "diverged"}, 3),
        ({1000: "refused"}, 0),
        (dict.fromkeys(range(1000, 1003), "refused"), 2),
    ],
)
def test_exit_codes(bench, instant, outcomes, code, capsys):
    instant(outcomes)
    assert entry(bench) == code
    lost = set(outcomes.values()) & {"crashed", "diverged", "refused"}
    assert ("reasons: bench/tiny/default/*/report.md" in capsys.readouterr().err) == bool(lost)
    assert read_entry(Path("bench/tiny/default")).seeds == "full"


def test_table_and_json_are_printed(bench, instant, capsys):
    instant()
    entry(bench[:-1])
    printed = capsys.readouterr()
    assert "| course | 3 | 100.0 % |" in printed.out
    assert "6/6 runs" in printed.err
    assert Path("bench/tiny/default/report.md").read_text() in printed.out
    entry([*bench, "--json"])
    value = json.loads(capsys.readouterr().out)
    assert value["folder"] == "bench/tiny/default"
    assert value["scores"]["all"]["success"]["count"] == 6
