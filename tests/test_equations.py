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
def defined(file: Path) -> dict[str, str]:
    """Docstrings of the functions, classes and methods in a file, by name."""
    docstrings = {}
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            docstrings[node.name] = ast.get_docstring(node) or ""
            if isinstance(node, ast.ClassDef):
                for method in (n for n in node.body if isinstance(n, ast.FunctionDef)):
                    docstrings[f"{node.name}.{method.name}"] = ast.get_docstring(method) or ""
    return docstrings


@pytest.mark.parametrize(("file", "name"), NAMES)
def test_what_the_table_names_exists(file, name):
    assert name in defined(path_of(file))


def test_every_equation_has_a_function_and_a_test():
    for number in range(1, 12):
        rows = [line for line in TEXT.splitlines() if line.startswith(f"| ({number})")]
        assert rows, number
        for row in rows:
            cells = row.split(" | ")
            assert re.search(r"`[\w/]+\.py::\w", cells[2]), row
            assert re.search(r"`[\w/]*test_\w+\.py::test_\w+`", cells[3]), row


@pytest.mark.parametrize("number", range(1, 12))
def test_docstrings_bear_the_number_of_their_equation(number):
    for row in (line for line in TEXT.splitlines() if line.startswith(f"| ({number})")):
        for file, name in re.findall(r"`([\w/]+\.py)::([\w.]+)`", row.split(" | ")[2]):
            docstrings = defined(path_of(file))[name]
            spans = re.findall(r"\((\d+)\)(?:-\((\d+)\))?", docstrings)
            assert any(int(a) <= number <= int(b or a) for a, b in spans), (name, docstrings)


def test_keys_in_the_tables_are_keys_of_a_scenario():
    for section, key in set(
        re.findall(r"\(`(evaluation|univector|gaze|planner\.paper)\.(\w+)`", TEXT)
    ):
        assert f"navigation.{section}.{key}" in parameters()
