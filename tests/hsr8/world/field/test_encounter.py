from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hsr8.world.field.encounter import NominalWalk, course_to, passage_through

WALK = NominalWalk([(0.0, 0.0), (1.0, 0.0), (1.0, -2.0)], 0.1)
angles = st.floats(-pi, pi)
speeds = st.floats(0.02, 0.3)


def test_the_nominal_walk_follows_its_legs():
    assert WALK.duration == pytest.approx(30.0)
    place, velocity = WALK.at(5.0)
    assert place == pytest.approx((0.5, 0.0))
    assert velocity == pytest.approx((0.1, 0.0))
    place, velocity = WALK.at(20.0)
    assert place == pytest.approx((1.0, -1.0))
    assert velocity == pytest.approx((0.0, -0.1))
    assert WALK.at(30.0)[0] == pytest.approx((1.0, -2.0))


@given(angles, speeds, speeds, angles)
def test_the_mover_comes_straight_at_the_robot_from_its_bearing(way, pace, speed, bearing):
    velocity = (pace * cos(way), pace * sin(way))
    course = course_to(velocity, speed, bearing)
    assume(course is not None)
    assert hypot(*course) == pytest.approx(speed)
    relative = np.subtract(course, velocity)
    seen = np.array([cos(way + bearing), sin(way + bearing)])
    assert relative @ seen == pytest.approx(-np.hypot(*relative), abs=1e-9)


@given(angles, speeds, st.floats(0.0, 0.95), angles)
def test_a_slow_mover_never_comes_from_behind(way, pace, share, bearing):
    assume(cos(bearing) <= 0.0)
    velocity = (pace * cos(way), pace * sin(way))
    assert course_to(velocity, share * pace, bearing) is None


@given(st.tuples(st.floats(-1.9, 1.9), st.floats(-0.9, 0.9)), angles, speeds, st.floats(0.0, 90.0))
def test_a_passage_is_there_in_time_and_stays_in_the_box(place, way, speed, time):
    velocity = (speed * cos(way), speed * sin(way))
    law = passage_through(place, velocity, time, (2.0, 1.0))
    assert law.position(time) == pytest.approx(place, abs=1e-6)
    for moment in np.linspace(0.0, 200.0, 40).tolist():
        x, y = law.position(moment)
        assert abs(x) <= 2.0 + 1e-9
        assert abs(y) <= 1.0 + 1e-9
    # It goes on to the rim, and came from there unless it is on its way at time zero.
    assert max(abs(law.end[0]) / 2.0, abs(law.end[1])) == pytest.approx(1.0)
    at_rim = max(abs(law.start[0]) / 2.0, abs(law.start[1])) == pytest.approx(1.0)
    assert at_rim or law.depart == pytest.approx(0.0, abs=1e-9)


def test_no_passage_through_a_place_outside():
    assert passage_through((2.5, 0.0), (0.1, 0.0), 1.0, (2.0, 1.0)) is None
