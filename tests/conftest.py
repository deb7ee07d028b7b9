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
