from pathlib import Path

from hsr8.scenario.public_keys import BASIC, EXPERIMENTAL, PUBLIC
from hsr8.scenario.reference import json_schema, keys_at, node_at
from hsr8.scenario.reference_page import ReferencePage

FILE = Path(__file__).resolve().parents[3] / "docs" / "scenarios.md"


def test_the_page_is_fresh_and_has_every_public_key():
    """If this fails: python scripts/write_scenario_reference.py."""
    page = ReferencePage()
    assert FILE.read_text(encoding="utf-8") == page.text
    assert page.keys.keys() >= PUBLIC | BASIC | EXPERIMENTAL


def test_every_key_is_explained_and_every_quantity_has_a_unit():
    schema = json_schema()
    for table in (schema, *(d for d in schema["$defs"].values() if "properties" in d)):
        for name, node in table["properties"].items():
            text = node.get("description", "")
            assert text or "$ref" in node or name in ("kind", "motion"), (table["title"], name)
            numeric = node.get("items", node).get("type") in ("number", "integer")
            assert not numeric or text.rstrip(".").endswith("]"), (table["title"], name, text)


def test_alternatives_are_chosen_by_their_kind():
    data = {"mission": {"kind": "walk"}, "command": {"stretch": [{"duration": 1.0}]}}
    assert keys_at(("mission",), data) == ["kind"]
    node = node_at(("command", "stretch", 0, "duration"), data)
    assert node is not None
    assert node["description"].endswith("[s].")
    assert node_at(("mission", "points"), data) is None
    course = {"mission": {"kind": "course"}}
    assert keys_at(("mission",), course) == ["kind", "via_points", "leg", "goal_heading_deg"]
