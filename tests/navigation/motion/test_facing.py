import numpy as np
import pytest

from navigation.motion.facing import Facing, arriving


@pytest.mark.parametrize("course", [-2.0, 0.0, 0.7])
def test_a_heading_is_faced_whatever_the_way_and_else_the_way(course):
    assert Facing(0.5).on(course) == 0.5
    assert Facing().on(course) == course
    assert Facing(aside=0.4).on(course) == pytest.approx(course + 0.4)


def test_the_body_turns_to_the_heading_near_the_goal_and_at_it_but_at_no_via_point(task):
    for share in (0.9, 1.1):
        place = np.array([share * 0.4, 0.0])
        goal, via = (task((0.0, 0.0), is_goal=end) for end in (True, False))
        assert arriving(place, goal, 0.4) == (share < 1.0)
        assert not arriving(place, via, 0.4)
        assert arriving(place, task((0.0, 0.0), is_goal=True, aligning=True), 0.0)
