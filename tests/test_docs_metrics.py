"""Every result of a run is registered and explained, and nothing else is."""

import re
from pathlib import Path

import hsr8
from hsr8.evaluation.registry import SECTIONS

PAGE = Path(__file__).parents[1] / "docs" / "metrics.md"


def test_every_result_is_explained():
    rows = re.findall(r"^\| (`.+?) \|", PAGE.read_text(encoding="utf-8"), re.M)
    explained = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    metrics = hsr8.run("quick", settings={"camera.source": "analytic", "duration": 0.1}).metrics
    registered = [metric.name for section in SECTIONS.values() for metric in section]
    assert sorted(explained) == sorted(registered) == sorted(metrics)
