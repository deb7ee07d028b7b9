"""Touchdown detection."""

from walking.parameters import EstimatorParameters
from walking.servos.touchdown import TouchdownDetector

PARAMETERS = EstimatorParameters()


def test_touch_down_needs_the_phase_the_force_and_the_duration():
    touch = TouchdownDetector(PARAMETERS)
    assert not touch.update(0.3, 50.0)
    assert not touch.update(0.7, 50.0)
    assert touch.update(0.72, 50.0)
    assert not touch.update(0.74, 1.0)
    assert not touch.update(0.76, 50.0)


def test_a_single_tick_of_contact_is_not_a_touchdown():
    assert not TouchdownDetector(PARAMETERS).update(0.7, 50.0)
