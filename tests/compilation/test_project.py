"""Rules that all compiled functions of the project keep, see CONTRIBUTING.md."""

import ast
import importlib

import pytest

from compilation.function import OPTIONS
from compilation.sources import PACKAGES, ROOT, closure

FILES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
COMPILED = [path for path in FILES if "\n@compiled\n" in path.read_text(encoding="utf-8")]
PARTS = [path.relative_to(ROOT).with_suffix("").parts for path in COMPILED]


def imported_files(path):
    """Return the project files that a file imports, from its syntax tree."""
    modules = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports are not followed"
            modules |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    files = {ROOT.joinpath(*name.split(".")) for name in modules if name.split(".")[0] in PACKAGES}
    return {
        file
        for stem in files
        for file in (stem.with_name(f"{stem.name}.py"), stem / "__init__.py")
        if file.is_file()
    }


def test_every_imported_project_file_is_a_source_of_the_importing_file():
    for path in FILES:
        assert imported_files(path) <= closure(path), path


@pytest.mark.parametrize("parts", PARTS, ids="/".join)
def test_compiled_functions_are_kept_and_give_the_same_bits_every_time(parts):
    """Kept on disk; no `fastmath`, no `parallel`."""
    module = importlib.import_module(".".join(parts))
    kept = 0
    for value in vars(module).values():
        if hasattr(value, "py_func") and value.__module__ == module.__name__:
            assert type(value._cache).__name__ == "CodeCache"
            assert value.targetoptions == OPTIONS
            kept += 1
    assert kept


def test_all_compiled_functions_use_the_decorator_of_the_project():
    importing = [path for path in FILES if "import njit" in path.read_text(encoding="utf-8")]
    assert not importing
