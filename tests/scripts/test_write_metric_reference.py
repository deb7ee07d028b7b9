import re

from write_metric_reference import PAGE, page

import hsr8
from hsr8.measure.registry import SECTIONS


def test_the_page_is_fresh():
    """If this fails: python scripts/write_metric_reference.py."""
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_result_of_a_run_is_registered_and_explained():
    explained = re.findall(r"^\| `(.+?)` \|", page(), re.M)
    metrics = hsr8.run("quick", settings={"camera.source": "analytic", "duration": 0.1}).metrics
    registered = [metric.name for section in SECTIONS.values() for metric in section]
    assert sorted(explained) == sorted(registered) == sorted(metrics)
