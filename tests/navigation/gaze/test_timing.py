from navigation.gaze.timing import GazeTiming
from navigation.parameters.gaze import GazeParameters


def timing():
    return GazeTiming(GazeParameters(dwell=0.1, arrival_tolerance=0.05, max_saccade_time=0.6))


def test_the_first_decision_is_immediate(view):
    assert timing().ready(0.0, view())


def test_a_decision_waits_for_arrival_and_dwell(view):
    gaze = timing()
    gaze.decided(0.0, 1.0, -0.4)
    assert not gaze.ready(0.06, view(0.4, -0.4))
    assert not gaze.ready(0.12, view(0.98, -0.4))
    assert not gaze.ready(0.18, view(1.0, -0.4))
    assert gaze.ready(0.24, view(1.0, -0.4))


def test_a_gaze_that_stays_is_decided_again_at_every_frame(view):
    gaze = timing()
    gaze.decided(0.0, 0.0, -0.4)
    gaze.ready(0.06, view(0.0, -0.4))
    assert gaze.ready(0.18, view(0.0, -0.4))
    gaze.decided(0.18, 0.0, -0.4)
    assert gaze.ready(0.24, view(0.0, -0.4))


def test_a_head_that_never_arrives_does_not_block(view):
    gaze = timing()
    gaze.decided(0.0, 1.0, -0.4)
    assert not gaze.ready(0.5, view(0.2, -0.4))
    assert gaze.ready(0.6, view(0.2, -0.4))
