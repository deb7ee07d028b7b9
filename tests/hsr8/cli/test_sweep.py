import json
import os
import re
import shlex
import signal
from pathlib import Path

import pytest

from hsr8.cli.main import entry
from hsr8.cli.options import Sweep
from hsr8.cli.sweep import _combinations
from hsr8.sweep.folder import SweepFolder
from tests.hsr8.cli.conftest import Instant

TINY = ["--body", "kinematic", "--camera", "analytic"]
FAST = ["sweep", "quick", *TINY, "--duration", "0.3", "--quiet"]


def test_seeds_with_a_result_are_kept_and_further_seeds_join(instant, tmp_path, capsys):
    instant()
    assert entry([*FAST, "--seeds", "0:2"]) == 0
    more = instant()
    assert entry([*FAST, "--seeds", "0:3"]) == 0
    assert [job.seed for job in more.ran] == [2]
    assert more.closed
    assert [r["seed"] for r in SweepFolder.read(tmp_path / "sweeps" / "quick").results()] == [
        0,
        1,
        2,
    ]


def test_another_scenario_does_not_join(instant, capsys):
    instant()
    entry([*FAST, "--seeds", "0:2"])
    assert entry([*FAST, "--seeds", "0:2", "--set", "world.n_static=3"]) == 2
    assert "world.n_static: 4 there, 3 now" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("outcomes", "code"),
    [
        ({}, 0),
        ({1: "failed"}, 1),
        ({1: "diverged"}, 3),
        ({1: "crashed"}, 3),
        ({1: "refused"}, 0),
        ({0: "refused", 1: "refused"}, 2),
    ],
)
def test_exit_codes(instant, outcomes, code):
    instant(outcomes)
    assert entry([*FAST, "--seeds", "0:2"]) == code


@pytest.mark.parametrize(
    ("outcomes", "message"),
    [
        ({}, ""),
        ({1: "failed"}, ""),
        ({1: "refused"}, "hsr8: of 3 runs 1 refused; reasons: sweeps/quick/report.md\n"),
        (
            {0: "crashed", 1: "diverged", 2: "crashed"},
            "hsr8: of 3 runs 2 crashed, 1 diverged; reasons: sweeps/quick/report.md\n",
        ),
    ],
)
def test_quiet_sweeps_report_runs_without_a_result_too(instant, capsys, outcomes, message):
    instant(outcomes)
    entry([*FAST, "--seeds", "0:3"])
    assert capsys.readouterr().err == message


def test_a_crashed_run_is_run_again_by_the_next_sweep(instant):
    instant({1: "crashed"})
    entry([*FAST, "--seeds", "0:3"])
    again = instant()
    assert entry([*FAST, "--seeds", "0:3"]) == 0
    assert [job.seed for job in again.ran] == [1]


def test_the_command_continues_after_ctrl_c(instant, capsys):
    stopped = instant({1: KeyboardInterrupt()})
    more = ["--seeds", "0:3", "--workers", "3", "--keep", "failed", "--out", "a b"]
    assert entry([*FAST, *more]) == 130
    assert stopped.closed
    (command,) = re.findall("continue with: hsr8 (.*)", capsys.readouterr().err)
    again = instant()
    assert entry(shlex.split(command)) == 0
    assert all(job.keep == "failed" for job in again.ran)
    assert [job.seed for job in again.ran] == [1, 2]


def test_a_scheduler_s_signal_is_like_ctrl_c(instant):
    handler = signal.getsignal(signal.SIGTERM)
    instant({0: lambda: os.kill(os.getpid(), signal.SIGTERM)})
    assert entry([*FAST, "--seeds", "0:2"]) == 130
    assert signal.getsignal(signal.SIGTERM) is handler


def test_processes_with_the_same_line_share_the_runs(instant, capsys):
    """The second process starts while the first one runs; each seed runs once."""
    other = Instant({})

    def start():
        monkeypatch = pytest.MonkeyPatch()
        with monkeypatch.context() as patch:
            patch.setattr("hsr8.sweep.runs.open_pool", lambda *_: other)
            patch.setattr("os.getpid", os.getppid)
            assert entry([*FAST, "--seeds", "0:4"]) == 0

    first = instant({0: start})
    assert entry([*FAST, "--seeds", "0:4", "--json"]) == 0
    printed = capsys.readouterr()
    assert [job.seed for job in first.ran] == [0]
    assert [job.seed for job in other.ran] == [1, 2, 3]
    assert "1 runs belong to other processes" in printed.err
    assert json.loads(printed.out)["runs"] == 4


def test_a_crashed_run_is_repeated_once(instant, tmp_path):
    pool = instant({1: "crashed"})
    entry([*FAST, "--seeds", "0:2"])
    assert [(job.seed, job.attempt) for job in pool.ran] == [(0, 1), (1, 1), (1, 2)]
    runs = tmp_path / "sweeps" / "quick" / "runs" / "quick"
    assert {folder.name for folder in runs.iterdir()} == {"0-1", "1-1", "1-2"}
    assert json.loads((runs / "1-2" / "result.json").read_text())["first_error"] == "oh no"


def test_every_value_has_a_folder_and_a_line_of_the_page(instant, tmp_path, capsys):
    executor = instant()
    vary = ["--vary", "camera.period_ms=40,80", "--vary", "world.n_moving=0,1"]
    assert entry([*FAST, "--seeds", "0:2", *vary, "--out", "v", "--json"]) == 0
    assert len(executor.ran) == 8
    values = json.loads(capsys.readouterr().out)["values"]
    assert list(values)[1] == "camera.period_ms=40,world.n_moving=1"
    page = (tmp_path / "v" / "report.md").read_text()
    assert "| `camera.period_ms=80,world.n_moving=0` | 2 |" in page
    one = SweepFolder.read(tmp_path / "v" / "camera.period_ms=80,world.n_moving=0")
    command = one.results()[0]["command"]
    assert "--set camera.period_ms=80 --set world.n_moving=0" in command
    assert command.endswith("--seed 0")


@pytest.mark.parametrize(
    "varied",
    [
        [f"navigation.gaze.risk.{k}=0.25,0.5" for k in ("path_weight", "static_weight")]
        + [f"belief.tracking.{k}=1.25,1.5" for k in ("process_noise", "forget_after_time")],
        ["plugin.planner=a/p.py:P,a_p.py:P"],
    ],
)
def test_every_combination_has_its_own_folder(varied):
    """Also where characters are replaced and long names cut."""
    combinations = _combinations(Sweep("quick", seeds="0:2", vary=[tuple(varied)]))
    assert len(combinations) == 2 ** len(varied)
    assert len(set(combinations.values())) == len(combinations)
    assert all(len(name) <= 120 and "/" not in name for name in combinations)


def test_a_full_disk_is_reported_and_results_stay(instant, tmp_path, monkeypatch, capsys):
    instant()
    entry([*FAST, "--seeds", "0:2"])

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("hsr8.files.atomic.os.fsync", full)
    stopped = instant()
    assert entry([*FAST, "--seeds", "0:4"]) == 3
    assert "No space left on device" in capsys.readouterr().err
    assert stopped.closed
    results = SweepFolder.read(tmp_path / "sweeps" / "quick").results()
    assert {r["seed"] for r in results} >= {0, 1}


def test_progress_and_table_are_printed(instant, capsys):
    instant({1: "failed"})
    entry([*FAST[:-1], "--seeds", "0:2"])
    printed = capsys.readouterr()
    assert "2/2 runs" in printed.err
    assert "success" in printed.out
    assert "sweeps/quick/report.md" in printed.out


def test_the_examples_of_the_documentation_work(instant, monkeypatch, capsys):
    """Every command of it, in order, on runs that end at once; then its Python."""
    page = (Path(__file__).parents[3] / "docs" / "sweeps.md").read_text()
    monkeypatch.setattr("hsr8.sweep.runs.require_gl", lambda: "none")
    monkeypatch.setattr("os.fsync", lambda _: None)  # many runs
    instant()
    commands = re.findall(r"^(hsr8 (?:sweep|compare) .*)$", page, re.M)
    assert len(commands) > 5
    for command in commands:
        words = shlex.split(command, comments=True)
        assert entry(words[1:]) == 0, command
    for example in re.findall(r"^```python\n(.*?)^```", page, re.M | re.S):
        exec(example, {})
    assert "200 of 200, 100.0 %" in capsys.readouterr().out
