"""Mistakes in configuration files: key, wrong value and expected value in one line each."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, get_args

from annotated_types import Ge, Gt, Le, Lt, MultipleOf
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from hsr8.errors import escaped
from hsr8.files.text import lines_of
from hsr8.keys import Path, annotation_at, choices, chosen, hints, holds, texts
from hsr8.suggestion import suggestion

NAME, NAMES, TABLE = "a name", "a list of two names", "a table"
"""Forms of the keys that have several, see `form`."""
MAX_LISTED = 20  # mistakes in a message
MAX_SHOWN = 60  # characters of a wrong value
EXPECTED = {
    "string_type": "a text in quotes",
    "string_too_short": "at least one character",
    "string_too_long": "at most {max_length} characters",
    "float_type": "a number",
    "float_parsing": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "int_parsing": "a whole number",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "too_long": "at most {max_length} elements",
    "too_short": "at least {min_length} elements",
    "dict_type": TABLE,
    "model_type": TABLE,
    "dataclass_type": TABLE,
    "model_attributes_type": TABLE,
}
_BOUNDS = {  # with the attribute of the limit
    Gt: ("gt", "more than"),
    Ge: ("ge", "at least"),
    Lt: ("lt", "less than"),
    Le: ("le", "at most"),
}
_OUTSIDE = ("greater_than", "greater_than_equal", "less_than", "less_than_equal", "multiple_of")
_NO_TAG = ("union_tag_invalid", "union_tag_not_found")
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake.

    Attributes:
        path: path of the key.
        text: mistake, and expected value.
    """

    path: Path
    text: str


def mistake_lines(
    error: ValidationError, kind: Any, data: Any, source: str = "", text: str = ""
) -> list[str]:
    """Return the first mistakes that pydantic found, a line each: place, key, mistake.

    Args:
        error: error of the validation of `data`.
        kind: type of the uppermost table.
        data: tables as given.
        source: file that begins the lines.
        text: TOML text of the file, for the lines of the keys.
    """
    mistakes = list(islice(mistakes_of(error, kind, data), MAX_LISTED))
    places = lines_of(text, [mistake.path for mistake in mistakes])
    lines = []
    for mistake in mistakes:
        begin = f"{source}:{places[mistake.path]}" if mistake.path in places else source
        parts = begin, dotted(mistake.path), mistake.text
        lines.append(": ".join(part for part in parts if part))
    return lines


def mistakes_of(
    error: ValidationError, kind: Any, data: Any, more_keys: Iterable[str] = ()
) -> Iterator[Mistake]:
    """Yield the mistakes that pydantic found.

    Args:
        error: error of the validation of `data`.
        kind: type of the uppermost table.
        data: tables as given.
        more_keys: further keys of the uppermost table in a file.
    """
    for details in error.errors(include_url=False):
        path = _plain_path(details, data)
        yield Mistake(path, _text(details, path, kind, data, more_keys))


def dotted(path: Path) -> str:
    """Return a key as written in messages: with dots, and indices in brackets."""
    parts = "".join(f"[{part}]" if isinstance(part, int) else f".{_short(part)}" for part in path)
    return parts.lstrip(".")


def shown(value: Any) -> str:
    """Return a value as TOML would show it, shortened for a message."""
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return _short(text.lower() if isinstance(value, bool) else text)


def form(value: object) -> str:
    """Return the form of a key that has several; the name of its type if it has none of them."""
    if isinstance(value, dict | BaseModel):
        return TABLE
    if isinstance(value, list | tuple):
        return NAMES
    return NAME if isinstance(value, str) else type(value).__name__


def listed_keys(kind: Any) -> list[str]:
    """Return the keys of a table of a file that messages list: those with a text."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return list(kind.model_fields)
    return list(texts(kind))


def _text(details: ErrorDetails, path: Path, kind: Any, data: Any, more_keys: Iterable[str]) -> str:
    what, context, got = details["type"], details.get("ctx", {}), shown(details["input"])
    meaning = _meaning(path, kind, data)
    if what == "value_error":
        reason = str(context["error"])
        return reason if ", got " in reason else f"{reason}, got {got}"
    if what in _UNKNOWN:
        return _unknown(path, kind, data, more_keys)
    if what == "missing" and isinstance(details["loc"][-1], int):
        elements = get_args(chosen(annotation_at(path, kind, data), _at(path, data))[0])
        return f"too short, got {shown(_at(path, data))}; expected {len(elements)} elements"
    if what == "missing":
        return "missing; expected a value" + (f": {meaning}" if meaning else "")
    if what == "json_invalid":
        return "tables or lists are nested too deeply"
    annotation, marks = chosen(annotation_at(path, kind, data), details["input"])
    listed, value = choices(annotation), details["input"]
    if what in _NO_TAG:
        forms = re.findall(r"'([^']*)'", context.get("expected_tags", ""))
        if forms and set(forms) <= {NAME, NAMES, TABLE}:
            return f"wrong type, got {got}; expected {' or '.join(forms)}"
        listed = _tags(annotation_at(path[:-1], kind, data), str(path[-1]))
        if what == "union_tag_not_found":
            return f"missing; expected {_alternatives(listed)}"
        value = value[path[-1]]
    if listed:
        hint = suggestion(str(value), listed)
        return f"wrong value, got {shown(value)}; expected {_alternatives(listed)}{hint}"
    if what == "string_pattern_mismatch":
        return f"wrong form, got {got}; expected {meaning}"
    misplaced = "" if hints(_table(path, kind, data)) else _misplaced(path, kind)
    return f"wrong value, got {got}; expected {_expected(details, marks, meaning)}{misplaced}"


def _expected(details: ErrorDetails, marks: list[Any], meaning: str) -> str:
    """Type or bounds of a value, with its unit."""
    what, unit = details["type"], re.search(r"\[([^\]]+)\]$", meaning)
    if what in _OUTSIDE:
        bounds = [_bound(mark) for mark in marks if isinstance(mark, (*_BOUNDS, MultipleOf))]
        of = f" {unit[1]}" if unit and unit[1] != "1" else ""
        return f"{' and '.join(bounds)}{of}"
    if what in EXPECTED:
        return EXPECTED[what].format(**details.get("ctx", {}))
    return details["msg"].removeprefix("Input should ").removeprefix("be ")


def _bound(mark: Any) -> str:
    if isinstance(mark, MultipleOf):
        return f"a multiple of {mark.multiple_of}"
    attribute, words = _BOUNDS[type(mark)]
    return f"{words} {getattr(mark, attribute):g}"


def _alternatives(listed: Sequence[str]) -> str:
    *first, last = (f'"{choice}"' for choice in listed)
    return f"{', '.join(first)} or {last}" if first else last


def _tags(annotation: Any, tag: str) -> list[str]:
    """Values of the tag in all tables of an annotation."""
    listed = choices(hints(annotation).get(tag))
    return listed + [value for part in get_args(annotation) for value in _tags(part, tag)]


def _unknown(path: Path, kind: Any, data: Any, more_keys: Iterable[str]) -> str:
    """Text about an unknown key: where it belongs, or a similar one, and the known ones."""
    key, table = str(path[-1]), _table(path, kind, data)
    listed = [*listed_keys(table), *(more_keys if len(path) == 1 else ())]
    hint = _misplaced(path, kind) or suggestion(key, [*listed, *hints(table)])
    if not hint and (elsewhere := _elsewhere(key, kind)):
        hint = f"; did you mean '{dotted(elsewhere)}'?"
    return f"unknown key{hint}; expected one of {', '.join(listed)}"


def _misplaced(path: Path, kind: Any) -> str:
    """Remedy for a key of the uppermost table that is within another one; empty for other keys."""
    key = str(path[-1])
    if len(path) == 1 or key not in hints(kind) or hints(chosen(hints(kind)[key])[0]):
        return ""
    return f"; {key!r} is a key of the whole file: move it above the first [table]"


def _elsewhere(key: str, kind: Any) -> Path:
    """Uppermost path of a key with this name; empty without one."""
    tables: list[tuple[Path, Any]] = [((), kind)]
    for path, table in tables:  # grows during the search
        if key in hints(table):
            return (*path, key)
        for name, hint in hints(table).items():
            inner, _ = chosen(hint)
            if hints(inner):
                tables.append(((*path, name), inner))
    return ()


def _table(path: Path, kind: Any, data: Any) -> Any:
    """Type of the table around the key at a path."""
    return chosen(annotation_at(path[:-1], kind, data), _at(path[:-1], data))[0]


def _meaning(path: Path, kind: Any, data: Any) -> str:
    """Text of the innermost documented key of a path."""
    for k in range(len(path), 0, -1):
        if (text := texts(_table(path[:k], kind, data)).get(str(path[k - 1]))) is not None:
            return text.rstrip(".")
    return ""


def _at(path: Path, data: Any) -> Any:
    for part in path:
        data = data[part] if holds(data, part) else None
    return data


def _plain_path(details: ErrorDetails, data: Any) -> Path:
    """Path of a mistake without the names of the types that pydantic puts between the keys."""
    path: list[str | int] = []
    absent = details["type"] in ("missing", *_UNKNOWN)
    location = details["loc"]
    for k, part in enumerate(location):
        if holds(data, part):
            data = data[part]
            path.append(part)
        elif absent and k == len(location) - 1 and isinstance(part, str):
            path.append(part)
    if details["type"] in _NO_TAG:
        key = details["ctx"]["discriminator"].strip("'")
        if key.isidentifier():
            path.append(key)
    return tuple(path)


def _short(text: str) -> str:
    return escaped(text if len(text) <= MAX_SHOWN else f"{text[: MAX_SHOWN - 3]}...")
