from math import inf

from hsr8.recorder.log.pace import Pace


def test_the_first_moment_is_due_and_then_one_in_every_period():
    pace = Pace(0.06)
    due = [k for k in range(100) if pace.due(0.02 * k)]
    assert due == list(range(0, 100, 3))


def test_without_a_period_every_moment_is_due():
    pace = Pace(0.0)
    assert all(pace.due(0.02 * k) for k in range(100))


def test_after_a_gap_the_period_begins_anew():
    pace = Pace(1.0)
    assert [pace.due(time) for time in (0.0, 0.9, 1.7, 2.0, 2.7)] == [
        True,
        False,
        True,
        False,
        True,
    ]


def test_once_alone_where_the_period_is_endless():
    pace = Pace(inf)
    assert [pace.due(time) for time in (0.0, 1.0)] == [True, False]
