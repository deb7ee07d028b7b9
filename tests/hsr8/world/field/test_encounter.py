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
    point, velocity = WALK.at(5.0)
    assert point == pytest.approx((0.5, 0.0))
    assert velocity == pytest.approx((0.1, 0.0))
    point, velocity = WALK.at(20.0)
    assert point == pytest.approx((1.0, -1.0))
    assert velocity == pytest.approx((0.0, -0.1))
    assert WALK.at(30.0)[0] == pytest.approx((1.0, -2.0))


@given(angles, speeds, speeds, angles)
def test_the_mover_comes_straight_at_the_robot_from_its_bearing(path, pace, speed, bearing):
    velocity = (pace * cos(path), pace * sin(path))
    course = course_to(velocity, speed, bearing)
    assume(course is not None)
    assert hypot(*course) == pytest.approx(speed)
    relative = np.subtract(course, velocity)
    sight = np.array([cos(path + bearing), sin(path + bearing)])
    assert relative @ sight == pytest.approx(-np.hypot(*relative), abs=1e-9)


@given(angles, speeds, st.floats(0.0, 0.95), angles)
def test_a_slow_mover_never_comes_from_behind(path, pace, share, bearing):
    assume(cos(bearing) <= 0.0)
    velocity = (pace * cos(path), pace * sin(path))
    assert course_to(velocity, share * pace, bearing) is None


@given(st.tuples(st.floats(-1.9, 1.9), st.floats(-0.9, 0.9)), angles, speeds, st.floats(0.0, 90.0))
def test_a_passage_is_there_in_time_and_stays_in_the_box(point, path, speed, time):
    velocity = (speed * cos(path), speed * sin(path))
    motion = passage_through(point, velocity, time, (2.0, 1.0))
    assert motion.position(time) == pytest.approx(point, abs=1e-6)
    for moment in np.linspace(0.0, 200.0, 40).tolist():
        x, y = motion.position(moment)
        assert abs(x) <= 2.0 + 1e-9
        assert abs(y) <= 1.0 + 1e-9
    # It goes on to the rim, and came from there unless it is on its path at time zero.
    assert max(abs(motion.end[0]) / 2.0, abs(motion.end[1])) == pytest.approx(1.0)
    at_rim = max(abs(motion.start[0]) / 2.0, abs(motion.start[1])) == pytest.approx(1.0)
    assert at_rim or motion.depart == pytest.approx(0.0, abs=1e-9)


def test_no_passage_through_a_place_outside():
    assert passage_through((2.5, 0.0), (0.1, 0.0), 1.0, (2.0, 1.0)) is None
