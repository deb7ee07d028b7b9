import io
from pathlib import Path

from rich.console import Console

from hsr8.cli import report
from hsr8.evaluation.metrics import Metrics
from hsr8.evaluation.verdict import Criterion


def test_the_report_shows_results_criteria_and_what_to_do_next(layout, walk, tmp_path):
    metrics = Metrics(layout, 0.15, 0.05)
    for record in walk(2.0):
        metrics.on_record(record)
    stream = io.StringIO()
    report.show(
        "quick, seed 3",
        results=metrics.result("timeout", "hash"),
        checks=(
            Criterion("falls", "<= 0", "0", True),
            Criterion("goal reached", "yes", "no", False),
        ),
        path=tmp_path,
        command="hsr8 run quick",
        console=Console(file=stream, width=100),
    )
    text = stream.getvalue()
    for words in ("quick, seed 3", "0.4 m", "met", "not met", str(tmp_path), "hsr8 run quick"):
        assert words in text
    # Without a log there is nothing to replay.
    assert "hsr8 replay" not in text
    assert "time to goal" not in text


def test_a_log_can_be_replayed(tmp_path):
    (tmp_path / "log.rrd").touch()
    stream = io.StringIO()
    report.show(
        "quick",
        results={"exit_reason": "goal"},
        checks=(),
        path=Path(tmp_path),
        command="",
        console=Console(file=stream, width=200),
    )
    assert f"hsr8 replay {tmp_path}" in stream.getvalue()


def test_a_path_with_spaces_can_be_typed_again(tmp_path):
    path = tmp_path / "my runs"
    path.mkdir()
    stream = io.StringIO()
    console = Console(file=stream, width=200)
    report.show("quick", results={}, checks=(), path=path, command="", console=console)
    assert f"hsr8 render '{path}'" in stream.getvalue()


def test_cut_off_set_points_are_told_only_when_there_are_any(tmp_path):
    said = []
    for ticks, by in ((0, {}), (3, {"l_knee": 3, "r_hip_pitch": 1})):
        stream = io.StringIO()
        report.show(
            "walk",
            results={"clipped_target_ticks": ticks, "clipped_target_by": by},
            checks=(),
            path=tmp_path,
            command="",
            console=Console(file=stream, width=200),
        )
        said.append(stream.getvalue())
    assert "beyond range" not in said[0]
    assert "in 3 ticks: l_knee 3, r_hip_pitch 1" in said[1]
