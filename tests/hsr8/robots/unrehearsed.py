"""Robots without their rehearsal, for tests of models: walks take nine tenths of the time of loading."""

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
