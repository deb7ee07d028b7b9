"""Rules that all compiled functions of the project keep, see CONTRIBUTING.md."""

import importlib
from pathlib import Path

import pytest

import compilation
from compilation.function import OPTIONS

ROOT = Path(compilation.__file__).parents[1]
LIBRARIES = ("hsr8", "navigation", "vision", "walking")
FILES = sorted(path for library in LIBRARIES for path in (ROOT / library).rglob("*.py"))
COMPILED = [path for path in FILES if "\n@compiled\n" in path.read_text(encoding="utf-8")]
MODULES = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in COMPILED]


@pytest.mark.parametrize("module", MODULES)
def test_compiled_functions_are_kept_and_give_the_same_bits_every_time(module):
    """Kept on disk; no `fastmath`, no `parallel`."""
    here = importlib.import_module(module)
    functions = [value for value in vars(here).values() if hasattr(value, "py_func")]
    own = [function for function in functions if function.__module__ == module]
    assert own
    assert all(function.stats.cache_path for function in own)
    assert all(function.targetoptions == OPTIONS for function in own)


def test_all_compiled_functions_use_the_decorator_of_the_project():
    importing = [path for path in FILES if "import njit" in path.read_text(encoding="utf-8")]
    assert not importing
