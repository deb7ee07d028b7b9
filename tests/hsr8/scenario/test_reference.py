from pathlib import Path

from hsr8.scenario.reference import json_schema, keys_at, markdown, node_at

PAGE = Path(__file__).resolve().parents[3] / "docs" / "scenarios.md"


def test_the_page_is_fresh():
    """If this fails: python scripts/write_scenario_reference.py."""
    assert PAGE.read_text(encoding="utf-8") == markdown()


def tables(node, seen=()):
    """Every object of the schema that a file can write."""
    yield from (d for d in node["$defs"].values() if "properties" in d)
    yield node


def test_every_key_is_explained_and_every_measure_has_a_unit():
    for table in tables(json_schema()):
        for name, node in table["properties"].items():
            text = node.get("description", "")
            # A table that says the same as its key says it once.
            assert text or "$ref" in node, (table["title"], name)
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
