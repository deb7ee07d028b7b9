import importlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hsr8.cli.crash import CrashReport, InternalError
from hsr8.cli.main import COMMANDS, MODULES, entry
from hsr8.errors import Hsr8Error, SimulationDiverged, UsageError
from hsr8.recorder.run.manifest import Manifest
from hsr8.recorder.run.run_folder import RunFolder

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


def test_help_imports_nothing_heavy():
    script = (
        "import sys; from hsr8.cli.main import entry; code = entry(['--help']); "
        f"print([m for m in {HEAVY} if m in sys.modules], code, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stderr.strip() == "[] 0"
    for command in COMMANDS:
        assert command in done.stdout


def test_no_arguments_show_the_help(capsys):
    assert entry([]) == 0
    assert "First steps" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [["rum", "quick"], ["run"], ["run", "quick", "--sed", "3"]])
def test_a_wrong_command_line_is_a_usage_error(arguments, capsys):
    assert entry(arguments) == 2
    assert capsys.readouterr().out == ""


def test_a_wrong_option_is_answered_with_the_right_one(capsys):
    entry(["run", "quick", "--sed", "3"])
    assert "--seed" in capsys.readouterr().err


@pytest.mark.parametrize(("word", "right"), [("rum", "run"), ("rendr", "render"), ("inf", "info")])
def test_a_wrong_command_is_answered_with_the_right_one(word, right, capsys):
    assert entry([word, "quick"]) == 2
    assert f"did you mean '{right}'?" in capsys.readouterr().err


def test_every_command_has_a_main():
    for module in MODULES.values():
        assert callable(importlib.import_module(module).main)


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
        (UsageError("no such thing; choose this"), 2),
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


def test_our_own_mistakes_leave_their_traceback_in_a_file(failing, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    failing(ZeroDivisionError("oh no"))
    assert entry(["list"]) == 3
    printed = capsys.readouterr().err
    assert "ZeroDivisionError: oh no" in printed
    assert "Traceback" not in printed
    (report,) = tmp_path.glob("hsr8-*/crash.txt")
    assert str(report) in printed
    assert "Traceback" in report.read_text()


def test_a_run_folder_that_takes_no_traceback_is_no_obstacle(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(InternalError) as caught, CrashReport(tmp_path / "no" / "such"):
        raise OSError("No space left on device")
    (report,) = tmp_path.glob("hsr8-*/crash.txt")
    assert str(report) in str(caught.value)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    with pytest.raises(InternalError, match="cannot be written"), CrashReport():
        raise OSError("No space left on device")


def test_ctrl_c_during_the_import_of_a_compiled_module(failing, capsys):
    wrapped = ImportError("initialization failed")
    wrapped.__cause__ = KeyboardInterrupt()
    failing(wrapped)
    assert entry(["list"]) == 130
    assert capsys.readouterr().err == "hsr8: interrupted\n"


def test_ctrl_c_while_the_command_line_is_read(monkeypatch, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("tyro.cli", interrupted)
    assert entry(["list"]) == 130
    assert capsys.readouterr().err == "hsr8: interrupted\n"


@pytest.mark.parametrize("arguments", [["list"], ["list", "--json"], ["--help"]])
def test_a_reader_that_leaves_is_no_mistake_of_ours(arguments):
    with subprocess.Popen(
        [sys.executable, "-m", "hsr8", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        said = process.stderr.read()
        assert process.wait(60) == 141
    assert said == b""


@pytest.mark.parametrize("arguments", [["--help"], ["--wrong"]])
def test_nobody_reads_anything(arguments):
    with subprocess.Popen(
        [sys.executable, "-m", "hsr8", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ) as process:
        process.stdout.close()
        assert process.wait(60) == 141


def test_a_full_disk_under_standard_error_is_no_failed_criterion():
    with open("/dev/full", "w") as full:
        words = [sys.executable, "-m", "hsr8", "info", "nowhere"]
        assert subprocess.run(words, stderr=full, check=False).returncode == 3


def test_a_name_of_any_bytes_is_printed_in_a_strict_locale(tmp_path):
    scenario = os.fsencode(tmp_path) + b"/a\xff.toml"
    Path(os.fsdecode(scenario)).write_text('extends = "walk"\n')
    done = subprocess.run(
        [sys.executable, "-m", "hsr8", "check", scenario],
        env=os.environ | {"PYTHONIOENCODING": "utf-8:strict"},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert rb"a\udcff.toml" in done.stdout


def test_the_module_can_be_run():
    done = subprocess.run(
        [sys.executable, "-m", "hsr8", "list", "--json"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    names = [s["name"] for s in json.loads(done.stdout)["scenarios"]]
    assert {"paper", "course", "quick"} <= set(names)


def test_nothing_is_looked_through_when_it_ends():
    script = (
        "import atexit, gc; atexit.register(gc.set_debug, gc.DEBUG_STATS); "
        "from hsr8.cli.main import entry; entry(['--version'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=60
    )
    told = [line for line in done.stderr.splitlines() if "objects in each generation" in line]
    assert told
    assert all(sum(map(int, line.split(":")[-1].split())) < 1000 for line in told)


@pytest.mark.parametrize(
    ("words", "closed", "code"),
    [("--help", ">&-", 0), ("list", ">&-", 0), ("list --json", ">&- 2>&-", 0), ("no", "2>&-", 2)],
)
def test_streams_that_are_closed_from_the_beginning(words, closed, code):
    line = f"exec {sys.executable} -m hsr8 {words} {closed}"
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("arguments", [["list"], ["list", "--json"], ["--help"], ["info", "RUN"]])
def test_a_full_disk_under_standard_output_is_one_message(arguments, tmp_path):
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full")
    path = RunFolder.create(tmp_path, "quick", 7)
    RunFolder(path, Manifest.now("quick", 7, (), "analytic"), "", movers=1).close("goal")
    words = [str(path) if word == "RUN" else word for word in arguments]
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "hsr8", *words],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    said = "hsr8: cannot write to standard output: No space left on device\n"
    assert (done.returncode, done.stderr) == (3, said)


def test_a_width_of_no_columns_is_none():
    words = [sys.executable, "-m", "hsr8", "list"]
    environment = {k: v for k, v in os.environ.items() if k != "COLUMNS"}
    wanted = subprocess.run(words, env=environment, capture_output=True, check=True).stdout
    for width in ("0", "00"):
        found = subprocess.run(
            words, env=environment | {"COLUMNS": width}, capture_output=True, check=True
        )
        assert found.stdout == wanted


@pytest.mark.parametrize("words", [["--help"], ["list"], ["run", "--help"]])
def test_everything_can_be_told_in_ascii(words):
    done = subprocess.run(
        [sys.executable, "-m", "hsr8", *words],
        env={"LC_ALL": "POSIX", "PYTHONUTF8": "0", "PATH": os.environ["PATH"]},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.isascii()


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("run quick --view foo", "--view foo: choose native or web"),
        ("sweep quick --seeds -3:3", "'-3:3' is neither a seed nor a range"),
        ("run quick --duration -1e3", "duration: must be greater than 0, got -1000.0"),
        ("render RUN --size -5x5", "--size '-5x5': give WIDTHxHEIGHT"),
        ("render RUN --speed -inf", "--speed -inf: give 0.01 to 1000"),
    ],
)
def test_a_wrong_value_is_one_mistake(line, said, tmp_path, capsys):
    path = RunFolder.create(tmp_path, "quick", 7)
    RunFolder(path, Manifest.now("quick", 7, (), "analytic"), "", movers=1).close("goal")
    words = [str(path) if word == "RUN" else word for word in line.split()]
    assert entry(words) == 2
    printed = capsys.readouterr().err
    assert printed.startswith("hsr8: ")
    assert said in printed
    assert "has no option" not in printed


def test_the_help_tells_what_may_be_left_out(capsys):
    entry(["--help"])
    assert "--version" in capsys.readouterr().out.partition("subcommands")[0]
    entry(["bug-report", "--help"])
    assert "hsr8 bug-report [-h] [RUN]" in capsys.readouterr().out
