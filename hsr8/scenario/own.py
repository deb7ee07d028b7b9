"""Decisions that do not come with hsr8: a section of the scenario."""

from typing import Annotated

from pydantic import Field

from hsr8.scenario.section import Section

Reference = Annotated[str, Field(pattern=r"^$|^.+\.py:[A-Za-z_][A-Za-z0-9_]*$")]


class Own(Section):
    """Classes of one's own that decide in place of those that come with hsr8."""

    planner: Reference = ""
    """FILE.py:CLASS with a method plan, in place of `navigation.planner`; none if empty."""
    gaze: Reference = ""
    """FILE.py:CLASS with a method choose, in place of `navigation.gaze`; none if empty."""

    @property
    def named(self) -> tuple[str, ...]:
        """What is named, planner first."""
        return tuple(reference for reference in (self.planner, self.gaze) if reference)
