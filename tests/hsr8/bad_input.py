"""Random bad input: values of scenarios, and damaged files."""

import random
from typing import Any

from hsr8.scenario.reference import json_schema, resolve

TOKENS: tuple[str, ...] = (
    "",
    "[",
    "]",
    "[[",
    "{",
    "}",
    '"',
    "'''",
    "=",
    ".",
    ",",
    "\n",
    "nan",
    "inf",
    "-",
    "1e999",
)
TOKENS += ("0x7fffffffffffffff", "1979-05-27T07:32:00Z", "\x00", "\ud7ff", "é", "9" * 400, "true")


def value(rng: random.Random, depth: int = 0) -> Any:
    """Return a random TOML value."""
    kind = rng.randrange(9 if depth < 3 else 7)
    if kind == 7:
        return [value(rng, depth + 1) for _ in range(rng.randrange(4))]
    if kind == 8:
        return {rng.choice("abkxyz"): value(rng, depth + 1) for _ in range(rng.randrange(3))}
    return (
        rng.randrange(-5, 70),
        rng.uniform(-10.0, 10.0),
        10.0 ** rng.uniform(-300.0, 300.0) * rng.choice((-1, 1)),
        rng.choice((0, -1, 2**31, 2**63 - 1, -(2**63), 10**30)),
        rng.choice((float("nan"), float("inf"), -float("inf"), -0.0, 5e-324, 1e308)),
        rng.choice(("", "rendered", "course", "../x", "/etc/passwd", "a" * 3000, "\x00", "\ud7ff")),
        rng.random() < 0.5,
    )[kind]


def near(rng: random.Random, node: dict[str, Any]) -> Any:
    """Return a value near the limits of a key, or any value."""
    if rng.random() < 0.1:
        return value(rng)
    if "$ref" in node:
        return near(rng, resolve(node, None))
    for several in ("anyOf", "oneOf", "allOf"):
        if several in node:
            return near(rng, rng.choice(node[several]))
    if "enum" in node or "const" in node:
        return rng.choice([*node.get("enum", [node.get("const")]), "egll"])
    kind = node.get("type")
    if kind == "object":
        keys = list(node.get("properties", {}))
        chosen = set(rng.sample(keys, min(len(keys), rng.randrange(4)))) | set(
            node.get("required", ()) if rng.random() < 0.9 else ()
        )
        return {key: near(rng, node["properties"][key]) for key in sorted(chosen)}
    if kind == "array":
        items = node.get("prefixItems") or [node.get("items", {})] * rng.randrange(5)
        return [near(rng, item) for item in items]
    if kind in ("number", "integer"):
        low = node.get("minimum", node.get("exclusiveMinimum", -1e6))
        high = node.get("maximum", node.get("exclusiveMaximum", 1e6))
        edges = (low, high, low - 1, high + 1, low + 1e-9, 0.5 * (low + high))
        inner = low + (high - low) * 10.0 ** rng.uniform(-12.0, 0.0)
        number = rng.choice((*edges, rng.uniform(low, high), inner))
        if kind == "integer":
            step = node.get("multipleOf", 1)
            return round(number / step) * step
        return float(number)
    if kind == "boolean":
        return rng.random() < 0.5
    if kind == "string":
        return rng.choice(("", "a", "x.npz", "/etc/passwd", "../../x", "course", "\n", "ü" * 70))
    return value(rng)


def keys() -> list[tuple[str, dict[str, Any]]]:
    """Return every key of a scenario, dotted, and its schema."""
    nodes: list[tuple[str, dict[str, Any]]] = []

    def descend(prefix: str, node: dict[str, Any]) -> None:
        if "$ref" in node:
            node = {**resolve(node, None), "default": None}
        for key, inner in node.get("properties", {}).items():
            nodes.append((f"{prefix}{key}", inner))
            descend(f"{prefix}{key}.", inner)

    descend("", json_schema())
    return nodes


def mutated(rng: random.Random, raw: bytes) -> bytes:
    """Return `raw` with some bytes changed, repeated or removed."""
    content = bytearray(raw)
    for _ in range(rng.randrange(1, 4)):
        start, length = rng.randrange(len(content) + 1), rng.choice((1, 1, 4, 8, 64))
        kind = rng.randrange(6)
        if kind == 0:
            content[start : start + length] = rng.randbytes(length)
        elif kind == 1:
            del content[start : start + length]
        elif kind == 2:
            content[start:start] = content[start : start + length]
        elif kind == 3:
            del content[start:]
        elif kind == 4:
            content[start:start] = rng.choice(TOKENS).encode()
        else:
            content[start : start + 8] = rng.choice((b"\xff" * 8, b"\0" * 8, b"\x7f" * 8))
    return bytes(content)


def written(given: Any) -> str:
    """Return a value as TOML, also if it is not valid TOML."""
    if isinstance(given, bool):
        return str(given).lower()
    if isinstance(given, list):
        return f"[{', '.join(map(written, given))}]"
    if isinstance(given, dict):
        return "{" + ", ".join(f"{key} = {written(inner)}" for key, inner in given.items()) + "}"
    return repr(given) if not isinstance(given, str) else f'"{given}"'
