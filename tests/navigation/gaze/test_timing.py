from navigation.gaze.planner import GazeTiming
from navigation.parameters.gaze import GazeParameters

LEFT, AHEAD = (1.0, -0.4), (0.0, -0.4)


def timing(**parameters):
    values = {
        "dwell": 0.1,
        "arrival_tolerance": 0.05,
        "max_saccade_time": 0.6,
        "max_turn_time": 1.5,
    }
    return GazeTiming(GazeParameters(**values, **parameters))


def test_the_first_decision_is_immediate():
    assert timing().ready(0.0, 1.0)


def test_a_decision_waits_for_arrival_and_dwell():
    gaze = timing()
    gaze.decided(0.0, LEFT)
    assert not gaze.ready(0.06, 0.6)
    assert not gaze.ready(0.12, 0.02)
    assert not gaze.ready(0.18, 0.0)
    assert gaze.ready(0.24, 0.0)


def test_a_gaze_that_stays_is_decided_again_at_every_frame():
    gaze = timing()
    gaze.decided(0.0, AHEAD)
    gaze.ready(0.06, 0.0)
    assert gaze.ready(0.18, 0.0)
    gaze.decided(0.18, AHEAD)
    assert gaze.ready(0.24, 0.0)


def test_a_head_that_never_arrives_does_not_block():
    gaze = timing()
    gaze.decided(0.0, LEFT)
    assert not gaze.ready(0.5, 0.8)
    assert gaze.ready(0.6, 0.8)


def test_a_body_has_more_time_to_arrive():
    gaze = timing(moved_by="body")
    gaze.decided(0.0, LEFT)
    assert not gaze.ready(1.4, 0.8)
    assert gaze.ready(1.5, 0.8)
