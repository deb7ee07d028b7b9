"""A run in another mode of the interpreter: uncompiled, without docstrings and assertions."""

import os
import subprocess
import sys

import numpy as np
import pytest

import hsr8
from hsr8.recording.difference import CLOCKED_COLUMNS
from hsr8.recording.rows import TABLES

DURATION = 1.2  # with the first footstep [s]
PERIOD = 150  # of few frames, whose decisions take most of the time [ms]


def numbers(run):
    """Yield name and values of every column of numbers."""
    for name in TABLES:
        table = getattr(run, name)
        for column in table.keys() - set(CLOCKED_COLUMNS):
            values = table[column]
            if isinstance(values, np.ndarray) and values.dtype.kind in "fiub":
                yield f"{name}.{column}", values


@pytest.mark.timeout(600)
def test_the_run_is_that_of_compiled_code(tmp_path):
    settings = {"robot.body": "kinematic", "camera.source": "analytic", "duration": DURATION}
    compiled = hsr8.run("quick", settings=settings | {"camera.period_ms": PERIOD})
    words = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--quiet"]
    words += ["--duration", str(DURATION), "--out", str(tmp_path)]
    words += ["--set", f"camera.period_ms={PERIOD}"]
    done = subprocess.run(
        [sys.executable, "-OO", "-m", "hsr8", *words],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1, done.stderr  # no goal in so short a time
    run = hsr8.open_run(tmp_path)
    expected, columns = dict(numbers(compiled)), dict(numbers(run))
    assert columns.keys() == expected.keys()
    assert len(columns) > 50
    for name, values in columns.items():
        np.testing.assert_allclose(values, expected[name], rtol=1e-9, atol=1e-9, err_msg=name)
    assert run.ticks["tick"].size == round(DURATION / 0.005) + 1
    assert run.unit("records.zmp") == "m"
    assert expected["records.step_count"][-1] > 0
