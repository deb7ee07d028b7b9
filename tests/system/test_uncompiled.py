"""Runs in other modes of the interpreter: with uncompiled kernels, and without docstrings."""

import json
import os
import subprocess
import sys

import pytest

import hsr8


@pytest.mark.parametrize(
    ("options", "environment"), [((), {"NUMBA_DISABLE_JIT": "1"}), (("-OO",), {})]
)
def test_a_run_is_the_same_uncompiled_and_without_docstrings(tmp_path, options, environment):
    words = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "0.3"]
    words += ["--no-log", "--json", "--out", str(tmp_path)]
    done = subprocess.run(
        [sys.executable, *options, "-m", "hsr8", *words],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    assert done.returncode == 1, done.stderr  # no goal in so short a time
    assert json.loads(done.stdout)["walk_ticks"] == 61
    assert hsr8.open_run(tmp_path).unit("records.zmp") == "m"
