"""The version is stated once; the shell scripts are valid."""

import subprocess
import tomllib
from pathlib import Path

import pytest

import hsr8

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def test_version_is_that_of_the_project() -> None:
    assert hsr8.__version__ == PROJECT["project"]["version"]


@pytest.mark.parametrize(
    "script", [*sorted(ROOT.glob("scripts/*.sh")), ROOT / ".ci" / "run"], ids=lambda p: p.name
)
def test_shell_script_parses(script: Path) -> None:
    subprocess.run(["bash", "-n", script], check=True)
