import numpy as np
import pytest

from navigation.motion.velocity_mapping import Facing, arriving, towards


@pytest.mark.parametrize("course", [-2.0, 0.0, 0.7])
def test_a_heading_overrides_the_course(course):
    assert Facing(0.5).on(course) == 0.5
    assert Facing().on(course) == course


def test_the_body_turns_to_the_heading_near_the_goal_only(task):
    for ratio in (0.9, 1.1):
        point = np.array([ratio * 0.4, 0.0])
        goal, via = (task((0.0, 0.0), is_goal=end) for end in (True, False))
        assert arriving(point, goal, 0.4) == (ratio < 1.0)
        assert not arriving(point, via, 0.4)
        assert arriving(point, task((0.0, 0.0), is_goal=True, aligning=True), 0.0)


@pytest.mark.parametrize("course", [-3.0, 0.2, 3.1])
@pytest.mark.parametrize("offset", [-2.0, -0.3, 0.0, 0.5, 3.0])
def test_a_body_turns_to_a_direction_but_no_further_from_its_course(course, offset):
    heading = towards(course + offset, course, 1.0).on(course)
    assert heading - course == pytest.approx(np.clip(offset, -1.0, 1.0))
