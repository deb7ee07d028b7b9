"""What every test may rely on: a drawing backend without a display, and repeatable examples."""

import os
import subprocess
import sys

os.environ.setdefault("MUJOCO_GL", "egl")  # read when mujoco is first imported

import pytest
from hypothesis import settings

# The same examples on every machine and in every run: a failure is never a matter of luck.
settings.register_profile("repeatable", derandomize=True, deadline=None, database=None)
settings.load_profile("repeatable")

PROBE = "import mujoco; context = mujoco.GLContext(16, 16); context.make_current(); context.free()"


@pytest.fixture(scope="session")
def gl_error() -> str:
    """Why nothing can be drawn here, or an empty string; a process of its own finds out."""
    probe = subprocess.run(
        [sys.executable, "-c", PROBE], capture_output=True, text=True, timeout=60, check=False
    )
    return "" if probe.returncode == 0 else probe.stderr.strip().splitlines()[-1]


@pytest.fixture(autouse=True)
def need_gl(request: pytest.FixtureRequest) -> None:
    """Skip tests marked ``gl`` where nothing can be drawn, and fail them in CI."""
    if request.node.get_closest_marker("gl") is None:
        return
    error = request.getfixturevalue("gl_error")
    if error and os.environ.get("CI"):
        pytest.fail(f"no OpenGL on the CI machine: {error}")
    if error:
        pytest.skip(f"no OpenGL ({error}); on Debian: apt-get install libegl1 libgl1")
