"""Compiled code on disk: fresh, complete and found, or compiled again."""

import os
import shutil
import subprocess
import sys

import pytest

from compilation import compiled, store
from compilation.sources import ROOT

FILES = {
    "walking/__init__.py": "",
    "walking/constants.py": "SCALE = 2.0\n",
    "walking/other.py": "OTHER = 1.0\n",
    "walking/inner.py": """
from compilation import compiled
from walking.constants import (
    SCALE,
)

@compiled
def inner(x):
    return SCALE * x
""",
    "walking/outer.py": """
from compilation import compiled
from walking import inner

@compiled
def outer(x):
    return inner.inner(x) + 1.0
""",
}
PROBE = """
from walking.outer import outer
print(outer(3.0), len(outer.stats.cache_hits))
"""


@pytest.fixture
def library(tmp_path):
    """Write a small library next to a copy of the package under test."""
    shutil.copytree(ROOT / "compilation", tmp_path / "compilation")
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def outer_of_three(folder):
    """Return the result in a new process, and whether its code was on disk."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    done = subprocess.run(
        [sys.executable, "-c", PROBE],
        cwd=folder,
        env=environment | {"PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    result, hits = done.stdout.split()
    return float(result), bool(int(hits))


def test_a_change_in_an_imported_file_compiles_again(library):
    assert outer_of_three(library) == (7.0, False)
    (file,) = library.rglob(f"*{store.SUFFIX}")  # of the function that Python calls
    assert file.name.startswith("outer.outer-")
    assert outer_of_three(library) == (7.0, True)
    (library / "walking/other.py").write_text("OTHER = 5.0\n")
    assert outer_of_three(library) == (7.0, True)
    (library / "walking/constants.py").write_text("SCALE = 3.0\n")
    assert outer_of_three(library) == (10.0, False)
    inner = library / "walking/inner.py"
    inner.write_text(inner.read_text().replace("SCALE * x", "SCALE - x"))
    assert outer_of_three(library) == (1.0, False)
    assert outer_of_three(library) == (1.0, True)


def flip(content):
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


def test_damaged_files_are_replaced(library):
    outer_of_three(library)
    (file,) = library.rglob(f"*{store.SUFFIX}")
    for damage in (lambda _: b"", lambda content: content[: len(content) // 2], flip):
        file.write_bytes(damage(file.read_bytes()))
        assert outer_of_three(library) == (7.0, False)
    assert outer_of_three(library) == (7.0, True)


@pytest.fixture
def source(tmp_path, monkeypatch):
    """Return a source file, with a home and a temporary folder of the test."""
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(store.config, "CACHE_DIR", "")
    (tmp_path / "source").mkdir()
    store._roots.cache_clear()
    yield tmp_path / "source" / "file.py"
    store._roots.cache_clear()


STAMP = bytes(32)


def test_code_lies_next_to_its_source(source):
    assert store.save(source, "name", STAMP, b"code")
    assert [file.name for file in (source.parent / "__pycache__").iterdir()] == ["name"]
    assert store.load(source, "name", STAMP) == b"code"
    assert store.load(source, "name", b"x" * 32) is None


def test_in_a_read_only_folder_code_is_read_and_new_code_goes_to_the_user(source, monkeypatch):
    store.save(source, "name", STAMP, b"code")
    pycache = source.parent / "__pycache__"
    pycache.rename(source.parent / "kept")
    pycache.write_text("a file, so that nothing can be written there")
    assert store.save(source, "new", STAMP, b"new code")
    assert store.load(source, "new", STAMP) == b"new code"
    assert list(source.parents[1].glob("home/.cache/hsr8/*/new"))
    pycache.unlink()
    (source.parent / "kept").rename(pycache)
    assert store.load(source, "name", STAMP) == b"code"


def test_without_a_home_a_private_temporary_folder_is_used(source, monkeypatch):
    monkeypatch.setenv("HOME", "/proc/none")
    (source.parent / "__pycache__").write_text("")
    monkeypatch.setattr(store, "_is_writable", lambda folder: not folder.is_relative_to("/proc"))
    assert store.save(source, "name", STAMP, b"code")
    (folder,) = source.parents[1].glob("hsr8-compiled-*")
    assert folder.stat().st_mode & 0o777 == 0o700
    assert store.load(source, "name", STAMP) == b"code"
    folder.chmod(0o777)  # others could put code there
    store._roots.cache_clear()
    assert store.load(source, "name", STAMP) is None
    assert not store.save(source, "name", STAMP, b"code")
    monkeypatch.setattr(store, "folders", lambda source: iter(store._roots()))
    assert not store.can_keep()


def test_the_folder_of_the_environment_replaces_all_others(source, tmp_path, monkeypatch):
    monkeypatch.setattr(store.config, "CACHE_DIR", str(tmp_path / "chosen"))
    store.save(source, "name", STAMP, b"code")
    assert not (source.parent / "__pycache__").exists()
    assert store.load(source, "name", STAMP) == b"code"
    (file,) = (tmp_path / "chosen").rglob("name")
    assert file.is_file()


def test_damaged_files_are_listed(source, tmp_path, monkeypatch):
    monkeypatch.setattr(store.config, "CACHE_DIR", str(tmp_path / "chosen"))
    for name in ("whole", "broken"):
        store.save(source, f"{name}{store.SUFFIX}", STAMP, b"code")
    (broken,) = (tmp_path / "chosen").rglob("broken*")
    broken.write_bytes(broken.read_bytes()[:-1])
    assert [file for file in store.damaged() if file.is_relative_to(tmp_path)] == [broken]


def test_a_closure_is_refused():
    factor = 2.0

    def scaled(x):
        return factor * x

    with pytest.raises(TypeError, match="closure; expected a function of a module"):
        compiled(scaled)


def test_a_function_in_no_file_is_compiled_and_not_kept():
    names = {}
    exec("def doubled(x):\n    return 2.0 * x", names)
    function = compiled(names["doubled"])
    assert function(4.0) == 8.0
    assert function.stats.cache_path is None
