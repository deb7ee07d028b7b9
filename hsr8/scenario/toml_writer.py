"""Nested tables as TOML text; the standard library only reads."""

import json
import re
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def write_toml(data: dict[str, Any]) -> str:
    """TOML text of `data`; values are tables, lists, strings, numbers and truth values.

    Raises:
        TypeError: a value has no TOML form.
    """
    return "\n".join(_table(data, ())).strip() + "\n"


def _table(table: dict[str, Any], path: tuple[str, ...]) -> list[str]:
    """Lines of a table: its plain values, its tables, its arrays of tables."""
    plain = {k: v for k, v in table.items() if not isinstance(v, dict) and not _of_tables(v)}
    lines = [f"{_key(k)} = {toml_value(v)}" for k, v in plain.items()]
    for key, value in table.items():
        if isinstance(value, dict):
            header = ".".join(map(_key, (*path, key)))
            lines += ["", f"[{header}]", *_table(value, (*path, key))]
        elif _of_tables(value):
            header = ".".join(map(_key, (*path, key)))
            for entry in value:
                lines += ["", f"[[{header}]]", *_table(entry, (*path, key))]
    return lines


def _of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _string(key)


def _string(text: str) -> str:
    # JSON escapes are TOML escapes, but for DEL, which TOML wants escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_value(value: Any) -> str:
    """TOML text of one value.

    Raises:
        TypeError: it has no TOML form.
    """
    if hasattr(value, "tolist"):  # a number or an array of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {toml_value(v)}" for k, v in value.items()) + "}"
    raise TypeError(f"no TOML form of {type(value).__name__}")
