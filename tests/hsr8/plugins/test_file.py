"""Planners and gazes named in a scenario as FILE.py:CLASS."""

import json
import os
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

import hsr8
from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.plugins.file import PREFIX, digests, load_plugin, require_plugins
from hsr8.scenario.plugin import Plugin
from hsr8.sweep.folder import SweepFolder

FAST = ("--body", "kinematic", "--camera", "analytic", "--quiet")
SETTINGS = ("robot.body=kinematic", "camera.source=analytic", "duration=1.5")
SOURCE = """
from dataclasses import dataclass

import numpy as np

from speeds import SPEED
from navigation.decision import GazeDecision, MotionDecision


@dataclass
class Ahead:
    steps: int = 0

    def plan(self, belief, task):
        self.steps += 1
        return MotionDecision(np.array([SPEED, 0.0, 0.0]))


class Down:
    def choose(self, belief, task, motion):
        return GazeDecision(0.0, -0.5)


class Silent:
    pass


class Trips(Ahead):
    def plan(self, belief, task):
        if belief.time > 0.5:
            raise ZeroDivisionError("too near")
        return super().plan(belief, task)


class Breaks:
    def __init__(self):
        raise RuntimeError("no\\nway")


nothing = 3
"""
ERRING = SOURCE.split("\n").index('            raise ZeroDivisionError("too near")') + 1
LINE = SOURCE.split("\n").index('        raise RuntimeError("no\\nway")') + 1


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Working directory with a file of plugins and a module that it imports."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    tmp_path.joinpath("speeds.py").write_text("SPEED = 0.05\n")
    tmp_path.joinpath("mine.py").write_text(SOURCE)
    yield tmp_path
    sys.modules.pop("speeds", None)


def test_a_process_executes_the_present_content_and_leaves_no_bytecode(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    file = tmp_path / "mine.py"
    for value in (1, 2):
        file.write_text(f"class Mine:\n    value = {value}\n")
        os.utime(file, (1e9, 1e9))  # time and size of both versions are equal
        assert load_plugin(f"{file}:Mine").value == value
        del sys.modules[f"{PREFIX}{file}"]
    assert list(tmp_path.iterdir()) == [file]


def test_instances_are_new_and_the_file_is_executed_once(folder):
    first, second = load_plugin("mine.py:Ahead"), load_plugin("mine.py:Ahead")
    assert first is not second
    assert type(first) is type(second)
    assert type(load_plugin(f"{folder}/mine.py:Ahead")) is type(first)


@pytest.mark.parametrize(
    ("reference", "expected"),
    [
        ("none.py:Ahead", "cannot read none.py: No such file"),
        ("mine.py:Behind", "mine.py has no class Behind; expected Ahead, Down, Silent, Trips"),
        ("mine.py:Breaks", rf"Breaks\(\) failed: RuntimeError: no way \(line {LINE}\)"),
        ("wrong.py:Ahead", r"wrong.py failed: NameError: .* \(line 2\)"),
        ("text.py:Ahead", "text.py failed: SyntaxError"),
    ],
)
def test_a_plugin_that_cannot_be_loaded_is_reported_in_one_line(folder, reference, expected):
    folder.joinpath("wrong.py").write_text("x = 1\ny = z\n")
    folder.joinpath("leaves.py").write_text("raise SystemExit(1)\n")
    folder.joinpath("text.py").write_text("two words\n")
    folder.joinpath("empty.py").write_text("")
    for _ in range(2):  # a file that failed is executed again
        with pytest.raises(UsageError, match=f"^{reference}: {expected}") as error:
            require_plugins(Plugin(gaze=reference))
        assert "\n" not in str(error.value)


@given(other=st.binary(min_size=1, max_size=20))
def test_digests_depend_on_the_content_of_the_file(tmp_path_factory, other):
    file = tmp_path_factory.mktemp("plugin") / "mine.py"
    file.write_bytes(b"")
    plugin = Plugin(planner=f"{file}:A", gaze=f"{file}:B")
    before = digests(plugin)
    file.write_bytes(other)
    after = digests(plugin)
    assert set(before) == set(after) == {plugin.planner, plugin.gaze}
    assert all(before[name] != after[name] for name in before)
    assert digests(Plugin()) == {}


def test_plugins_of_a_scenario_decide_as_the_same_objects_in_python(folder):
    named = {"plugin.planner": "mine.py:Ahead", "plugin.gaze": "mine.py:Down"}
    fast = dict(setting.split("=") for setting in SETTINGS) | {"duration": 1.5}
    given_ = hsr8.run(
        "quick",
        settings=fast,
        planner=load_plugin("mine.py:Ahead"),
        gaze=load_plugin("mine.py:Down"),
    )
    usual = hsr8.run("quick", settings=fast)
    from_file = hsr8.run("quick", settings=fast | named)
    assert from_file.metrics["state_hash"] == given_.metrics["state_hash"]
    assert from_file.metrics["state_hash"] != usual.metrics["state_hash"]


RUNS = """
from pathlib import Path

Path(__file__).with_name("ran").touch()


class Mine:
    def plan(self, belief, task):
        raise RuntimeError("called")
"""


@pytest.fixture
def stranger(tmp_path, monkeypatch):
    """Folder with a scenario, that of a run and a plugin, which leaves a file when it runs."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    folder = tmp_path / "stranger"
    folder.mkdir()
    (folder / "mine.py").write_text(RUNS)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    return folder


def named_by(file, reference, **keys):
    """Write a scenario that names a planner; return its path."""
    lines = [f"{key} = {value}" for key, value in keys.items()]
    file.write_text("\n".join(['extends = "quick"', *lines, f'plugin.planner = "{reference}"\n']))
    return str(file)


@pytest.mark.parametrize(
    ("where", "reference", "words", "runs"),
    [
        ("stranger/yard.toml", "mine.py:Mine", (), True),
        ("elsewhere/yard.toml", "../stranger/mine.py:Mine", (), False),
        ("elsewhere/yard.toml", "link.py:Mine", (), False),
        ("elsewhere/yard.toml", "{folder}/mine.py:Mine", ("--trust",), True),
        ("elsewhere/yard.toml", "x.py:X", ("--set", "plugin.planner={folder}/mine.py:Mine"), True),
    ],
)
@pytest.mark.usefixtures("sweeps_in_process")
def test_code_runs_only_if_a_person_named_it(stranger, capsys, where, reference, words, runs):
    (stranger.parent / "elsewhere/link.py").symlink_to(stranger / "mine.py")
    file = named_by(stranger.parent / where, reference.format(folder=stranger))
    words = [word.format(folder=stranger) for word in words]
    for command in ("check", "sweep", "run"):
        if command == "check" and "--trust" in words:
            continue
        more = ["--seeds", "0:1"] if command == "sweep" else []
        fast = [] if command == "check" else FAST
        code = entry([command, file, *more, *fast, *words])
        message = capsys.readouterr()
        if command == "check":
            assert code == 0
            assert not (stranger / "ran").exists()
            assert ("runs with trust only" in message.out) == (not runs)
        elif runs:
            assert (stranger / "ran").exists()
            assert command == "sweep" or "RuntimeError: called" in message.err
            (stranger / "ran").unlink()
            sys.modules.pop(f"{PREFIX}{stranger / 'mine.py'}")
        else:
            assert code == 2
            assert not (stranger / "ran").exists()
            assert f"{file}:2: plugin.planner: names code that would run, got " in message.err
            assert "expected --trust" in message.err


def test_python_asks_for_trust_as_the_command_line_does(stranger):
    file = named_by(stranger.parent / "elsewhere/yard.toml", f"{stranger}/mine.py:Mine")
    with pytest.raises(UsageError, match=r"names code .* \(in Python, trust=True\)"):
        hsr8.run(file, settings=SETTINGS)
    assert not (stranger / "ran").exists()
    with pytest.raises(RuntimeError, match="called"):
        hsr8.run(hsr8.load_scenario(file, SETTINGS, trust=True))
    with pytest.raises(RuntimeError, match="called"):
        hsr8.run(file, settings=[*SETTINGS, f"plugin.planner={stranger}/mine.py:Mine"])


def test_a_run_folder_runs_no_code_without_trust(stranger, capsys):
    assert entry(["run", "quick", *FAST, "--duration", "0.3", "--out", str(stranger)]) == 1
    (run,) = stranger.glob("quick/*")
    scenario = run / "scenario.toml"
    text = scenario.read_text()
    for file in (stranger / "mine.py", run / "mine.py"):
        file.write_text(RUNS)
        named = text.replace('[plugin]\nplanner = ""', f'[plugin]\nplanner = "{file}:Mine"')
        scenario.write_text(named)
        for command in ("verify", "info", "plot", "diff", "replay", "render"):
            more = {"diff": [str(run)], "replay": ["--screenshot", "x"], "render": ["--size", "x"]}
            entry([command, str(run), *more.get(command, [])])
            message = capsys.readouterr().err
            assert ("names code" in message) == (command == "verify")
            assert not list(stranger.rglob("ran"))
    assert entry(["verify", str(run), "--trust"]) == 2
    assert "RuntimeError: called" in capsys.readouterr().err
    assert (run / "ran").exists()


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("class Mine(:", "is not Python: SyntaxError: "),
        ("(" * 10_000, "is not Python: "),
        ("if True:\n    class Mine: pass\n", ""),
    ],
)
def test_check_reads_the_file_of_a_plugin_without_running_it(stranger, capsys, source, expected):
    (stranger / "mine.py").write_text(RUNS.replace("class Mine", "class Old") + source)
    code = entry(["check", named_by(stranger / "yard.toml", "mine.py:Mine")])
    assert code == (2 if expected else 0)
    message = capsys.readouterr().err
    assert expected in message
    assert message.count("\n") == (1 if expected else 0)
    assert not (stranger / "ran").exists()


def test_a_run_records_the_digest_and_can_be_verified(folder, capsys):
    plugins = ("--set", "plugin.planner=mine.py:Ahead", "plugin.gaze=mine.py:Down", "duration=1.0")
    assert entry(["run", "quick", *FAST, *plugins, "--out", "runs"]) == 1
    (manifest,) = folder.glob("runs/quick/*/manifest.json")
    libraries = json.loads(manifest.read_text())["libraries"]
    assert digests(Plugin(planner="mine.py:Ahead")).items() <= libraries.items()
    assert entry(["verify", "runs"]) == 2
    assert "names code" in capsys.readouterr().err
    assert entry(["verify", "runs", "--trust"]) == 0


@pytest.mark.usefixtures("sweeps_in_process")
def test_a_sweep_refuses_to_continue_with_another_file(folder, capsys):
    sweep = ["sweep", "quick", *FAST, "--seeds", "0:1", "--out", "s"]
    plugins = ["--set", "plugin.planner=mine.py:Ahead", "duration=0.3"]
    assert entry([*sweep, *plugins]) == 1
    folder.joinpath("mine.py").write_text(SOURCE + "\n")
    assert entry([*sweep, *plugins]) == 2
    assert "mine.py:Ahead: " in capsys.readouterr().err


def test_a_walk_has_no_planner(folder):
    with pytest.raises(hsr8.errors.ScenarioError, match="has no planner"):
        hsr8.load_scenario("walk", ["plugin.planner=mine.py:Ahead"])


def test_an_error_in_a_plugin_is_reported_with_its_line(folder, capsys):
    message = "ZeroDivisionError: too near"
    plugins = ("--set", "plugin.planner=mine.py:Trips", "duration=1.0")
    assert entry(["run", "quick", *FAST, *plugins, "--out", "runs"]) == 2
    error = capsys.readouterr().err
    assert f"{folder / 'mine.py'}, line {ERRING}: {message}" in error
    assert "internal" not in error
    (manifest,) = folder.glob("runs/quick/*/manifest.json")
    assert json.loads(manifest.read_text())["exit_reason"] == "error"
    assert message in (manifest.parent / "crash.txt").read_text()
    assert entry(["info", "runs"]) == 0


@pytest.mark.usefixtures("sweeps_in_process")
def test_an_error_in_a_plugin_is_a_crashed_run_of_a_sweep(folder, capsys):
    plugins = ("--set", "plugin.planner=mine.py:Trips", "duration=1.0")
    assert entry(["sweep", "quick", *FAST, "--seeds", "0:2", "--out", "s", *plugins]) == 3
    rows = SweepFolder.read(folder / "s").results()
    assert {row["seed"] for row in rows} == {0, 1}
    assert {row["outcome"] for row in rows} == {"crashed"}
    assert "0 of 2" in (folder / "s" / "report.md").read_text()
