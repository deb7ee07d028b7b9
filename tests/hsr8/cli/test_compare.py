import json

import pytest

from hsr8.cli.main import entry
from hsr8.recording.run import open_run

FAST = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--quiet"]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Three short runs: one, the same of another length, another seed."""
    out = tmp_path_factory.mktemp("runs")
    for name, more in (
        ("a", ["--seed", "2"]),
        ("b", ["--seed", "2", "--set", "camera.period_ms=80"]),
        ("c", ["--seed", "3"]),
    ):
        entry([*FAST, "--duration", "0.3", "--out", str(out / name), *more])
    return [str(open_run(out / name).path) for name in "abc"]


def test_two_runs_are_compared(runs, capsys):
    assert entry(["compare", *runs[:2]]) == 0
    printed = capsys.readouterr().out
    assert "| `camera.period_ms` | 60 | 80 |" in printed
    assert "| `success` | 1 |" in printed
    assert "code" not in printed.split("| differs |")[1].split("\n\n")[0]


def test_json_is_the_only_output(runs, capsys):
    assert entry(["compare", *runs[:2], "--json", "--metric", "sim_time_s"]) == 0
    output = json.loads(capsys.readouterr().out)
    assert output["common_seeds"] == 1
    assert output["settings"] == {"camera.period_ms": ["60", "80"]}
    assert output["results"]["sim_time_s"]["difference"] == 0.0


def test_runs_of_other_seeds_are_refused(runs, capsys):
    assert entry(["compare", runs[0], runs[2]]) == 2
    assert "no common seed" in capsys.readouterr().err
