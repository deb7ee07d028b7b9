"""Every command that the documentation shows is valid, and those that only read are executed.

A page is followed from top to bottom in a folder that has a finished run and the files that the
page prints. A command unknown here fails the test.
"""

import re
import shlex
import shutil
import tomllib
from pathlib import Path

import pytest

from hsr8.cli.main import COMMANDS, entry, parse

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES += sorted((ROOT / "models").rglob("*.md"))
OURS = {"hsr8", "python", "make", "bash"}
OTHERS = {"cd", "cosmic-ray", "dask", "docker", "git", "jq", "pip", "ros2", "source"}
EXECUTED = {"check", "diff", "info", "list", "plot", "schema"}
RUNS = ("quick", "course", "paper")  # that a page may take for done
STANDS_FOR = {
    **dict.fromkeys(("SCENARIO", "NAME", "FILE"), "quick"),
    **{"ROBOT": "hsr8", "RUN": "runs/quick", "A": "runs/quick", "B": "runs/course", "A:B": "0:2"},
    **{"MODEL": "my_robot.xml", "PNG": "picture.png", "IMAGE...": "image.png"},
}


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
    """The commands that a page shows, in words."""
    for line, surely in lines_of_code(text):
        first = line.removeprefix(".venv/bin/").split()[:2]
        if not surely and (len(first) < 2 or first[0] not in OURS or re.match(r"[\d(]", first[1])):
            continue  # a name or a version
        for part in re.sub(r"\$\(seq (\d+) (\d+)\)", r"\1 \2", line).split(" && "):
            lexer = shlex.shlex(part, posix=True, punctuation_chars="|>")
            lexer.whitespace_split = True
            words = list(lexer)
            if "|" in words:
                assert words[words.index("|") + 1] in OTHERS, line
            while words and re.fullmatch(r"[A-Z_]+=.*", words[0]):
                del words[0]
            end = next((k for k, word in enumerate(words) if word in {"|", ">"}), len(words))
            if words:
                yield [words[0].removeprefix(".venv/bin/"), *words[1:end]]


def hsr8(given):
    """Parse a command; execute it if it only reads."""
    given = [STANDS_FOR.get(word, word) for word in given]
    if " ".join(given) in {*COMMANDS, "bench compare"} and given != ["list"]:
        given = [*given, "--help"]  # no more than its name
    made = all(Path(word).exists() for word in given if word.startswith("runs/"))
    if given[0] in EXECUTED and made:
        assert entry(given) in ((0, 1) if given[0] == "diff" else (0,)), given
    else:
        parse(given)


def python(given):
    """Compile a program; one of the repository has the options that it is given."""
    if given[0] == "-m":
        module = given[3] if given[1] == "pdb" else given[1]
        assert module.split(".")[0] in ("hsr8", "mujoco", "pytest"), given
        return
    own = Path(given[0])
    source = (own if own.exists() else ROOT / given[0]).read_text()
    compile(source, given[0], "exec")
    for option in (word.partition("=")[0] for word in given[1:] if word.startswith("--")):
        assert option in source or option[2:].replace("-", "_") in source, given


def others(words):
    """Check what can be checked of other programs: our targets, scripts and extras."""
    if words[0] == "make":
        verbs = re.findall(r"make ([a-z-]+)", " ".join(words))
        targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.M)
        assert set(verbs) <= set(targets), words
    elif words[0] == "bash":
        assert (ROOT / words[1]).exists(), words
    elif words[:2] == ["pip", "install"]:
        extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        for extra in re.findall(r"^\.\[(\w+)\]", words[-1]):
            assert extra in extras["optional-dependencies"]
    elif words[:2] == ["docker", "run"] and "ros:jazzy" not in words:
        parse(words[words.index("hsr8") + 1 :])
    else:
        assert words[0] in OTHERS, words


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A short run without images."""
    out = tmp_path_factory.mktemp("finished")
    short = ["--camera", "analytic", "--duration", "0.5", "--quiet"]
    assert entry(["run", "quick", *short, "--out", str(out)]) == 1
    return out / "quick"


@pytest.fixture
def reader(monkeypatch, tmp_path, finished):
    """A folder with runs and a robot."""
    monkeypatch.chdir(tmp_path)
    for name in RUNS:
        shutil.copytree(finished, tmp_path / "runs" / name)
    shutil.copy(ROOT / "models" / "hsr8" / "hsr8.xml", tmp_path / "my_robot.xml")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_command_of_the_page_is_valid(page, reader):
    text = page.read_text()
    printed = r"`([\w-]+\.(?:toml|py|csv))`[^`\n]*:\n\n```\w+\n(.*?)^```"
    for name, content in re.findall(printed, text, re.M | re.S):
        Path(name).write_text(content)
    for words in commands(text):
        act = {"hsr8": hsr8, "python": python}.get(words[0])
        others(words) if act is None else act(words[1:])
