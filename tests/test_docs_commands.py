"""Every command that the documentation shows is executed, long ones in short.

A page is followed from top to bottom in a folder of its own, in which finished runs lie and the
files that the page prints. What takes long or needs a window has a stand-in; the experiments in
``scripts/`` are given their arguments and go no further. A command unknown here fails the test.
"""

import argparse
import re
import runpy
import shlex
import shutil
import subprocess
import sys
import tomllib
from contextlib import nullcontext
from functools import cache, wraps
from pathlib import Path

import pytest
import tyro

from hsr8.api import run
from hsr8.cli.command_line import settings
from hsr8.cli.main import COMMANDS, entry, parse
from hsr8.errors import RenderingUnavailable
from hsr8.gl import require_gl
from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import find_description, installed_model, robot_names

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES += sorted((ROOT / "models").rglob("*.md"))
OURS = {"hsr8", "python", "make", "bash"}
OTHERS = {
    "cd",
    "cosmic-ray",
    "cr-report",
    "dask",
    "docker",
    "git",
    "jq",
    "pip",
    "ros2",
    "source",
}  # other people's programs
RUNS = ("quick", "course", "paper")  # that a page may take for done
STANDS_FOR = {
    **dict.fromkeys(("SCENARIO", "NAME", "FILE"), "quick"),
    **{"ROBOT": "hsr8", "RUN": "runs/quick", "A": "runs/quick", "B": "runs/course", "A:B": "0:2"},
    **{
        "MODEL": "my_robot.xml",
        "PNG": "picture.png",
        "IMAGE...": "image.png",
    },
}
# Appended, since of an option given twice the last one holds.
IN_SHORT = {
    "run": ["--duration", "0.1"],
    "sweep": ["--seeds", "0:2"],
    "bench": ["--quick"],
    "plot": ["--what", "zmp"],
    "render": ["--size", "64x64", "--fps", "10"],
    "replay": ["--time", "0.1"],
}
# Only read: the first needs labelled images, the others take long.
ONLY_READ = {"color-table", "doctor --compile", "robot check", "robot calibrate"}
WITHOUT_ARGUMENTS = {"list", "doctor", "schema"}
GOOD = {"success": True, "collisions": 0, "falls": 0, "path_length_m": 2.0, "exit_reason": "goal"}


class Parsed(Exception):
    """A script has read its arguments."""


class Instant:
    """A pool of sweeps whose runs all succeed at once."""

    def __init__(self):
        self.queue = []

    @property
    def free(self):
        return 1 - len(self.queue)

    def submit(self, job):
        self.queue.append(job)

    def wait(self, seconds):
        job = self.queue.pop(0)
        told = {"seed": job.seed, "outcome": "passed", "attempts": job.attempt, "run": job.run}
        return [(job, told | GOOD)]

    def close(self):
        pass


def lines_of_code(text):
    """Lines of code in their order, each with whether it can be nothing but a command."""
    fence = None
    for line in re.sub(r"\\\n\s*", "", text).splitlines():
        if line.startswith("```"):
            fence = line[3:] if fence is None else None
        elif fence is not None:
            if fence in ("bash", "sh", "console", ""):
                yield line.strip().removeprefix("$ "), fence != ""
        elif line.startswith("    "):
            yield line.strip(), False
        else:
            yield from ((inline, False) for inline in re.findall(r"`([^`]+)`", line))


def commands(text):
    """The commands that a page shows, in words, with where their output goes."""
    for line, surely in lines_of_code(text):
        first = line.removeprefix(".venv/bin/").split()[:2]
        if not surely and (len(first) < 2 or first[0] not in OURS or re.match(r"[\d(]", first[1])):
            continue  # a name or a version
        for part in re.sub(r"\$\(seq (\d+) (\d+)\)", r"\1 \2", line).split(" && "):
            lexer = shlex.shlex(part, posix=True, punctuation_chars="|>")
            lexer.whitespace_split = True
            words, into = list(lexer), None
            if ">" in words:
                words, into = words[: words.index(">")], words[words.index(">") + 1]
            if "|" in words:
                assert words[words.index("|") + 1] in OTHERS, line
                words = words[: words.index("|")]
            while words and re.fullmatch(r"[A-Z_]+=.*", words[0]):
                del words[0]
            if words:
                yield [words[0].removeprefix(".venv/bin/"), *words[1:]], into


def files(text):
    """Files that a page prints below their names: name and content."""
    return re.findall(
        r"`([\w-]+\.(?:toml|py|csv))`[^`\n]*:\n\n```\w+\n(.*?)^```", text, re.M | re.S
    )


@cache
def draws():
    """Whether there is OpenGL."""
    try:
        require_gl()
    except RenderingUnavailable:
        return False
    return True


def installed(robot):
    """Whether the model of a shipped robot is there, which a page may leave to its reader."""
    if robot not in robot_names():
        return True
    file = find_description(robot)
    return installed_model(read_description(file), file.parent) is not None


def hsr8(words, capsys):
    """Execute a command of ours; what it prints."""
    given = [STANDS_FOR.get(word, word) for word in words[1:]]
    if " ".join(given) in {*COMMANDS, "bench compare"} and given[0] not in WITHOUT_ARGUMENTS:
        given = [*given, "--help"]  # no more than its name
    elif (
        ONLY_READ & set(given)
        or " ".join(given[:2]) in ONLY_READ
        or ((given[0] in ("render", "doctor") or "--image" in given) and not draws())
        or (given[0] == "replay" and "--view" in given)  # lasts until Ctrl-C
        or "--ros" in given  # takes a port of this machine
        or ("--robot" in given and not installed(given[given.index("--robot") + 1]))
    ):
        parse(given)
        return ""
    else:
        # A fault after the end of a short run is an error, and a viewer opens a window.
        if given[0] == "run" and any("start=" in word or word == "--view" for word in given):
            options = parse(given)
            given = ["check", options.scenario, *(f"--set={word}" for word in settings(options))]
        given += IN_SHORT.get(given[0], []) if given[1:2] != ["compare"] else []
        if given[0] == "run" and "--camera" not in given:
            given += ["--camera", "analytic"]
    capsys.readouterr()
    code = entry(given)
    said = capsys.readouterr()
    # What is cut short cannot reach its goal; runs may differ.
    fine = (0, 1) if given[0] in ("run", "diff") else (0,)
    assert code in fine, f"{shlex.join(words)}: {said.err}"
    return said.out


def python(words, monkeypatch):
    """Run a program of the page; let one of the repository read its arguments."""
    if words[1] == "-m":
        module = words[4] if words[2] == "pdb" else words[2]
        assert module.split(".")[0] in ("hsr8", "mujoco", "pytest"), words
        return
    own = Path(words[1]).exists()
    path = Path(words[1]).resolve() if own else ROOT / words[1]
    reads = re.search(r"argparse|tyro|options_of", path.read_text())
    if not own and not reads:
        assert len(words) == 2 or "sys.argv" in path.read_text(), f"{path} takes no arguments"
        return
    monkeypatch.setattr(sys, "argv", words[1:])
    monkeypatch.syspath_prepend(path.parent)
    known = set(sys.modules)
    try:
        with nullcontext() if own else pytest.raises(Parsed):
            runpy.run_path(str(path), run_name="__main__")
    except SystemExit:
        pytest.fail(shlex.join(words))
    finally:
        for name in set(sys.modules) - known:
            if Path(getattr(sys.modules[name], "__file__", None) or "").parent == path.parent:
                del sys.modules[name]


def run_in_short(*scenario, settings=(), **options):
    """``hsr8.run`` for programs of a page."""
    short = {"duration": 0.1, "camera.source": "analytic"}
    return run(*scenario, settings=dict(settings) | short, **options)


def others(words):
    """What other programs can be asked for: a command of theirs, and our extras."""
    if words[:2] == ["pip", "install"]:
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        for extra in re.findall(r"^\.\[(\w+)\]", words[-1]):
            assert extra in project["optional-dependencies"]
    if words[:2] == ["docker", "run"] and "ros:jazzy" not in words:
        parse(words[words.index("hsr8") + 1 :])
    assert words[0] in OTHERS, f"{shlex.join(words)}: say in {__name__} how this is executed"


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A short run with a log, rendered camera aside."""
    out = tmp_path_factory.mktemp("finished")
    short = ["--camera", "analytic", "--duration", "0.5", "--quiet"]
    assert entry(["run", "quick", *short, "--out", str(out)]) == 1
    return out / "quick"


@pytest.fixture
def stand_ins(monkeypatch, tmp_path, finished):
    """A folder with runs and a robot, where nothing opens a window or takes hours."""
    monkeypatch.chdir(tmp_path)
    for name in RUNS:
        shutil.copytree(finished, tmp_path / "runs" / name)
    shutil.copy(ROOT / "models" / "hsr8" / "hsr8.xml", tmp_path / "my_robot.xml")
    monkeypatch.setattr("hsr8.api.run", run_in_short)
    monkeypatch.setattr("hsr8.evaluation.sweep.runs.require_gl", lambda: "none")
    monkeypatch.setattr("hsr8.evaluation.sweep.runs.open_pool", lambda name, workers: Instant())
    monkeypatch.setattr("hsr8.cli.recorded_run._write_video", lambda path, options: None)
    monkeypatch.setattr("hsr8.render.viewer.has_display", lambda: True)
    monkeypatch.setattr("hsr8.render.viewer.show", lambda logs: 0)
    monkeypatch.setattr("hsr8.render.viewer.screenshot", lambda logs, time, size: b"PNG")
    read, call = argparse.ArgumentParser.parse_args, tyro.cli
    subcommands = tyro.extras.subcommand_cli_from_dict

    def parse_args(parser, *given, **options):
        if parser.prog == Path(sys.argv[0]).name:
            read(parser, *given, **options)
            raise Parsed
        return read(parser, *given, **options)

    def unused(function):
        return (
            wraps(function)(lambda *_, **__: None) if not isinstance(function, type) else function
        )

    def cli(function, *given, **options):
        if given or options:
            return call(function, *given, **options)
        call(unused(function))
        raise Parsed

    def from_dict(functions):
        subcommands({name: unused(function) for name, function in functions.items()})
        raise Parsed

    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", parse_args)
    monkeypatch.setattr(tyro, "cli", cli)
    monkeypatch.setattr(tyro.extras, "subcommand_cli_from_dict", from_dict)


def follow(text, capsys, monkeypatch):
    """Do what a page says; the commands done."""
    done = 0
    for name, content in files(text):
        Path(name).write_text(content)
    for words, into in commands(text):
        done += 1
        if words[0] == "hsr8":
            said = hsr8(words, capsys)
            if into:
                Path(into).write_text(said)
        elif words[0] == "python":
            python(words, monkeypatch)
        elif words[0] == "bash":
            subprocess.run(["bash", "-n", ROOT / words[1]], check=True)
        elif words[0] == "make":
            verbs = re.findall(r"make ([a-z-]+)", " ".join(words))
            subprocess.run(["make", "-n", "-C", ROOT, *verbs], check=True, capture_output=True)
        else:
            others(words)
    return done


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_command_of_the_page_works(page, stand_ins, capsys, monkeypatch):
    follow(page.read_text(), capsys, monkeypatch)
