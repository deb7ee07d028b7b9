"""The constants that docs/planning.md states are those of the code."""

import re
from dataclasses import fields
from operator import attrgetter
from pathlib import Path

import pytest

from navigation.parameters.navigation import NavigationParameters

TEXT = (Path(__file__).parents[1] / "docs" / "planning.md").read_text(encoding="utf-8")
CONSTANTS = re.findall(r"^\| .+ \| `(\w+\.\w+)` \| (-?[\d.]+)[^|]* \|$", TEXT, re.M)


def test_the_table_has_all_constants_of_the_default_method():
    """An empty table would skip the comparison below."""
    parameters = NavigationParameters()
    for section in ("univector", "safety_filter"):
        keys = {f"{section}.{f.name}" for f in fields(attrgetter(section)(parameters))}
        assert keys - {key for key, _ in CONSTANTS} <= {"safety_filter.enabled"}


@pytest.mark.parametrize(("key", "stated"), CONSTANTS)
def test_the_table_has_the_value_of_the_code(key, stated):
    assert attrgetter(key)(NavigationParameters()) == pytest.approx(float(stated))
