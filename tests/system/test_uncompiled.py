"""Runs in other modes of the interpreter: uncompiled, and without docstrings."""

import os
import subprocess
import sys

import numpy as np
import pytest

import hsr8
from hsr8.recording.difference import CLOCKED_COLUMNS
from hsr8.recording.rows import TABLES

DURATION = 1.5  # with the first footstep [s]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    settings = {"robot.body": "kinematic", "camera.source": "analytic", "duration": DURATION}
    return hsr8.run("quick", settings=settings, out=tmp_path_factory.mktemp("compiled"))


def recorded(folder, *options, **environment):
    """Return a run of a new process."""
    words = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--quiet"]
    words += ["--duration", str(DURATION), "--out", str(folder)]
    done = subprocess.run(
        [sys.executable, *options, "-m", "hsr8", *words],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    assert done.returncode == 1, done.stderr  # no goal in so short a time
    return hsr8.open_run(folder)


def numbers(run):
    """Yield name and values of every column of numbers."""
    for name in TABLES:
        table = getattr(run, name)
        for column in table.keys() - set(CLOCKED_COLUMNS):
            values = table[column]
            if isinstance(values, np.ndarray) and values.dtype.kind in "fiub":
                yield f"{name}.{column}", values


@pytest.mark.parametrize(
    ("options", "environment"), [((), {"NUMBA_DISABLE_JIT": "1"}), (("-OO",), {})]
)
def test_the_run_is_the_same(compiled, tmp_path, options, environment):
    run = recorded(tmp_path, *options, **environment)
    expected, columns = dict(numbers(compiled)), dict(numbers(run))
    assert columns.keys() == expected.keys()
    assert len(columns) > 50
    for name, values in columns.items():
        np.testing.assert_allclose(values, expected[name], rtol=1e-9, atol=1e-9, err_msg=name)
    assert run.ticks["tick"].size == round(DURATION / 0.005) + 1
    assert run.unit("records.zmp") == "m"
