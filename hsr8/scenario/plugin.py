"""Section ``[plugin]``: a user-defined planner, gaze and walker."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from annotated_types import doc
from pydantic import Field, PrivateAttr

from hsr8.scenario.section import Section

KINDS = ("planner", "gaze", "walker")

Reference = Annotated[str, Field(pattern=r"^$|^.+\.py:[A-Za-z_][A-Za-z0-9_]*$")]


class Plugin(Section):
    """User-defined planner, gaze and walker, each a class in a Python file."""

    planner: Annotated[
        Reference,
        doc("FILE.py:CLASS with a method `plan`; replaces `navigation.planner`; empty: none."),
    ] = ""
    gaze: Annotated[
        Reference,
        doc("FILE.py:CLASS with a method `choose`; replaces `navigation.gaze`; empty: none."),
    ] = ""
    walker: Annotated[
        Reference,
        doc("FILE.py:CLASS with a method `step`; replaces the walking engine; empty: none."),
    ] = ""

    _untrusted: dict[str, str] = PrivateAttr(default_factory=dict)

    @property
    def named(self) -> dict[str, str]:
        """References that are given, by kind."""
        references = {kind: getattr(self, kind) for kind in KINDS}
        return {kind: reference for kind, reference in references.items() if reference}

    @property
    def untrusted(self) -> dict[str, str]:
        """Kinds whose code must not run without consent, and the place that names each."""
        return self._untrusted


def located_plugins(table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a scenario's tables with the absolute paths of the plugins next to it.

    Args:
        table: table with `plugin` or without.
        folder: folder in which a relative path begins; else it begins in the working folder.
    """
    plugin = table.get("plugin")
    if not isinstance(plugin, dict):
        return dict(table)
    located = {}
    for kind, reference in plugin.items():
        name, colon, word = str(reference).rpartition(":")
        file = folder / os.path.expanduser(name)
        relative_file = colon and kind in KINDS and os.path.isfile(file)
        located[kind] = f"{file.absolute()}:{word}" if relative_file else reference
    return {**table, "plugin": located}
