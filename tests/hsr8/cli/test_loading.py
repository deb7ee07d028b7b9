import gc
import sys
from types import ModuleType

import pytest

from hsr8.cli.loading import loading


@pytest.fixture(autouse=True)
def _as_before():
    yield
    gc.unfreeze()
    gc.enable()


def test_imported_objects_are_frozen(monkeypatch):
    before = gc.get_freeze_count()
    with loading():
        assert not gc.isenabled()
        kept = [[number] for number in range(1000)]
        monkeypatch.setitem(sys.modules, "loaded", ModuleType("loaded"))
    assert gc.get_freeze_count() - before > len(kept)
    assert gc.isenabled()


def test_nothing_is_frozen_without_an_import():
    gc.unfreeze()
    with loading():
        pass
    assert gc.get_freeze_count() == 0


def test_the_collector_is_enabled_after_a_failed_import():
    with pytest.raises(ImportError), loading():
        raise ImportError
    assert gc.isenabled()
