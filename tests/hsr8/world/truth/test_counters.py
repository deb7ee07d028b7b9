import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.truth.truth import RECOVERY_TIME, CollisionCounter, Contact, Falls


def _touch(obstacle, moving=False, closing=True):
    return Contact(obstacle, f"obstacle {obstacle}", moving, "l_sole", 1.0, closing)


def _count(times, obstacle=0):
    counter = CollisionCounter()
    for time in times:
        counter.add(time, (_touch(obstacle),))
    return len(counter.collisions)


def test_a_long_touch_is_one_collision():
    assert _count([0.02 * k for k in range(500)]) == 1


@pytest.mark.parametrize(("pause", "collisions"), [(0.48, 1), (0.5, 2), (3.0, 2)])
def test_a_pause_of_half_a_second_makes_a_new_one(pause, collisions):
    assert _count([1.0, 1.0 + pause]) == collisions


def test_each_obstacle_has_its_own_episodes():
    counter = CollisionCounter()
    for k in range(10):
        counter.add(0.02 * k, (_touch(0), _touch(3, moving=True), _touch(0)))
    assert [c.obstacle for c in counter.collisions] == [0, 3]
    assert [c.name for c in counter.collisions] == ["obstacle 0", "obstacle 3"]
    assert [c.moving for c in counter.collisions] == [False, True]


def test_who_closed_the_gap_is_judged_at_the_beginning():
    counter = CollisionCounter()
    counter.add(0.0, (_touch(0, closing=False),))
    counter.add(0.02, (_touch(0, closing=True),))
    assert [c.closing for c in counter.collisions] == [False]


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
