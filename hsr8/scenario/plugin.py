"""Section ``[plugin]``: a user-defined planner, gaze and walker."""

from typing import Annotated

from pydantic import Field

from hsr8.scenario.section import Section

Reference = Annotated[str, Field(pattern=r"^$|^.+\.py:[A-Za-z_][A-Za-z0-9_]*$")]


class Plugin(Section):
    """User-defined planner, gaze and walker, each a class in a Python file."""

    planner: Reference = ""
    """FILE.py:CLASS with a method `plan`; replaces `navigation.planner`; empty: none."""
    gaze: Reference = ""
    """FILE.py:CLASS with a method `choose`; replaces `navigation.gaze`; empty: none."""
    walker: Reference = ""
    """FILE.py:CLASS with a method `step`; replaces the walking engine; empty: none."""

    @property
    def named(self) -> tuple[str, ...]:
        """References that are given, planner first."""
        references = self.planner, self.gaze, self.walker
        return tuple(reference for reference in references if reference)
