import gc

import pytest

from hsr8.cli.loading import loading


@pytest.fixture(autouse=True)
def _as_before():
    yield
    gc.unfreeze()
    gc.enable()


def test_what_is_loaded_is_never_looked_through():
    before = gc.get_freeze_count()
    with loading():
        assert not gc.isenabled()
        kept = [[number] for number in range(1000)]
    assert gc.get_freeze_count() - before > len(kept)
    assert gc.isenabled()


def test_the_collector_goes_on_after_a_failed_import():
    with pytest.raises(ImportError), loading():
        raise ImportError
    assert gc.isenabled()
