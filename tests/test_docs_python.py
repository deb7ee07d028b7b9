"""Every Python example of the documentation and the notebook run as they are printed.

Their runs are cut after two seconds.
"""

import json
import re
from pathlib import Path

import matplotlib as mpl
import pytest

import hsr8
from hsr8.scenario.loader import load_scenario

ROOT = Path(__file__).parents[1]
EXAMPLES = [
    pytest.param(code, id=f"{page.name}-{k}")
    for page in (ROOT / "docs" / f"{name}.md" for name in ("python", "gym", "data", "crowds"))
    for k, code in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(), re.S))
    if not re.search(r"^(?:import|from) (?:pandas|duckdb|evo)", code, re.M)
]


@pytest.fixture
def execute(tmp_path, monkeypatch, capsys):
    """Execute a program in an empty folder; return the text that it prints."""

    def short(*arguments, **options):
        scenario = load_scenario(*arguments, **options)
        return scenario.model_copy(update={"duration": min(2.0, scenario.duration)})

    monkeypatch.setattr(hsr8, "load_scenario", short)
    monkeypatch.setattr("hsr8.api.load_scenario", short)
    monkeypatch.chdir(tmp_path)

    def run(code):
        exec(compile(code, "example", "exec"), {"__name__": "example"})
        return capsys.readouterr().out

    return run


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_example_runs(code, execute):
    printed = execute(code)
    assert printed.strip()
    assert "False" not in printed.replace("False timeout", "")


@pytest.mark.parametrize("file", sorted((ROOT / "examples").glob("*.ipynb")), ids=lambda f: f.stem)
def test_the_cells_of_the_notebook_run_from_top_to_bottom(file, execute, tmp_path, monkeypatch):
    import matplotlib.pyplot as plt  # noqa: PLC0415  0.3 s

    figures = []
    mpl.use("agg")
    monkeypatch.setattr(plt, "show", lambda: figures.append(plt.gcf().axes))
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    execute("\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code"))
    plt.close("all")
    assert [len(axes) for axes in figures] == [1, 2]
    assert len(list(tmp_path.glob("runs/quick/*/manifest.json"))) == 3
