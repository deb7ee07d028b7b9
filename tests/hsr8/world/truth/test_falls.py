"""Falls counted."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.truth.falls import RECOVERY_TIME, Falls


def count(record):
    falls = Falls()
    begun = [falls.add(0.02 * k, fallen=fallen) for k, fallen in enumerate(record)]
    assert sum(begun) == falls.count
    return falls.count


@given(st.lists(st.booleans(), max_size=round(RECOVERY_TIME / 0.02)))
def test_kneeling_and_lying_again_are_the_same_fall(record):
    assert count(record) == any(record)


def test_a_fall_after_standing_is_another():
    stands = np.zeros(round(RECOVERY_TIME / 0.02) + 1, bool)
    assert count([True, True, *stands, True, *stands, True]) == 3


def test_it_lasts_until_the_robot_has_stayed_up():
    falls = Falls()
    assert not falls.lasting(0.0)
    falls.add(1.0, fallen=True)
    falls.add(1.5, fallen=False)
    assert falls.lasting(1.5)
    assert not falls.lasting(1.0 + RECOVERY_TIME)
