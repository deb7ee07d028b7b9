"""The folder of a sweep: every run belongs to the process that made its folder first."""

import json
import socket
from dataclasses import replace
from itertools import count

import pyarrow.parquet as pq
import pytest

from hsr8.errors import UsageError
from hsr8.scenario.loader import load_scenario
from hsr8.sweep.folder import REPORT, TABLE, SweepFolder
from hsr8.sweep.job import Job

SCENARIO = load_scenario("quick")


@pytest.fixture
def folder(tmp_path, definition):
    return SweepFolder.open(tmp_path / "sweep", definition)


@pytest.fixture
def write(folder):
    """Write results into the next folders of their seeds."""

    def written(*results):
        for result in results:
            seed = result["seed"]
            run = next(run for k in count(1) if (run := folder.claim(seed, k, 10.0)))
            folder.finish(Job(SCENARIO.with_seed(seed), str(folder.path), run, "", 1.0), result)

    return written


def test_results_come_back_by_seed(folder, definition, write, result):
    write(result(17), result(3))
    again = SweepFolder.read(folder.path)
    assert again.results() == [result(3), result(17)]
    assert again.definition == definition
    assert SweepFolder.open(folder.path, definition).results() == again.results()


@pytest.mark.parametrize(
    "text",
    [
        *("[]", "{}", "no", "[" * 100_000, '{"seed": true, "outcome": "passed"}'),
        '{"seed": 1, "outcome": "splendid"}',
        '{"seed": 1, "outcome": "passed", "falls": "two"}',
    ],
)
def test_a_damaged_result_is_named(folder, write, result, text):
    write(result(1))
    (folder.path / "runs/course/1-1/result.json").write_text(text)
    with pytest.raises(UsageError, match=r"cannot read .*1-1/result.json"):
        folder.results()


def test_the_last_result_counts_but_a_crash_never_hides_one(folder, write, result):
    write(result(1, outcome="crashed"), result(1), result(2), result(2, outcome="crashed"))
    assert [r["outcome"] for r in folder.results()] == ["passed", "passed"]
    assert folder.missing([1, 2, 3]) == ({3: 1}, 0)


@pytest.mark.parametrize("outcome", ["passed", "failed", "diverged", "crashed", "refused"])
def test_only_runs_that_crashed_or_were_refused_are_missing_again(folder, write, result, outcome):
    write(result(5, outcome=outcome))
    again = {5: 2} if outcome in ("crashed", "refused") else {}
    assert folder.missing([5]) == (again, 0)


def test_a_run_is_taken_once_and_left_alone_while_its_process_lives(folder, definition):
    other = SweepFolder.open(folder.path, definition)
    assert folder.claim(4, 1, 10.0) == "runs/course/4-1"
    assert other.claim(4, 1, 10.0) is None
    assert other.missing([4, 5]) == ({5: 1}, 1)


@pytest.mark.parametrize(
    ("change", "lost"),
    [
        ({"pid": 2**22 + 1}, True),
        ({"started": "1"}, True),  # another process has this number now
        ({"host": "elsewhere"}, False),
        ({"host": "elsewhere", "until": 0.0}, True),
    ],
)
def test_a_lost_run_is_taken_again(folder, change, lost):
    file = folder.path / folder.claim(4, 1, 10.0) / "claim.json"
    claim = json.loads(file.read_text())
    assert claim["host"] == socket.gethostname()
    file.write_text(json.dumps(claim | change))
    assert folder.missing([4]) == (({4: 2}, 0) if lost else ({}, 1))
    assert file.exists() == (not lost)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"code": "abd"}, "code: abc there, abd now"),
        ({"scenario": "duration = 9.0"}, r"duration: 3\.0 there, 9\.0 now"),
    ],
)
def test_other_runs_do_not_join(folder, definition, change, message):
    with pytest.raises(UsageError, match=message):
        SweepFolder.open(folder.path, replace(definition, **change))


def test_the_seed_of_the_scenario_is_ignored(folder, definition):
    other = replace(definition, scenario=definition.scenario.replace("seed = 1", "seed = 2"))
    assert other.scenario != definition.scenario
    SweepFolder.open(folder.path, other)


@pytest.mark.parametrize("text", ["no json", '{"name": 3}'])
def test_a_damaged_or_missing_definition_is_reported(folder, tmp_path, definition, text):
    (folder.path / "sweep.json").write_text(text)
    with pytest.raises(UsageError, match=r"sweep\.json"):
        SweepFolder.read(folder.path)
    with pytest.raises(UsageError, match="not a sweep"):
        SweepFolder.read(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="--out"):
        SweepFolder.open(tmp_path / "file", definition)


def test_runs_are_not_written_through_a_link(folder, definition, tmp_path):
    (tmp_path / "outside").mkdir()
    (folder.path / "runs").symlink_to(tmp_path / "outside")
    with pytest.raises(UsageError, match="a link, got"):
        SweepFolder.open(folder.path, definition)


def test_results_are_written_as_table_and_report(folder, write, result):
    write(result(1, mean_velocity={"vx": 0.1}, time_to_goal_s=3), result(2, error="oh"))
    folder.write_report("page")
    assert (folder.path / REPORT).read_text() == "page"
    table = pq.read_table(folder.path / TABLE).to_pylist()
    assert [r["seed"] for r in table] == [1, 2]
    assert table[0]["mean_velocity.vx"] == 0.1
    assert table[1]["mean_velocity.vx"] is None
    assert table[0]["time_to_goal_s"] == 3.0
    assert table[1]["error"] == "oh"
