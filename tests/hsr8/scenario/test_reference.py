from hsr8.scenario.reference import json_schema, keys_at, node_at


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
