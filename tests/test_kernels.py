"""Rules that all compiled functions keep, see CONTRIBUTING.md."""

import ast
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted(
    path
    for package in ("hsr8", "navigation", "vision", "walking")
    for path in (ROOT / package).rglob("*.py")
    if "@njit" in path.read_text(encoding="utf-8")
)
FOREIGN = {"math", "numpy", "numba", "numpy.typing"}  # of a version that the cache knows


def kernels_of(path):
    """Return the compiled functions of a file, by name."""
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    return {
        name: value
        for name, value in vars(module).items()
        if hasattr(value, "py_func") and value.__module__ == module.__name__
    }


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_kernels_use_nothing_of_other_files(path):
    """Numba would not notice a change in another file and keep a stale kernel on disk."""
    imported = {
        alias.asname or alias.name
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module not in FOREIGN
        for alias in node.names
    }
    kernels = kernels_of(path)
    assert kernels
    for name, kernel in kernels.items():
        assert not imported & set(kernel.py_func.__code__.co_names), name


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_kernels_are_kept_and_give_the_same_bits_every_time(path):
    """Kept on disk; no `fastmath`, no `parallel`."""
    for kernel in kernels_of(path).values():
        assert kernel.targetoptions.get("nopython")
        assert type(kernel._cache).__name__ != "NullCache"
        assert not kernel.targetoptions.keys() & {"fastmath", "parallel"}
