from types import SimpleNamespace

import pytest

from hsr8.recorder.walk_tally import WalkTally
from walking.admission import Limit


def test_every_tick_is_counted_once_and_every_limit_that_bound_too():
    tally = WalkTally()
    for limits, depth in (
        ((), 0.02),
        ((Limit.SPEED, Limit.BALANCE), 0.01),
        ((Limit.SPEED, Limit.SPEED), -0.003),
        ((), 0.0),
    ):
        tally.add(SimpleNamespace(limits=limits, zmp_depth=depth), 0.001)
    assert (tally.ticks, tally.altered, tally.outside) == (4, 2, 1)
    assert tally.by_limit == {Limit.SPEED: 2, Limit.BALANCE: 1}
    assert tally.least_depth == -0.003
    assert (tally.wall.count, tally.wall.mean) == (4, pytest.approx(0.001))
