"""Text of files and arguments on a terminal: no control character, no kilobytes, one line."""

import json
import resource
import shutil
import subprocess
import sys

import pyarrow as pa
import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError

ESCAPES = "\x1b]0;owned\x07 \x9b31m \u202edoog"
FAST = ("--body", "kinematic", "--camera", "analytic", "--duration", "0.5", "--quiet")


@pytest.fixture
def hostile(quick_run):
    """A run whose files contain escapes of a terminal wherever there is text."""
    run = quick_run.path
    for name in ("manifest.json", "metrics.json"):
        values = json.loads((run / name).read_text())
        changed = {key: ESCAPES if isinstance(v, str) else v for key, v in values.items()}
        changed |= {"exit_reason": values["exit_reason"], ESCAPES: 1.0}
        changed["libraries"] = {"numpy": ESCAPES}
        (run / name).write_text(json.dumps(changed))
    table = pa.table({"time": [0.1], "kind": [ESCAPES], "text": [ESCAPES]})
    with pa.ipc.new_stream(run / "events.arrows", table.schema) as writer:
        writer.write_table(table)
    (run / "\x1b[31mred").touch()
    return run


@pytest.mark.parametrize(
    "command",
    ["info RUN", "info RUN --all", "info RUN --json", "diff RUN OTHER", "compare RUN RUN"],
)
def test_text_of_a_folder_is_escaped(hostile, tmp_path, capsys, command):
    other = shutil.copytree(hostile, tmp_path / "\x1b[2Jother")
    (other / "metrics.json").write_text('{"success": "\\u001b[5m"}')
    words = {"RUN": str(hostile), "OTHER": str(other)}
    assert entry([words.get(word, word) for word in command.split()]) in (0, 1, 2)
    printed = "".join(capsys.readouterr())
    assert [c for c in printed if not (c.isprintable() or c == "\n")] == []
    assert "again       hsr8" not in printed


def test_a_message_about_a_long_argument_is_short(capsys):
    seeds = ",".join(map(str, range(0, 20_000, 2)))
    for words in (
        ["sweep", "quick", "--seeds", f"{seeds},0"],
        ["run", "quick", "--set", f"world.obstacle=[{seeds}]"],
        ["run", "quick", "--set", f"seed=[{seeds}]"],
    ):
        assert entry(words) == 2
        error = capsys.readouterr().err
        assert len(error) < 3000
        assert "expected" in error or "repeated" in error


@pytest.mark.parametrize("name", ["a" * 300, "a/" * 3000, "f\udcffle", "\ud800"])
@pytest.mark.parametrize(
    "command",
    [
        *("info PATH", "run PATH.toml", "run quick --out PATH", "compare PATH PATH"),
        *("sweep quick --seeds 0:2 --out PATH", "bench compare PATH PATH", "bench --suite PATH"),
        *("check quick --image PATH.png", "robot inspect PATH.xml", "color-table PATH.png"),
        *(
            "export RUN --csv PATH",
            "export RUN --lerobot PATH",
            "plot RUN --what tilt --out PATH.png",
        ),
        "run quick --set vision.color_table=PATH",
    ],
)
def test_any_path_works_or_is_one_line(quick_runs, tmp_path, monkeypatch, capsys, command, name):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("hsr8.cli.sweep.run_sweeps", _refuse)
    words = [w.replace("PATH", name).replace("RUN", str(quick_runs)) for w in command.split()]
    quick = [*FAST] if words[0] == "run" else []
    code = entry([*words, *quick])
    error = capsys.readouterr().err
    assert code in (0, 1, 2)
    assert "internal error" not in error
    assert code < 2 or error.count("hsr8: ") == 1


def _refuse(*_):
    raise UsageError("no runs in this test")


def test_a_library_that_cannot_be_imported_is_one_line():
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (600_000_000, 600_000_000))

    command = [sys.executable, "-m", "hsr8", "run", "quick", *FAST]
    done = subprocess.run(
        command, preexec_fn=limit, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 3
    *_, line = done.stderr.splitlines()
    assert line.startswith("hsr8: a library cannot be imported: ")
    assert "internal error" not in done.stderr
