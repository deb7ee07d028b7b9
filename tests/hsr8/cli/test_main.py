import importlib
import io
import os
import shutil
import signal
import subprocess
import sys
from bdb import BdbQuit
from pathlib import Path

import pytest

from hsr8.cli.main import ACTIONS, COMMANDS, entry
from hsr8.errors import Hsr8Error, SimulationDiverged, UsageError
from hsr8.recording.crash import InternalError, crash_report

HEAVY = (
    "mujoco",
    "rerun",
    "numpy",
    "scipy",
    "cv2",
    "pinocchio",
    "filterpy",
    "av",
    "pydantic",
    "matplotlib",
)
PROGRAM = [sys.executable, "-m", "hsr8"]


def imported_by(words, modules, **variables):
    """Exit code of a command, those of some modules that it imports, and its output."""
    script = (
        f"import sys; from hsr8.cli.main import entry; code = entry({[*words]}); "
        f"print(code, *(m for m in {[*modules]} if m in sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    *_, (code, *imported) = map(str.split, done.stdout.splitlines())
    return int(code), imported, done.stdout + done.stderr


def test_help_imports_nothing_heavy_and_has_every_command_in_one_group():
    code, imported, said = imported_by(["--help"], HEAVY)
    assert (code, imported) == (0, [])
    shown = [line.split()[0] for line in said.splitlines() if line.startswith("  ")]
    assert sorted(shown) == sorted(COMMANDS)


def test_a_scenario_is_read_and_a_missing_plugin_refused_before_mujoco_is_imported():
    words = ["run", "quick", "--set", "plugin.planner=none.py:Mine"]
    code, imported, said = imported_by(words, ["mujoco", "rerun", "cv2", "pinocchio"])
    assert (code, imported) == (2, [])
    assert "none.py:Mine: cannot read none.py" in said


def test_a_run_in_the_c_locale_works_without_rerun(tmp_path):
    words = ["run", "quick", "--duration", "0.005", "--quiet", "--body", "kinematic"]
    c_locale = {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"}
    words += ["--camera", "analytic", "--out", str(tmp_path)]
    code, imported, said = imported_by(words, ["mujoco", "rerun"], **c_locale)
    assert (code, imported) == (1, ["mujoco"]), said
    assert [*tmp_path.rglob("metrics.json")]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_and_a_main(command, capsys):
    assert entry([command, "--wrong", "-h"]) == 0
    assert f"usage: hsr8 {command}" in capsys.readouterr().out
    actions = ACTIONS["robot"] if command == "robot" else [""]
    for action in actions:
        name = f"{command.replace('-', '_')}_{action}".rstrip("_")
        assert callable(importlib.import_module(f"hsr8.cli.{name}").main)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_scripts_are_valid_and_name_every_command(shell, capsys):
    assert entry(["--tyro-print-completion", shell]) == 0
    script = capsys.readouterr().out
    for command in COMMANDS:
        assert command in script
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=script, text=True, check=True, timeout=30)


def test_the_version_is_printed(capsys):
    assert entry(["--version"]) == 0
    assert capsys.readouterr().out.startswith("hsr8 ")


@pytest.fixture
def failing(monkeypatch):
    """Make ``hsr8 list`` raise something."""

    def fail(error):
        def main(options):
            raise error

        monkeypatch.setattr("hsr8.cli.list.main", main)

    return fail


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (UsageError("not here; choose this"), 2),
        (SimulationDiverged("tick 7"), 3),
        (Hsr8Error("broken"), 3),
        (KeyboardInterrupt(), 130),
    ],
)
def test_errors_have_their_code_one_message_and_no_traceback(failing, capsys, error, code):
    failing(error)
    assert entry(["list"]) == code
    printed = capsys.readouterr()
    assert printed.out == ""
    assert str(error) in printed.err
    assert "Traceback" not in printed.err


def test_an_internal_error_leaves_its_traceback_in_a_file(failing, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    failing(ZeroDivisionError("oh no"))
    assert entry(["list"]) == 3
    printed = capsys.readouterr().err
    assert "ZeroDivisionError: oh no" in printed
    assert "Traceback" not in printed
    (report,) = tmp_path.glob("hsr8-*/crash.txt")
    assert str(report) in printed
    assert "Traceback" in report.read_text()


def test_a_run_folder_that_cannot_be_written_takes_no_traceback(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(InternalError) as caught, crash_report(tmp_path / "no" / "such"):
        raise ZeroDivisionError
    (report,) = tmp_path.glob("hsr8-*/crash.txt")
    assert str(report) in str(caught.value)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    with pytest.raises(InternalError, match="cannot be written"), crash_report():
        raise ZeroDivisionError


def test_ctrl_c_during_the_import_of_a_compiled_module(failing, capsys):
    wrapped = ImportError("initialization failed")
    wrapped.__cause__ = KeyboardInterrupt()
    failing(wrapped)
    assert entry(["list"]) == 130
    assert capsys.readouterr().err == "hsr8: interrupted\n"


def test_sigterm_is_like_ctrl_c(monkeypatch, capsys):
    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr("hsr8.cli.list.main", lambda _: os.kill(os.getpid(), signal.SIGTERM))
    assert entry(["list"]) == 130
    assert capsys.readouterr().err == "hsr8: interrupted\n"
    assert signal.getsignal(signal.SIGTERM) is before


def test_quitting_the_debugger_is_an_interruption(failing, capsys):
    failing(BdbQuit())
    assert entry(["list"]) == 130
    assert capsys.readouterr().err == "hsr8: interrupted\n"


def test_a_closed_pipe_ends_the_program_silently():
    with subprocess.Popen(
        [*PROGRAM, "--help"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ) as process:
        process.stdout.close()
        assert process.wait(60) == 141


@pytest.mark.parametrize(
    ("words", "closed", "code"),
    [("--help", ">&- 2>&-", 0), ("no", "2>&-", 2)],
)
def test_streams_that_are_closed_from_the_beginning(words, closed, code):
    line = f"exec {sys.executable} -m hsr8 {words} {closed}"
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (code, "")


def test_a_full_disk_under_standard_output_is_one_message():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*PROGRAM, "--help"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    message = "hsr8: cannot write standard output: No space left on device\n"
    assert (done.returncode, done.stderr) == (3, message)


def test_a_name_of_any_bytes_is_printed_in_a_strict_locale(tmp_path, monkeypatch):
    scenario = os.fsencode(tmp_path) + b"/a\xff.toml"
    Path(os.fsdecode(scenario)).write_text('extends = "walk"\n')
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, "utf-8", "strict"))
    assert entry(["check", os.fsdecode(scenario)]) == 0
    sys.stdout.flush()
    assert rb"/a\xff.toml' --seed 0" in written.getvalue().replace(b"udcff", b"xff")


def test_everything_can_be_printed_in_ascii():
    done = subprocess.run(
        [*PROGRAM, "run", "--help"],
        env={"LC_ALL": "POSIX", "PYTHONUTF8": "0", "PATH": os.environ["PATH"]},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.isascii()
