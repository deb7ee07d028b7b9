"""Mistakes in the files of a benchmark, and the form of names."""

import re

from pydantic import ValidationError


def mistakes(error: ValidationError) -> list[str]:
    """Return key, mistake and value of every error that pydantic reports."""
    lines = []
    for details in error.errors():
        key, text = ".".join(map(str, details["loc"])), details["msg"]
        if details["type"] == "missing":
            lines.append(f"{key} is missing")
        elif details["type"] == "value_error":
            lines.append(f"{key}: {details['ctx']['error']}")
        else:
            lines.append(f"{key}: {text[:1].lower()}{text[1:]}, got {details['input']}")
    return lines


def checked_name(name: str) -> str:
    """Return the name of a suite or an entry.

    Raises:
        ValueError: it is not a name.
    """
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise ValueError(
            f"wrong form, got {name!r}; expected letters, digits, '.', '_' and '-', at most 64, "
            "the first a letter or digit"
        )
    return name
