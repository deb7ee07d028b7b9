"""Changes of a description file that keep its comments and its order."""

from collections.abc import MutableMapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import InlineTable, Table

from hsr8.robots.description import Calibration
from hsr8.robots.inspection import Inspection
from hsr8.version import VERSION


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


def description_text(inspection: Inspection, file: Path, command: str) -> str:
    """Return the text of a guessed description; comments have the reason of each guess.

    Args:
        inspection: inspection of a model, with a description.
        file: file to be written, next to which the model may be.
        command: command line that guessed the roles.
    """
    keys = inspection.require_description().model_dump(mode="json", exclude_defaults=True)
    model, folder = inspection.model.resolve(), file.resolve().parent
    keys["model"] = str(model.relative_to(folder) if model.is_relative_to(folder) else model)
    tables = [key for key, value in keys.items() if isinstance(value, dict)]
    reasons = {f.role: f"{f.sureness}: {f.reason}" for f in inspection.findings}
    document = tomlkit.document()
    document.add(tomlkit.comment(f"Guessed by {command}, version {VERSION}: check every line."))

    def add(key: str) -> None:
        item = tomlkit.item(keys[key])
        if key in reasons:
            item.comment(reasons[key])
        document.add(key, item)

    for key in (key for key in keys if key not in tables):
        add(key)
    for finding in inspection.findings:
        if finding.role not in keys:
            text = finding.part or finding.sureness
            document.add(tomlkit.comment(f"{finding.role}: {text}: {finding.reason}"))
    for key in tables:
        add(key)
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
