from hsr8.scenario.reference import json_schema


def test_every_key_is_explained_and_every_quantity_has_a_unit():
    schema = json_schema()
    for table in (schema, *(d for d in schema["$defs"].values() if "properties" in d)):
        for name, node in table["properties"].items():
            text = node.get("description", "")
            assert text or "$ref" in node or name in ("kind", "motion"), (table["title"], name)
            numeric = node.get("items", node).get("type") in ("number", "integer")
            assert not numeric or text.rstrip(".").endswith("]"), (table["title"], name, text)
