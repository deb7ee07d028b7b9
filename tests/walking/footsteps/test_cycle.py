"""Gait cycle."""

import pytest

from walking.footsteps.cycle import GaitCycle


@pytest.mark.parametrize("first", [0, 1])
def test_a_cycle_begins_with_every_second_footstep(first):
    cycle, feet = GaitCycle(), [foot for foot in (first, 1 - first) * 3 for _ in range(10)]
    begun = [tick for tick, foot in enumerate(feet) if cycle.begins(foot)]
    assert begun == [0, 20, 40]


def test_after_a_rest_the_other_foot_may_be_the_first():
    cycle = GaitCycle()
    assert cycle.begins(0)
    assert not cycle.begins(1)
    cycle.reset()
    assert cycle.begins(1)
