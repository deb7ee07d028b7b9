import pytest

from walking.body.tree import Sole

SOLE = Sole(0.01, 0.11, 0.05)


def test_strong_ankles_press_the_whole_sole():
    assert SOLE.pressed(0.13, 0.06) is SOLE


@pytest.mark.parametrize("forward", [0.03, 0.08, 0.11, 0.115, 0.2])
@pytest.mark.parametrize("side", [0.02, 0.05, 0.1])
def test_weak_ankles_press_the_part_within_their_torque(forward, side):
    part = SOLE.pressed(forward, side)
    front, back = part.centre + part.half_length, part.centre - part.half_length
    assert front == pytest.approx(min(0.12, forward))
    assert back == pytest.approx(max(-0.10, -forward))
    assert part.half_width == min(0.05, side)


def test_what_is_pressed_can_be_pressed():
    part = SOLE.pressed(0.06, 0.03)
    assert part.pressed(0.06, 0.03) is part
