"""Robots without their rehearsal, whose walks take most of the time of loading."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def unrehearsed_robots() -> Iterator[None]:
    """Load robots without the walks that reduce their speeds and look for arms that touch."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "hsr8.robots.walk.fitting.within_joints", lambda _robot, fitted, _: (fitted, [])
        )
        patch.setattr("hsr8.robots.inspection.touching_parts", lambda _: set())
        yield
