from types import SimpleNamespace

from hsr8.walk_counters import WalkCounters
from walking.command_limits import Limit


def test_ticks_and_active_limits_are_counted_once():
    counters = WalkCounters()
    for limits, depth in (
        ((), 0.02),
        ((Limit.SPEED, Limit.BALANCE), 0.01),
        ((Limit.SPEED, Limit.SPEED), -0.003),
        ((), 0.0),
    ):
        counters.add(SimpleNamespace(limits=limits, zmp_depth=depth), 0.001)
    assert (counters.ticks, counters.limited, counters.zmp_outside) == (4, 2, 1)
    assert counters.by_limit == {Limit.SPEED: 2, Limit.BALANCE: 1}
    assert counters.min_zmp_depth == -0.003
    assert counters.wall_times.tolist() == [0.001] * 4
