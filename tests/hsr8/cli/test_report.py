import io

import pytest
from rich.console import Console

from hsr8.cli import report
from hsr8.evaluation.metrics import metrics
from hsr8.recorder.run.verdict import Criterion
from navigation.parameters.navigation import MissionParameters


def shown(path, *, results, criteria=()):
    stream = io.StringIO()
    report.show(
        "quick, seed 3",
        results=results,
        criteria=criteria,
        path=path,
        command="hsr8 run quick",
        console=Console(file=stream, width=200),
    )
    return stream.getvalue()


@pytest.fixture
def results(layout, walk, tables_of):
    tables, mission = tables_of(walk(6.0)), MissionParameters()
    return metrics(tables, layout, mission, exit_reason="timeout", state_hash="hash", wall_time=3.0)


def test_results_criteria_and_next_commands_are_shown(results, tmp_path):
    criteria = (
        Criterion("falls", "<= 0", "0", True),
        Criterion("goal reached", "yes", "no", False),
    )
    text = shown(tmp_path, results=results, criteria=criteria)
    for words in ("quick, seed 3", "path length [m]", "goal reached", "<= 0", "hsr8 run quick"):
        assert words in text
    assert f"hsr8 render {tmp_path}" in text
    assert f"hsr8 replay {tmp_path}" in text
    assert "time to goal" not in text


def test_both_verdicts_are_explained_where_they_are_shown(results, tmp_path):
    text = shown(tmp_path, results=results, criteria=(Criterion("falls", "<= 0", "0", True),))
    assert f"success       no ({report.VERDICTS['success']})" in text
    assert f"criteria_met  yes ({report.VERDICTS['criteria_met']})" in text


def test_a_path_with_spaces_is_quoted(tmp_path):
    assert "hsr8 render '" in shown(tmp_path / "my runs", results={})
