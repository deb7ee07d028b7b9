"""The notebook runs from top to bottom."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))


def cells(path, kind):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    return ["".join(c["source"]) for c in notebook["cells"] if c["cell_type"] == kind]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_cells_run_from_top_to_bottom(path, tmp_path):
    figures = """
import matplotlib.pyplot as plt
plt.show = lambda: print("figure", len(plt.gcf().axes))
"""
    (tmp_path / "cells.py").write_text("import hsr8" + figures + "\n".join(cells(path, "code")))
    environment = os.environ | {"PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}
    done = subprocess.run(
        [sys.executable, "cells.py"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("figure") == 2
    assert len(list(tmp_path.glob("runs/quick/*/manifest.json"))) == 3
