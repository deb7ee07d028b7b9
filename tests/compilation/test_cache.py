"""Compiled code on disk: fresh, complete and found, or compiled again."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import compilation
from compilation import compiled
from compilation.decorator import Folders
from navigation.angles import wrap

FILES = {
    "library/__init__.py": "",
    "library/constants.py": "SCALE = 2.0\nUNUSED = 1.0\n",
    "library/other.py": "OTHER = 1.0\n",
    "library/inner.py": """
from compilation import compiled
from library.constants import (
    SCALE,
)

@compiled
def inner(x):
    return SCALE * x
""",
    "library/outer.py": """
from compilation import compiled
from library import inner

@compiled
def outer(x):
    return inner.inner(x) + 1.0
""",
}
PROBE = """
from library.outer import outer
print(outer(3.0), len(outer.stats.cache_hits))
"""


@pytest.fixture
def library(tmp_path):
    """Write a small library next to a copy of the package under test."""
    shutil.copytree(Path(compilation.__file__).parent, tmp_path / "compilation")
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def outer_of_three(folder, **variables):
    """Return the result in a new process, and whether its code was on disk."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    done = subprocess.run(
        [sys.executable, "-c", PROBE],
        cwd=folder,
        env=environment | {"PYTHONPATH": str(folder)} | variables,
        capture_output=True,
        text=True,
        check=True,
    )
    result, hits = done.stdout.split()
    return float(result), bool(int(hits))


def test_a_change_in_an_imported_module_compiles_again(library):
    assert outer_of_three(library) == (7.0, False)
    (library / "library/other.py").write_text("OTHER = 5.0\n")
    (library / "library/constants.py").write_text("SCALE = 2.0\nUNUSED = 3.0\n")
    assert outer_of_three(library) == (7.0, True)
    (library / "library/constants.py").write_text("SCALE = 3.0\n")
    assert outer_of_three(library) == (10.0, False)
    inner = library / "library/inner.py"
    inner.write_text(inner.read_text().replace("SCALE * x", "SCALE - x"))
    assert outer_of_three(library) == (1.0, False)


def test_cut_files_are_replaced_and_the_check_of_indices_has_its_own_code(library):
    """Files of the code and of its index."""
    outer_of_three(library)
    for kind in ("nbc", "nbi"):
        (file,) = library.rglob(f"*.{kind}")  # of the function that Python calls
        assert file.parent.name == "__pycache__"
        file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        assert outer_of_three(library) == (7.0, False)
    assert outer_of_three(library, NUMBA_BOUNDSCHECK="1") == (7.0, False)
    assert outer_of_three(library) == (7.0, True)


def test_without_a_folder_code_is_compiled_and_not_kept(monkeypatch):
    monkeypatch.setattr(Folders, "_locator_classes", ())
    function = compiled(wrap.py_func)
    assert function(1.0) == 1.0
    assert function.stats.cache_path is None


def test_a_closure_is_refused():
    factor = 2.0

    def scaled(x):
        return factor * x

    with pytest.raises(TypeError, match="closure; expected a function of a module"):
        compiled(scaled)
