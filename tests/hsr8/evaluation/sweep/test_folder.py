from dataclasses import replace

import pyarrow.parquet as pq
import pytest

from hsr8.errors import UsageError
from hsr8.evaluation.sweep.folder import REPORT, RESULTS, TABLE, SweepFolder


@pytest.fixture
def folder(tmp_path, definition):
    folder = SweepFolder.open(tmp_path / "sweep", definition)
    folder.lock()
    yield folder
    folder.close()


def test_rows_come_back_by_seed(folder, definition, result):
    folder.append(result(7), result(3))
    folder.close()
    again = SweepFolder.read(folder.path)
    assert again.results() == [result(3), result(7)]
    assert again.definition == definition
    assert SweepFolder.open(folder.path, definition).results() == again.results()


def test_a_line_that_a_kill_cut_off_is_dropped(folder, result):
    folder.append(result(1), result(2))
    folder.close()
    file = folder.path / RESULTS
    file.write_bytes(file.read_bytes()[:-20])
    assert [r["seed"] for r in folder.results()] == [1]
    folder.lock()
    folder.append(result(5))
    assert [r["seed"] for r in folder.results()] == [1, 5]


@pytest.mark.parametrize(
    "line",
    [
        "[]",
        "{}",
        "no",
        '{"seed": true, "outcome": "passed"}',
        '{"seed": 1, "outcome": "splendid"}',
        '{"seed": 1, "outcome": []}',
        '{"seed": 1, "outcome": "passed", "falls": "two"}',
        '{"seed": 1, "outcome": "passed", "min_clearance_m": {}}',
        "[" * 100_000,
    ],
)
def test_a_damaged_line_is_named(folder, line):
    (folder.path / RESULTS).write_text(line + "\n")
    with pytest.raises(UsageError, match=r"runs.jsonl:1"):
        folder.results()


def test_the_last_word_counts_but_a_crash_never_hides_a_result(folder, result):
    folder.append(result(1, outcome="crashed"), result(1), result(2), result(2, outcome="crashed"))
    assert [r["outcome"] for r in folder.results()] == ["passed", "passed"]


def test_shards_write_files_of_their_own_and_are_read_together(folder, definition, result):
    shards = [SweepFolder.open(folder.path, definition) for _ in range(2)]
    for number, shard in enumerate(shards, start=1):
        shard.lock((number, 2))
        shard.append(result(number))
    assert [r["seed"] for r in folder.results()] == [1, 2]


def test_nobody_else_may_write(folder, definition):
    with pytest.raises(UsageError, match="another sweep"):
        SweepFolder.open(folder.path, definition).lock()
    folder.close()
    SweepFolder.open(folder.path, definition).lock()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"code": "abd"}, "code: abc there, abd now"),
        ({"libraries": {"mujoco": "5"}}, "mujoco: 4 there, 5 now"),
        ({"scenario": "duration = 9.0"}, r"duration: 3\.0 there, 9\.0 now"),
        ({"scenario": "duration = 3.0"}, r"world.size: \[4\.0, 4\.0\] there, - now"),
    ],
)
def test_runs_of_something_else_do_not_join(folder, definition, change, told):
    with pytest.raises(UsageError, match=told):
        SweepFolder.open(folder.path, replace(definition, **change))


def test_the_seed_of_the_scenario_means_nothing(folder, definition):
    other = replace(definition, scenario=definition.scenario.replace("seed = 1", "seed = 2"))
    assert other.scenario != definition.scenario
    SweepFolder.open(folder.path, other)


@pytest.mark.parametrize("text", ["{}", "no json", "[]", '{"name": 3}'])
def test_a_damaged_definition_is_reported(folder, text):
    (folder.path / "sweep.json").write_text(text)
    with pytest.raises(UsageError, match=r"sweep\.json"):
        SweepFolder.read(folder.path)


def test_other_folders_are_reported(tmp_path, definition):
    with pytest.raises(UsageError, match="not a sweep"):
        SweepFolder.read(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="--out"):
        SweepFolder.open(tmp_path / "file", definition)
    (tmp_path / "results.jsonl").write_text("")
    with pytest.raises(UsageError, match="--out"):
        SweepFolder.open(tmp_path, definition)


def test_results_are_written_as_table_and_report(folder, result):
    folder.append(result(1, mean_velocity={"vx": 0.1}, time_to_goal_s=3), result(2, error="oh"))
    folder.write_report("page")
    assert (folder.path / REPORT).read_text() == "page"
    table = pq.read_table(folder.path / TABLE).to_pylist()
    assert [r["seed"] for r in table] == [1, 2]
    assert table[0]["mean_velocity.vx"] == 0.1
    assert table[1]["mean_velocity.vx"] is None
    assert table[0]["time_to_goal_s"] == 3.0
    assert table[1]["error"] == "oh"
