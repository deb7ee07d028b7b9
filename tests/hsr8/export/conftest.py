"""A short run that all exports share."""

import pytest

from hsr8.cli.main import entry
from hsr8.recording.run import open_run


@pytest.fixture(scope="package")
def run(tmp_path_factory):
    """A second of `quick` without images."""
    out = tmp_path_factory.mktemp("runs")
    options = ["--duration", "1", "--camera", "analytic", "--quiet"]
    entry(["run", "quick", "--out", str(out), *options])
    return open_run(out)


@pytest.fixture(scope="package")
def illustrated(tmp_path_factory):
    """Half a second of `quick` with images."""
    out = tmp_path_factory.mktemp("runs")
    options = ["--duration", "0.5", "--set", "camera.latency_ms=40", "--quiet"]
    entry(["run", "quick", "--out", str(out), *options])
    return open_run(out)
