"""docs/equations.md names functions and tests that exist."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from hsr8.scenario.reference import parameters

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "equations.md").read_text(encoding="utf-8")
PACKAGES = ("compilation", "hsr8", "navigation", "vision", "walking", "scripts", "tests")
NAMES = sorted(set(re.findall(r"`([\w/]+\.py)::([\w.]+)`", TEXT)))


def path_of(file: str) -> Path:
    """A file of the table, named from `navigation` on where no package is named."""
    if file.partition("/")[0] not in PACKAGES:
        tests = Path(file).name.startswith("test_")
        file = f"tests/navigation/{file}" if tests else f"navigation/{file}"
    return ROOT / file


@cache
def defined(file: Path) -> set[str]:
    """Names of the functions, classes and methods in a file."""
    body = ast.parse(file.read_text(encoding="utf-8")).body
    owners = [("", body), *((f"{c.name}.", c.body) for c in body if isinstance(c, ast.ClassDef))]
    kinds = ast.ClassDef | ast.FunctionDef
    return {
        prefix + node.name for prefix, nodes in owners for node in nodes if isinstance(node, kinds)
    }


@pytest.mark.parametrize(("file", "name"), NAMES)
def test_what_the_table_names_exists(file, name):
    assert name in defined(path_of(file))


def test_keys_in_the_tables_are_keys_of_a_scenario():
    for section, key in set(
        re.findall(r"\(`(evaluation|univector|gaze|planner\.paper)\.(\w+)`", TEXT)
    ):
        assert f"navigation.{section}.{key}" in parameters()
