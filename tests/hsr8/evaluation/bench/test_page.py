import re

import pytest

from hsr8.errors import UsageError
from hsr8.evaluation.bench.page import entries_table, entry_page


def row_of(name, lines):
    """Cells of the line of a table that begins with `name`."""
    (line,) = [line for line in lines if line.startswith(f"| {name} ")]
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip("| "))]


def test_the_page_of_an_entry_has_a_line_per_family(make_entry):
    lines = entry_page(make_entry(course=("success", "timeout"))).splitlines()
    cells = row_of("course", lines)
    assert cells[:3] == ["course", "2", "50.0 %"]
    assert cells[4:] == ["0.0", "50.0", "0.0", "0.400", "0.375", "0.200", "0.50", "80.0"]
    assert row_of("all", lines)[1] == "6"
    assert "All settings are those of the standard." in lines
    assert "    hsr8 bench --quick --name default" in lines


def test_settings_of_an_entry_are_listed_and_its_conditions_are_named(make_entry):
    settings = {"robot.body": ('"kinematic"', '"full"'), "navigation.planner.method": ("1", "2")}
    settings["sensors.encoder"] = ("0.002", "0.0")
    entry = make_entry("mine", settings=settings)
    assert '| `robot.body` | "kinematic" | "full" |' in entry_page(entry)
    lines = entries_table([make_entry(), entry])
    assert row_of("mine (robot.body=full, sensors.encoder=0.0)", lines)[1] == "100.0 %"


def test_the_table_compares_all_entries_with_the_first(make_entry):
    lines = entries_table([make_entry(), make_entry("a|b", course=("collision",) * 4)])
    first, other = row_of("default", lines[:8]), row_of("a\\|b", lines[:8])
    assert first[3:6] == ["", "4 of 4", "4 of 4"]
    assert [cell for cell in other if cell.startswith("-50.0 [")]
    assert "0 of 4" in other
    assert any("`hsr8 bench --quick --name default`" in line for line in lines)


@pytest.mark.parametrize(
    ("change", "message"),
    [({"seeds": "full"}, "other seeds, got full; expected quick"), ({"suite_version": 2}, "got 2")],
)
def test_entries_that_are_not_comparable_have_no_table(make_entry, change, message):
    with pytest.raises(UsageError, match=message):
        entries_table([make_entry(), make_entry("b", **change)])
