"""Every result of a run is explained, and nothing else is."""

import re
from pathlib import Path

import hsr8

PAGE = Path(__file__).parents[1] / "docs" / "metrics.md"


def test_every_result_is_explained():
    rows = re.findall(r"^\| (`.+?) \|", PAGE.read_text(encoding="utf-8"), re.M)
    explained = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    metrics = hsr8.run("quick", settings={"camera.source": "analytic", "duration": 0.1}).metrics
    assert sorted(explained) == sorted(metrics)
