"""Text of the mistakes that pydantic finds in a robot description: key, value, expected."""

import re
from collections.abc import Iterator
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from hsr8.keys import texts
from hsr8.suggestion import suggestion

NAME, NAMES, TABLE = "a name", "a list of two names", "a table"
"""Forms of the keys that have several; pydantic puts them into the path of a mistake."""
EXPECTED = {
    "string_type": "a text in quotes",
    "string_too_short": "at least one character",
    "string_too_long": "at most {max_length} characters",
    "string_pattern_mismatch": "lower-case letters, digits and underscores",
    "float_type": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "tuple_type": "a list",
    "too_long": "{max_length} elements",
    "dict_type": TABLE,
    "model_type": TABLE,
    "literal_error": "{expected}",
    "greater_than": "more than {gt:g}{unit}",
    "greater_than_equal": "at least {ge:g}{unit}",
    "less_than": "less than {lt:g}{unit}",
    "less_than_equal": "at most {le:g}{unit}",
}
MAX_SHOWN = 60  # characters of a wrong value

KeyPath = tuple[int | str, ...]


def mistakes_of(error: ValidationError, kind: type[BaseModel]) -> list[str]:
    """Return one line per mistake: ``KEY: what is wrong, got VALUE; expected ...``.

    Args:
        error: from the validation of a table.
        kind: of the table.
    """
    return [_mistake(details, kind) for details in error.errors(include_url=False)]


def _mistake(details: ErrorDetails, kind: type[BaseModel]) -> str:
    path: KeyPath = tuple(part for part in details["loc"] if part not in (NAME, NAMES, TABLE))
    context, what = details.get("ctx", {}), details["type"]
    got = f"got {_short(details['input'])}"
    key = ".".join(map(str, path))
    if what == "value_error":
        return f"{key}: {context['error']}" if key else str(context["error"])
    if what == "extra_forbidden":
        return f"{key}: unknown key{_hint(path, kind)}"
    if what == "missing" and isinstance(path[-1], str):
        return f"{key}: missing; expected a value: {_meaning(path, kind)}"
    if what == "missing":
        return f"{'.'.join(map(str, path[:-1]))}: too short, {got}; expected more elements"
    if what == "json_invalid":
        return "too many tables within each other; expected those of docs/robots.md"
    if what == "union_tag_invalid":
        forms = re.findall(r"'([^']*)'", context["expected_tags"])
        return f"{key}: wrong type, {got}; expected {' or '.join(forms)}"
    unit = re.search(r"\[([^\]]+)\]\.?$", _meaning(path, kind))
    expected = EXPECTED[what].format(**context, unit=f" {unit[1]}" if unit else "")
    return f"{key}: wrong value, {got}; expected {expected}{_misplaced(path, kind)}"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= MAX_SHOWN else f"{text[: MAX_SHOWN - 3]}..."


def _hint(path: KeyPath, kind: type[BaseModel]) -> str:
    """Return the hint for an unknown key: where it belongs, or a similar key."""
    table = _table(path[:-1], kind)
    assert table is not None  # a table with names as keys has no unknown ones
    return _misplaced(path, kind) or suggestion(str(path[-1]), list(table.model_fields))


def _misplaced(path: KeyPath, kind: type[BaseModel]) -> str:
    """Return the remedy for a key of the description that is within a table."""
    if len(path) > 1 and path[-1] in kind.model_fields:
        return f"; {path[-1]!r} is a key of the description: move it above the first [table]"
    return ""


def _meaning(path: KeyPath, kind: type[BaseModel]) -> str:
    """Return the text of the innermost key that has one."""
    for depth in range(len(path), 0, -1):
        table = _table(path[: depth - 1], kind)
        if table is not None and path[depth - 1] in table.model_fields:
            return texts(table)[str(path[depth - 1])].rstrip(".")
    return ""


def _table(path: KeyPath, kind: type[BaseModel]) -> type[BaseModel] | None:
    """Return the kind of the table at a path, None where keys are names."""
    for part in path:
        field = kind.model_fields.get(str(part))
        kinds = [] if field is None else list(_kinds(field.annotation))
        if not kinds:
            return None
        kind = kinds[0]
    return kind


def _kinds(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the tables in the annotation of a field."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from _kinds(part)
