from math import inf

from hsr8.recorder.log.throttle import Throttle


def test_the_first_moment_is_due_and_then_one_in_every_period():
    throttle = Throttle(0.06)
    due = [k for k in range(100) if throttle.due(0.02 * k)]
    assert due == list(range(0, 100, 3))


def test_without_a_period_every_moment_is_due():
    throttle = Throttle(0.0)
    assert all(throttle.due(0.02 * k) for k in range(100))


def test_after_a_gap_the_period_begins_anew():
    throttle = Throttle(1.0)
    assert [throttle.due(time) for time in (0.0, 0.9, 1.7, 2.0, 2.7)] == [
        True,
        False,
        True,
        False,
        True,
    ]


def test_once_alone_where_the_period_is_endless():
    throttle = Throttle(inf)
    assert [throttle.due(time) for time in (0.0, 1.0)] == [True, False]
