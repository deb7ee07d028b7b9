"""A run with uncompiled kernels, as used for debugging."""

import json
import os
import subprocess
import sys


def test_a_run_whose_kernels_are_not_compiled_comes_to_its_end(tmp_path):
    words = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "0.3"]
    done = subprocess.run(
        [sys.executable, "-m", "hsr8", *words, "--no-log", "--json", "--out", str(tmp_path)],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    assert done.returncode == 1, done.stderr  # no goal in so short a time
    assert json.loads(done.stdout)["walk_ticks"] == 61
