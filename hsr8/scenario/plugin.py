"""Section ``[plugin]``: a user-defined planner, gaze and walker."""

from typing import Annotated

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
