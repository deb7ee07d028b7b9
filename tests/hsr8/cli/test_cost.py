import pytest

from hsr8.cli.cost import estimate
from hsr8.scenario.loader import load_scenario


def wall(*settings):
    return estimate(load_scenario("course", settings)).wall


def test_what_is_left_out_costs_nothing():
    full, blind = wall(), wall('camera.source="analytic"')
    still = wall('camera.source="analytic"', 'robot.body="kinematic"')
    assert full > blind > still > 0.0


def test_twice_as_long_costs_twice_as_much_but_for_the_start():
    start = 2.0 * wall("duration=100.0") - wall("duration=200.0")
    assert 0.0 < start < 10.0


def test_it_is_about_what_was_measured():
    # docs/results/speed.md: 124.7 s of `course` in 21 s.
    assert wall("duration=124.7") == pytest.approx(21.0, rel=0.25)
