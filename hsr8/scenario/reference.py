"""What may stand where in a scenario file, read off the schema itself."""

from collections.abc import Iterator
from dataclasses import is_dataclass
from functools import cache
from typing import Any, get_args, get_type_hints

from hsr8.docstrings import docstrings
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section
from hsr8.scenario.toml_lines import Path, holds

Node = dict[str, Any]

_BOUNDS = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}


@cache
def json_schema() -> Node:
    """JSON Schema of a scenario file, for editors and for this module."""
    schema = Scenario.model_json_schema()
    schema["required"].remove("name")
    nodes = {"Scenario": schema, **schema["$defs"]}
    for section in set(_sections_in(Scenario)):
        properties = nodes[section.__name__]["properties"]
        for key, text in docstrings(section).items():
            properties[key]["description"] = text
    schema["properties"]["extends"] = {
        "type": "string",
        "description": "Scenario to start from: a built-in name or a file beside this one.",
    }
    return schema


def _sections_in(annotation: Any) -> Iterator[type]:
    """Sections that `annotation` names, and those within these."""
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


def node_at(path: Path, data: Any) -> Node | None:
    """Schema of what stands at `path` in `data`; None where nothing may stand."""
    node: Node | None = _resolve(json_schema(), data)
    for part in path:
        data = data[part] if holds(data, part) else None
        if node is None:
            return None
        if isinstance(part, int):
            items = node.get("prefixItems", [])
            node = items[part] if part < len(items) else node.get("items")
        else:
            node = node.get("properties", {}).get(part)
        node = None if node is None else _resolve(node, data)
    return node


def keys_at(path: Path, data: Any) -> list[str]:
    """Keys that the table at `path` may have."""
    node = node_at(path, data)
    return [] if node is None else list(node.get("properties", {}))


def allowed(node: Node) -> str:
    """What `node` accepts, in words; empty when its type says it all."""
    if "enum" in node:
        return ", ".join(f'"{choice}"' for choice in node["enum"])
    if "const" in node:
        return f'"{node["const"]}"'
    bounds = [f"{sign} {node[key]:g}" for key, sign in _BOUNDS.items() if key in node]
    if "multipleOf" in node:
        bounds.append(f"a multiple of {node['multipleOf']}")
    if "prefixItems" in node:
        inner = {allowed(_resolve(item, None)) for item in node["prefixItems"]} - {""}
        return f"{len(node['prefixItems'])} values" + "".join(f", each {i}" for i in sorted(inner))
    if each := allowed(_resolve(node["items"], None)) if "items" in node else "":
        return f"{node['minItems']} to {node['maxItems']} values, each {each}"
    return " and ".join(bounds)


def markdown() -> str:
    """Reference of every key, one table per section."""
    lines = [
        "# Scenario files",
        "",
        "A scenario is a TOML file. Every key has a default, except those marked *required*.",
        'A file may start from another one: `extends = "course"`. `hsr8 check FILE` reads it and',
        "tells of its world, `--picture PNG` draws it; `--set camera.period_ms=80` changes one key",
        "for one run. What costs time or memory without end, or stops the robot, is bounded more",
        "narrowly than *allowed* says: `hsr8 check` tells.",
        "This page is written by the program from its own schema:",
        "",
        "    python scripts/write_scenario_reference.py",
    ]
    for title, node in _sections():
        lines += ["", f"## {title}", "", node.get("description", "").split("\n\n")[0], ""]
        lines += ["| key | default | allowed | meaning |", "|---|---|---|---|"]
        required = node.get("required", [])
        for key, given in node["properties"].items():
            lines.append(_row(key, given, key in required))
    return "\n".join(lines) + "\n"


def _row(key: str, given: Node, required: bool) -> str:
    node = _resolve(given, None)
    default = given.get("default", node.get("default"))
    if "properties" in node or "discriminator" in node or "discriminator" in node.get("items", {}):
        shown = "*required*" if required else "see below"
    elif required:
        shown = "*required*"
    else:
        shown = "" if default is None else f"`{_toml(default)}`"
    meaning = str(given.get("description") or node.get("description", "")).replace("\n", " ")
    return f"| `{key}` | {shown} | {allowed(node)} | {meaning} |"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _sections() -> Iterator[tuple[str, Node]]:
    """Every table with its title, outer tables first."""
    root = json_schema()
    yield "Top level", root
    todo: list[tuple[tuple[str, ...], Node]] = [
        ((name,), node) for name, node in root["properties"].items()
    ]
    while todo:
        path, given = todo.pop(0)
        for title, node in _variants(path, given):
            if "properties" not in node:
                continue
            yield title, node
            inner = [((*path, name), value) for name, value in node["properties"].items()]
            todo = inner + todo


def _variants(path: tuple[str, ...], given: Node, many: bool = False) -> Iterator[tuple[str, Node]]:
    node = _resolve(given, None)
    if node.get("type") == "array" and "items" in node:
        yield from _variants(path, node["items"], many=True)
        return
    name = ".".join(path)
    header = f"`[[{name}]]`" if many else f"`[{name}]`"
    if "discriminator" not in node:
        yield header, node
        return
    key = node["discriminator"]["propertyName"]
    for tag, reference in node["discriminator"]["mapping"].items():
        yield f'{header} with `{key} = "{tag}"`', _resolve({"$ref": reference}, None)


def _resolve(node: Node, data: Any) -> Node:
    """`node` without references; of alternatives, the one that `data` chooses."""
    if "$ref" in node:
        found = json_schema_definition(node["$ref"])
        return _resolve(found, data)
    if "discriminator" in node and isinstance(data, dict):
        chosen = data.get(node["discriminator"]["propertyName"])
        mapping = node["discriminator"]["mapping"]
        if isinstance(chosen, str) and chosen in mapping:
            return _resolve({"$ref": mapping[chosen]}, data)
    if "anyOf" in node:
        real = [n for n in node["anyOf"] if n.get("type") != "null"]
        if len(real) == 1:
            return _resolve(real[0], data)
    return node


def json_schema_definition(reference: str) -> Node:
    """What a reference inside the schema points to."""
    node: Node = json_schema()
    for part in reference.removeprefix("#/").split("/"):
        node = node[part]
    return node
