"""Mistakes in a scenario: key, wrong value and allowed values."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from hsr8.errors import escaped
from hsr8.scenario.key_lines import Path, holds
from hsr8.scenario.reference import allowed, keys_at, node_at
from hsr8.suggestion import suggestion

_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
_WORDS = {"Input should be": "must be", "valid array": "list", "an object": "a table"}
_MAX_SHOWN = 60  # characters of a wrong value


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake.

    Attributes:
        path: of the key.
        text: mistake, and allowed values.
    """

    path: Path
    text: str


def dotted(path: Path) -> str:
    """Return a key as written in messages: with dots, and indices in brackets."""
    parts = "".join(f"[{part}]" if isinstance(part, int) else f".{_short(part)}" for part in path)
    return parts.lstrip(".") or "scenario"


def problems_of(error: ValidationError, data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the mistakes that pydantic found in `data`."""
    for details in error.errors(include_url=False):
        yield _problem(details, data)


def shown(value: Any) -> str:
    """Return a value as TOML would show it, shortened for a message."""
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return _short(text.lower() if isinstance(value, bool) else text)


def _short(text: str) -> str:
    return escaped(text if len(text) <= _MAX_SHOWN else f"{text[: _MAX_SHOWN - 3]}...")


def _problem(details: ErrorDetails, data: Mapping[str, Any]) -> Problem:
    path, kind, value = _plain_path(details["loc"], data), details["type"], details["input"]
    context, node = details.get("ctx", {}), node_at(path, data) or {}
    text = str(node.get("description", "")).split("\n")[0].rstrip(".")
    meaning = f" — {text}" if text else ""
    if kind in _UNKNOWN:
        return Problem(path, _unknown(path, data))
    if kind == "missing":
        return Problem(path, f"is missing{meaning}")
    if kind == "string_pattern_mismatch":
        return Problem(path, f"has a wrong form, got {shown(value)}{meaning}")
    if kind == "value_error":
        return Problem(path, f"{context['error']}, got {shown(value)}{meaning}")
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        path = (*path, context["discriminator"].strip("'"))
        choices = list(node["discriminator"]["mapping"])
        if kind == "union_tag_not_found":
            return Problem(path, f"is missing; expected one of {_listed(choices)}")
        value = context["tag"]
    elif kind == "literal_error":
        choices = [str(choice) for choice in node.get("enum", [context["expected"].strip("'")])]
    else:
        text = details["msg"].replace("should", "must")
        for old, new in _WORDS.items():
            text = text.replace(old.replace("should", "must"), new)
        limits = allowed(node)
        wanted = f" (allowed: {limits})" if limits else ""
        return Problem(path, f"{text[:1].lower()}{text[1:]}, got {shown(value)}{wanted}{meaning}")
    hint = suggestion(str(value), choices)
    return Problem(path, f"must be one of {_listed(choices)}, got {shown(value)}{hint}{meaning}")


def _listed(choices: Sequence[str]) -> str:
    return ", ".join(f'"{choice}"' for choice in choices)


def _unknown(path: Path, data: Mapping[str, Any]) -> str:
    """Text about an unknown key: a similar key here, or the same key in another table."""
    key, known = str(path[-1]), keys_at(path[:-1], data)
    elsewhere = ".".join(_elsewhere(key, data))
    hint = suggestion(key, known) or (f"; did you mean '{elsewhere}'?" if elsewhere else "")
    return f"unknown key{hint} (allowed: {', '.join(known)})"


def _elsewhere(key: str, data: Any) -> Sequence[str]:
    """Uppermost path of a key with this name; empty without one."""
    paths: list[tuple[str, ...]] = [()]
    for path in paths:  # grows during the search
        keys = keys_at(path, data)
        if path and key in keys:
            return (*path, key)
        paths += [(*path, k) for k in keys]
    return ()


def _plain_path(location: Sequence[str | int], data: Any) -> Path:
    """`location` without the names of the alternatives that pydantic puts between keys."""
    path: list[str | int] = []
    for k, part in enumerate(location):
        if holds(data, part):
            data = data[part]
        elif k < len(location) - 1:
            continue
        path.append(part)
    return tuple(path)
