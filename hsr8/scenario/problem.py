"""What is wrong with a scenario, told with its place and with what would be right."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from hsr8.scenario.reference import allowed, keys_at, node_at
from hsr8.scenario.toml_lines import Path, holds
from hsr8.suggestion import suggestion

_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
_KINDS = {dict: "a table", list: "a list", str: "text", bool: "a truth value"}
_MOST = 60  # characters of a wrong value that are shown


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong.

    Attributes:
        path: of the key.
        text: what is wrong and what is allowed.
    """

    path: Path
    text: str

    def key(self) -> str:
        """The key as it is written with dots, indices in brackets."""
        name = ""
        for part in self.path:
            name += f"[{part}]" if isinstance(part, int) else f".{part}" if name else part
        return name or "scenario"


def problems_of(error: ValidationError, data: Mapping[str, Any]) -> list[Problem]:
    """Every mistake pydantic found in `data`."""
    return [_problem(details, data) for details in error.errors(include_url=False)]


def shown(value: Any) -> str:
    """A wrong value, short enough for a message."""
    text = f'"{value}"' if isinstance(value, str) else str(value)
    if isinstance(value, bool):
        text = text.lower()
    return text if len(text) <= _MOST else text[: _MOST - 3] + "..."


def _problem(details: ErrorDetails, data: Mapping[str, Any]) -> Problem:
    path = _plain_path(details["loc"], data)
    kind, given = details["type"], details["input"]
    context = details.get("ctx", {})
    node = node_at(path, data)
    meaning = "" if node is None else _meaning(node)
    if kind in _UNKNOWN:
        known = keys_at(path[:-1], data)
        elsewhere = ".".join(_elsewhere(str(path[-1]), data))
        meant = f"; did you mean '{elsewhere}'?" if elsewhere else ""
        hint = suggestion(str(path[-1]), known) or meant
        return Problem(path, f"unknown key{hint or ''} (known here: {', '.join(known)})")
    if kind == "missing":
        return Problem(path, f"is missing{meaning}")
    if kind == "value_error":
        return Problem(path, f"{context['error']}, got {shown(given)}{meaning}")
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        key = str(context["discriminator"]).strip("'")
        tags = _tags(path, data)
        choices = ", ".join(f'"{tag}"' for tag in tags)
        if kind == "union_tag_not_found":
            return Problem((*path, key), f"is missing; choose one of {choices}")
        tag = str(context["tag"])
        hint = suggestion(tag, tags)
        return Problem((*path, key), f"must be one of {choices}, got {shown(tag)}{hint}")
    if kind == "literal_error" and node is not None:
        hint = suggestion(str(given), [str(c) for c in node.get("enum", [])])
        return Problem(path, f"must be one of {allowed(node)}, got {shown(given)}{hint}{meaning}")
    text = (
        details["msg"]
        .replace("Input should be", "must be")
        .replace("valid array", "list")
        .replace("an object", "a table")
    )
    text = text.replace("should", "must")
    limits = "" if node is None else allowed(node)
    wanted = f" (allowed: {limits})" if limits else ""
    what = _KINDS.get(type(given), "")
    got = f", got {what + ' ' if what and kind.endswith('_type') else ''}{shown(given)}"
    return Problem(path, f"{text[:1].lower()}{text[1:]}{got}{wanted}{meaning}")


def _elsewhere(key: str, data: Any) -> Sequence[str]:
    """Where in a scenario a key of this name is, the uppermost one; empty if nowhere."""
    paths: list[tuple[str, ...]] = [()]
    for path in paths:  # grows while it is gone through
        keys = keys_at(path, data)
        if path and key in keys:
            return (*path, key)
        paths += [(*path, k) for k in keys]
    return ()


def _meaning(node: Mapping[str, Any]) -> str:
    text = str(node.get("description", "")).split("\n")[0].rstrip(".")
    return f" — {text}" if text else ""


def _tags(path: Path, data: Mapping[str, Any]) -> list[str]:
    node = node_at(path, data) or {}
    return list(node.get("discriminator", {}).get("mapping", {}))


def _plain_path(location: Sequence[str | int], data: Any) -> Path:
    """`location` without the names of the alternatives pydantic puts between keys."""
    path: list[str | int] = []
    for k, part in enumerate(location):
        if holds(data, part):
            data = data[part]
        elif k < len(location) - 1:
            continue
        path.append(part)
    return tuple(path)
