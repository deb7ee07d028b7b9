"""The files that install, build and check the project agree with each other."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

import hsr8

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
LOCK = (ROOT / "requirements.lock").read_text()
PINS = dict(re.findall(r"^([a-z0-9-]+)==([^ ]+)", LOCK, flags=re.MULTILINE))


def requirement_name(requirement: str) -> str:
    return re.split(r"[<>=!~; ]", requirement, maxsplit=1)[0].lower()


def test_every_pin_has_a_hash() -> None:
    entries = re.split(r"^(?=[a-z])", LOCK, flags=re.MULTILINE)[1:]
    assert len(entries) >= len(PINS) > 0
    assert [entry.split("==")[0] for entry in entries if "--hash=sha256:" not in entry] == []


@pytest.mark.parametrize("pattern", [r"https?:", r"file:", r"--(extra-)?index", r"@ ", r"(^| )/\w"])
def test_lock_names_no_index_and_no_machine(pattern: str) -> None:
    assert not re.search(pattern, LOCK, flags=re.MULTILINE)


def test_lock_covers_dependencies_and_build_backend() -> None:
    """The editable install must not need the network."""
    required = [
        *PROJECT["project"]["dependencies"],
        *PROJECT["dependency-groups"]["dev"],
        *PROJECT["build-system"]["requires"],
    ]
    assert [name for name in map(requirement_name, required) if name not in PINS] == []
    for requirement in required:
        if match := re.fullmatch(r"([a-z0-9-]+)==([\d.]+)\.\*", requirement):
            assert PINS[match[1]].startswith(match[2] + ".")


def test_version_is_that_of_the_project() -> None:
    assert hsr8.__version__ == PROJECT["project"]["version"]


def test_make_alone_lists_every_target() -> None:
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^\.PHONY: (.*)$", makefile, re.MULTILINE)[0].split())
    listed = subprocess.run(
        ["make", "--no-print-directory"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert targets
    assert set(re.findall(r"make (\S+)", listed)) >= targets


@pytest.mark.parametrize(
    "script", [*sorted(ROOT.glob("scripts/*.sh")), ROOT / ".ci" / "run"], ids=lambda p: p.name
)
def test_shell_script_parses(script: Path) -> None:
    subprocess.run(["bash", "-n", script], check=True)
