import os
import subprocess
import sys
from pathlib import Path

import pytest

from hsr8 import kernel_cache
from hsr8.kernel_cache import FOLDERS, VARIABLE, choose_kernel_cache

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def writable(tmp_path, monkeypatch):
    """Make some of checkout, home and temporary folder writable."""
    folders = {name: tmp_path / name for name in ("root", "home", "temporary")}
    for folder in folders.values():
        folder.mkdir()
    for folder in FOLDERS:
        (folders["root"] / folder).mkdir(parents=True)
    monkeypatch.setenv("HOME", str(folders["home"]))
    monkeypatch.setattr(kernel_cache.tempfile, "tempdir", str(folders["temporary"]))
    for variable in (VARIABLE, "XDG_CACHE_HOME"):
        monkeypatch.setenv(variable, "to be put back")
        monkeypatch.delenv(variable)

    def only(*names):
        allowed = [folders[name] for name in names]

        def access(path, _mode):  # root may write everywhere
            return any(Path(path).is_relative_to(folder) for folder in allowed)

        monkeypatch.setattr(kernel_cache.os, "access", access)
        return folders

    return only


@pytest.mark.parametrize("names", [("root",), ("home",), ("root", "home")])
def test_numba_chooses_if_it_can(writable, names):
    folders = writable(*names)
    assert choose_kernel_cache(folders["root"]) == ""
    assert VARIABLE not in os.environ


def test_else_a_private_folder_is_made_once(writable):
    folders = writable("temporary")
    chosen = choose_kernel_cache(folders["root"])
    assert os.environ[VARIABLE] == chosen
    assert Path(chosen).parent == folders["temporary"]
    assert Path(chosen).stat().st_mode & 0o777 == 0o700
    del os.environ[VARIABLE]
    assert choose_kernel_cache(folders["root"]) == chosen


def test_a_folder_that_others_may_write_to_is_not_trusted(writable):
    folders = writable("temporary")
    chosen = Path(choose_kernel_cache(folders["root"]))
    chosen.chmod(0o777)
    del os.environ[VARIABLE]
    another = Path(choose_kernel_cache(folders["root"]))
    assert another != chosen
    assert another.parent == folders["temporary"]


def test_the_environment_of_the_user_wins(writable, monkeypatch):
    folders = writable("temporary")
    monkeypatch.setenv(VARIABLE, "/somewhere")
    assert choose_kernel_cache(folders["root"]) == "/somewhere"


def test_the_folder_is_chosen_before_the_first_kernel(tmp_path):
    lines = (
        "import os, hsr8.kernel_cache as k, sys",
        "assert 'numba' not in sys.modules",
        "print(os.environ.get(k.VARIABLE, ''))",
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT), VARIABLE: str(tmp_path)}
    probe = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)], env=environment, capture_output=True, check=True
    )
    assert probe.stdout.decode().strip() == str(tmp_path)
