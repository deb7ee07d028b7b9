import pytest

from navigation.motion.facing import Facing


@pytest.mark.parametrize("course", [-2.0, 0.0, 0.7])
def test_a_heading_is_faced_whatever_the_way_and_else_the_way(course):
    assert Facing(0.5).on(course) == 0.5
    assert Facing().on(course) == course
    assert Facing(aside=0.4).on(course) == pytest.approx(course + 0.4)
