import shutil

import pytest

from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.recording.run import open_run
from hsr8.recording.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario

COMMANDS = [["info"], ["verify"]]


@pytest.fixture(scope="module")
def recorded(quick_runs):
    return open_run(quick_runs).path


def output(command, run, capsys):
    """Exit code and error output of a command on a run."""
    words = [str(run) if word == "SAME" else word for word in command]
    code = entry([words[0], str(run), *words[1:]])
    return code, capsys.readouterr().err


def spoil(file, kind):
    file.unlink(missing_ok=True)
    if kind == "folder":
        file.mkdir()
    else:
        file.touch(mode=0o000)


@pytest.mark.usefixtures("bound_by_file_modes")
@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
@pytest.mark.parametrize("kind", ["folder", "unreadable"])
def test_an_unreadable_file_is_one_clear_error(
    recorded, tmp_path, monkeypatch, capsys, command, kind
):
    monkeypatch.chdir(tmp_path)
    for name in sorted(file.name for file in recorded.iterdir()):
        run = shutil.copytree(recorded, tmp_path / "run")
        spoil(run / name, kind)
        code, error = output(command, run, capsys)
        assert code in (0, 2) or (code == 1 and "diff" in command)
        assert "internal error" not in error
        if code == 2:
            assert error.count("hsr8: ") == 1
        shutil.rmtree(run)


@pytest.mark.parametrize(
    ("end", "ended"),
    [
        *((reason, True) for reason in ("goal", "fall", "diverged", "timeout", "completed")),
        *((reason, False) for reason in ("running", "failed", "interrupted", "error")),
    ],
)
def test_only_a_run_that_ended_must_be_complete(tmp_path, end, ended):
    path = RunFolder.create(tmp_path, "quick", 7)
    folder = RunFolder(path, load_scenario("quick", seed=7), (), "analytic")
    folder.end(end, rows={"events": 3})
    run = open_run(path)
    assert run.ended == ended
    if not ended:
        assert len(run.events) == len(run.ticks) == 0
        return
    with pytest.raises(UsageError, match=r"events\.arrows: cut off .*, got 0 rows; expected 3"):
        len(run.events)
    with pytest.raises(UsageError, match=r"ticks\.arrows: cut off"):
        len(run.ticks)
