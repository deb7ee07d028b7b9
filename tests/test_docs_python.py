"""Every Python example in the documentation runs as it is printed."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
EXAMPLES = [
    pytest.param(code, id=f"{page.name}-{k}")
    for page in (DOCS / f"{name}.md" for name in ("python", "gym", "data", "crowds"))
    for k, code in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(), re.S))
    if not re.search(r"^(?:import|from) (?:pandas|duckdb|evo)", code, re.M)
]


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_example_runs(code, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "example", "exec"), {"__name__": "example"})
    printed = capsys.readouterr().out
    assert printed.strip()
    assert "False" not in printed.replace("False timeout", "")
