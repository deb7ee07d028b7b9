"""What every test may rely on: a drawing backend without a display, and repeatable examples."""

import gc
import os

import pytest
from hypothesis import settings

from hsr8.errors import RenderingUnavailable
from hsr8.process.gl import choose_backend, require_gl

choose_backend()  # before any test imports MuJoCo
gc.set_threshold(50_000)  # the default takes a tenth of the time of the suite

# The same examples on every machine and in every run: a failure is never a matter of luck.
settings.register_profile(
    "repeatable", derandomize=True, deadline=None, database=None, max_examples=50
)
settings.load_profile("repeatable")


LONG = {"test_live", "test_uncompiled", "test_determinism", "test_cache", "test_pools"}
"""Files of few tests that take long."""


def pytest_configure(config: pytest.Config) -> None:
    config.option.loadscopereorder = False  # of xdist, which leaves files of few tests to the end


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the long files, so that no test process waits for another one at the end."""
    items.sort(key=lambda item: item.path.stem not in LONG)


os.fsync = lambda _: None  # on a busy disk it takes longer than the run whose folder it protects


@pytest.fixture(autouse=True)
def need_gl(request: pytest.FixtureRequest) -> None:
    """Skip tests marked ``gl`` where nothing can be drawn; in CI let them fail."""
    if request.node.get_closest_marker("gl") is None:
        return
    try:
        require_gl()
    except RenderingUnavailable as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error).splitlines()[0])
