"""Timing of a footstep, changed while it is under way."""

import pytest

from walking.gait.footstep_clock import SwingWindow, WeightShift

WINDOW = SwingWindow(0.05, 0.9, 10)


def test_a_weight_shift_goes_straight_to_its_goal_and_stays():
    shift = WeightShift(10, 30, (0.1, -0.2), 1.0)
    assert shift.zmp_at(10, (0.3, 0.2)) == (0.1, -0.2)
    assert shift.zmp_at(20, (0.3, 0.2)) == pytest.approx((0.2, 0.0))
    assert shift.zmp_at(99, (0.3, 0.2)) == pytest.approx((0.3, 0.2))
    assert [shift.right_weight_at(t, 0.0) for t in (10, 20, 99)] == pytest.approx([1.0, 0.5, 0.0])


def test_the_swing_fills_its_window_of_single_support():
    single = WINDOW.single_support(60)
    assert (single.first, single.last) == (3, 54)
    phases = [single.phase(t) for t in range(61)]
    assert phases[3] == 0.0 < phases[4]
    assert phases[53] < 1.0 == phases[54]
    assert phases == sorted(phases)


@pytest.mark.parametrize("ticks", [1, 35, 60, 90])
@pytest.mark.parametrize("elapsed", [2, 20, 30])
def test_a_swing_retimed_goes_on_from_where_it_is_and_has_time_to_come_down(elapsed, ticks):
    single = WINDOW.single_support(60)
    retimed = WINDOW.retimed(single, elapsed, ticks)
    assert retimed.phase(elapsed) == single.phase(elapsed)
    assert retimed.phase(retimed.last) == 1.0
    assert retimed.last >= elapsed + WINDOW.min_ticks
    assert retimed.ticks == ticks or retimed.last == elapsed + WINDOW.min_ticks


def test_a_swing_can_be_retimed_again():
    once = WINDOW.retimed(WINDOW.single_support(60), 20, 80)
    twice = WINDOW.retimed(once, 30, 60)
    assert twice.phase(30) == once.phase(30)
    assert twice.phase(twice.last) == 1.0
