"""Changes of a description file that keep its comments and its order."""

from collections.abc import MutableMapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import InlineTable, Table

from hsr8.robots.file.description import Calibration


def with_calibration(text: str, calibration: Calibration) -> str:
    """Return the text of a description with a table ``[calibration]``.

    Args:
        text: text of the description, valid.
        calibration: replaces the present one, if any.
    """
    values = calibration.model_dump()
    document = tomlkit.parse(text)
    present = document.get("calibration")
    if isinstance(present, InlineTable) or (
        isinstance(present, Table) and not present.is_super_table()
    ):
        _update(present, values)
        return tomlkit.dumps(document)
    document.pop("calibration", None)  # dotted keys
    table = tomlkit.table()
    for key, value in values.items():
        table[key] = _inline(value) if isinstance(value, dict) else value
    appended = tomlkit.document()
    appended["calibration"] = table
    return f"{tomlkit.dumps(document).rstrip()}\n\n{tomlkit.dumps(appended)}"


def moved(text: str, source: Path, target: Path) -> str:
    """Return the text of a description for another folder: paths next to it become absolute.

    Args:
        text: text of the description, valid.
        source: folder of the description.
        target: folder of the copy.
    """
    if source.resolve() == target.resolve():
        return text
    document = tomlkit.parse(text)
    paths: list[tuple[MutableMapping[str, Any], str]] = [
        (document, key) for key in ("model", "srdf") if key in document
    ]
    packages = document.get("packages", {})
    paths += [(packages, name) for name in packages]
    for table, key in paths:
        path = source / Path(table[key]).expanduser()
        if path.exists() and not Path(table[key]).is_absolute():
            table[key] = str(path.resolve())
    return tomlkit.dumps(document)


def _update(table: MutableMapping[str, Any], values: dict[str, Any]) -> None:
    """Set values one by one, so that comments in the table remain."""
    for key, value in values.items():
        if isinstance(value, dict) and key in table:
            _update(table[key], value)
        else:
            table[key] = value


def _inline(values: dict[str, Any]) -> InlineTable:
    table = tomlkit.inline_table()
    table.update(values)
    return table
