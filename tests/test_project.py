"""The files that install, build and check the project agree with each other."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

import hsr8
from hsr8.scenario.loader import loads

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
LOCK = (ROOT / "requirements.lock").read_text()
PINS = dict(re.findall(r"^([a-z0-9-]+)==([^ ]+)", LOCK, flags=re.MULTILINE))


def requirement_name(requirement: str) -> str:
    return re.split(r"[<>=!~; ]", requirement, maxsplit=1)[0].lower()


def test_every_pin_carries_a_hash() -> None:
    entries = re.split(r"^(?=[a-z])", LOCK, flags=re.MULTILINE)[1:]
    assert len(entries) >= len(PINS) > 0
    assert [entry.split("==")[0] for entry in entries if "--hash=sha256:" not in entry] == []


@pytest.mark.parametrize("pattern", [r"https?:", r"file:", r"--(extra-)?index", r"@ ", r"(^| )/\w"])
def test_lock_names_no_index_and_no_machine(pattern: str) -> None:
    assert not re.search(pattern, LOCK, flags=re.MULTILINE)


def test_lock_covers_what_the_project_asks_for() -> None:
    asked = [*PROJECT["project"]["dependencies"], *PROJECT["dependency-groups"]["dev"]]
    assert [name for name in map(requirement_name, asked) if name not in PINS] == []


def test_lock_covers_the_build_backend() -> None:
    """The editable install must not need the network."""
    backend = map(requirement_name, PROJECT["build-system"]["requires"])
    assert set(backend) <= set(PINS)


def test_exact_pins_are_kept() -> None:
    for requirement in PROJECT["project"]["dependencies"]:
        if match := re.fullmatch(r"([a-z0-9-]+)==([\d.]+)\.\*", requirement):
            assert PINS[match[1]].startswith(match[2] + ".")


def test_version_is_one() -> None:
    assert hsr8.__version__ == PROJECT["project"]["version"]
    changelog = (ROOT / "CHANGELOG.md").read_text()
    assert re.search(
        rf"^## \[({re.escape(hsr8.__version__)}|Unreleased)\]", changelog, re.MULTILINE
    )


def test_make_alone_lists_every_verb() -> None:
    verbs = set(
        re.findall(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[0].split()
    )
    assert verbs >= {
        "setup",
        "run",
        "test",
        "lint",
        "types",
        "layers",
        "fix",
        "lock",
        "build",
        "clean",
    }
    told = subprocess.run(
        ["make", "--no-print-directory"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert set(re.findall(r"make (\S+)", told)) >= verbs


def test_ci_runs_only_verbs_that_exist() -> None:
    script = (ROOT / ".ci" / "run").read_text()
    verbs = re.search(r"^for verb in (.*); do$", script, re.MULTILINE)
    assert verbs
    makefile = (ROOT / "Makefile").read_text()
    assert all(re.search(rf"^{verb}:", makefile, re.MULTILINE) for verb in verbs[1].split())
    assert "bash .ci/run" in (ROOT / ".github" / "workflows" / "ci.yml").read_text()


@pytest.mark.parametrize(
    "script", [*sorted(ROOT.glob("scripts/*.sh")), ROOT / ".ci" / "run"], ids=lambda p: p.name
)
def test_shell_script_parses_and_stops_at_errors(script: Path) -> None:
    subprocess.run(["bash", "-n", script], check=True)
    assert "set -euo pipefail" in script.read_text()


def test_every_script_is_told_of_or_shared() -> None:
    """A study nobody can find is one nobody repeats."""
    pages = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), ROOT / "Makefile"]
    scripts = sorted(ROOT.glob("scripts/*.py")) + sorted(ROOT.glob("scripts/*.sh"))
    told = "".join(page.read_text() for page in pages)
    code = "".join(script.read_text() for script in scripts)
    shared = set(re.findall(r"^\s*(?:from|import) (\w+)", code, re.MULTILINE))
    assert [s.name for s in scripts if s.name not in told and s.stem not in shared] == []


def test_scenarios_in_the_readme_are_right() -> None:
    examples = re.findall(r"^```toml\n(.*?)^```", (ROOT / "README.md").read_text(), re.M | re.S)
    assert examples
    for text in examples:
        assert loads(text).description
