from navigation.gaze.timing import GazeTiming


def test_the_first_decision_is_due_at_once(view):
    assert GazeTiming(0.1, 0.05, 0.6).due(0.0, view())


def test_it_waits_for_arrival_and_dwell(view):
    timing = GazeTiming(0.1, 0.05, 0.6)
    timing.decided(0.0, 1.0, -0.4)
    assert not timing.due(0.06, view(0.4, -0.4))
    assert not timing.due(0.12, view(0.98, -0.4))
    assert not timing.due(0.18, view(1.0, -0.4))
    assert timing.due(0.24, view(1.0, -0.4))


def test_a_gaze_that_stays_is_decided_again_at_every_frame(view):
    timing = GazeTiming(0.1, 0.05, 0.6)
    timing.decided(0.0, 0.0, -0.4)
    timing.due(0.06, view(0.0, -0.4))
    assert timing.due(0.18, view(0.0, -0.4))
    timing.decided(0.18, 0.0, -0.4)
    assert timing.due(0.24, view(0.0, -0.4))


def test_a_head_that_never_arrives_does_not_block(view):
    timing = GazeTiming(0.1, 0.05, 0.6)
    timing.decided(0.0, 1.0, -0.4)
    assert not timing.due(0.5, view(0.2, -0.4))
    assert timing.due(0.6, view(0.2, -0.4))
