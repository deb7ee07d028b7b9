"""Public keys of a scenario file: JSON Schema, and the reference page made from it.

A parameter of walking, vision, belief or navigation is a public key if its annotation has a text,
see `hsr8.keys`; all others are for studies and documented in the code alone.
"""

from collections.abc import Iterator
from dataclasses import is_dataclass
from functools import cache
from typing import Any, get_args, get_type_hints

from hsr8.keys import texts
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section

Node = dict[str, Any]

LIBRARIES = ("walking", "vision", "belief", "navigation")
EXPERIMENTAL = "Experimental. "
"""Beginning of the text of a key that selects a variant under study."""

_BOUNDS = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
FILE_KEYS: Node = {  # of files alone, not of a scenario
    "extends": {
        "type": "string",
        "description": "Scenario to start from: a built-in name or a file in the same folder.",
    },
}


@cache
def public_keys() -> dict[str, str]:
    """Return the text of every public key of the libraries by its dotted name."""
    return {name: text for name, text in parameters().items() if text}


@cache
def parameters() -> dict[str, str]:
    """Return the text of every parameter of the libraries by its dotted name; most are empty."""
    libraries = ((Scenario.model_fields[name].annotation, name) for name in LIBRARIES)
    return {key: text for kind, name in libraries for key, text in _within(kind, name)}


def _within(kind: Any, name: str) -> Iterator[tuple[str, str]]:
    """Names and texts of the parameters in a class."""
    for key, hint in get_type_hints(kind).items():
        if is_dataclass(hint):
            yield from _within(hint, f"{name}.{key}")
        else:
            yield f"{name}.{key}", texts(kind).get(key, "")


@cache
def json_schema() -> Node:
    """JSON Schema of a scenario file, with the public keys only."""
    schema = Scenario.model_json_schema()
    schema["required"].remove("name")
    nodes = {"Scenario": schema, **schema["$defs"]}
    for section in set(_sections_in(Scenario)):
        properties = nodes[section.__name__]["properties"]
        for key, text in texts(section).items():
            properties[key]["description"] = text
    for name in LIBRARIES:
        _keep_public(schema["$defs"], schema["properties"][name], name)
    schema["properties"].update(FILE_KEYS)
    return schema


def _sections_in(annotation: Any) -> Iterator[type]:
    """Sections named by `annotation`, and those within them."""
    for part in get_args(annotation):
        yield from _sections_in(part)
    hints: list[Any] = []
    if isinstance(annotation, type) and issubclass(annotation, Section):
        hints = [field.annotation for field in annotation.model_fields.values()]
    elif isinstance(annotation, type) and is_dataclass(annotation):
        hints = list(get_type_hints(annotation).values())
    if hints:
        yield annotation
    for hint in hints:
        yield from _sections_in(hint)


def _keep_public(definitions: Node, node: Node, path: str) -> bool:
    """Remove the keys of a table that are not public, but stay allowed; return if any are left."""
    if "$ref" not in node:
        return path in public_keys()
    node.pop("default", None)
    name = node["$ref"].rpartition("/")[2]
    properties = definitions[name]["properties"]
    for key, inner in list(properties.items()):
        if not _keep_public(definitions, inner, f"{path}.{key}"):
            del properties[key]
            definitions[name]["additionalProperties"] = True
    if not properties:
        del definitions[name]
    return bool(properties)


def allowed(node: Node) -> str:
    """Return the allowed values in words; empty if the type suffices."""
    if "enum" in node:
        return ", ".join(f'"{choice}"' for choice in node["enum"])
    if "const" in node:
        return f'"{node["const"]}"'
    bounds = [f"{sign} {node[key]:g}" for key, sign in _BOUNDS.items() if key in node]
    if "multipleOf" in node:
        bounds.append(f"a multiple of {node['multipleOf']}")
    if "prefixItems" in node:
        inner = {allowed(resolve(item, None)) for item in node["prefixItems"]} - {""}
        return f"{len(node['prefixItems'])} values" + "".join(f", each {i}" for i in sorted(inner))
    if each := allowed(resolve(node["items"], None)) if "items" in node else "":
        return f"{node['minItems']} to {node['maxItems']} values, each {each}"
    return " and ".join(bounds)


def resolve(node: Node, data: Any) -> Node:
    """Return `node` without references; of alternatives, the one that `data` chooses."""
    if "$ref" in node:
        return resolve(json_schema()["$defs"][node["$ref"].rpartition("/")[2]], data)
    if "discriminator" in node and isinstance(data, dict):
        chosen = data.get(node["discriminator"]["propertyName"])
        mapping = node["discriminator"]["mapping"]
        if isinstance(chosen, str) and chosen in mapping:
            return resolve({"$ref": mapping[chosen]}, data)
    if "anyOf" in node:
        real = [n for n in node["anyOf"] if n.get("type") != "null"]
        if len(real) == 1:
            return resolve(real[0], data)
    return node
