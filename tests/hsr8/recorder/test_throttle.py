from math import inf

from hsr8.recorder.throttle import Throttle


def test_one_sample_per_period_passes():
    throttle = Throttle(0.06)
    due = [k for k in range(100) if throttle.due(0.02 * k)]
    assert due == list(range(0, 100, 3))


def test_without_a_period_every_sample_passes():
    throttle = Throttle(0.0)
    assert all(throttle.due(0.02 * k) for k in range(100))


def test_the_period_restarts_after_a_gap():
    throttle = Throttle(1.0)
    assert [throttle.due(time) for time in (0.0, 0.9, 1.7, 2.0, 2.7)] == [
        True,
        False,
        True,
        False,
        True,
    ]


def test_one_sample_passes_in_an_infinite_period():
    throttle = Throttle(inf)
    assert [throttle.due(time) for time in (0.0, 1.0)] == [True, False]
