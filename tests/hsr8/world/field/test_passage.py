from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.world.field.passage import Passage

LAW = Passage((-1.0, 0.0), (1.0, 1.5), 0.25, depart=4.0)
times = st.floats(0.0, 60.0)


def test_it_waits_goes_and_stays():
    assert LAW.position(3.9) == LAW.start
    assert LAW.velocity(3.9) == (0.0, 0.0)
    assert LAW.position(4.0 + 5.0) == pytest.approx((0.0, 0.75))
    assert LAW.position(4.0 + 10.0) == pytest.approx(LAW.end)
    assert LAW.position(50.0) == LAW.end
    assert LAW.velocity(50.0) == (0.0, 0.0)


@given(times, times)
def test_it_is_never_faster_than_its_speed(one, other):
    way = hypot(*(b - a for a, b in zip(LAW.position(one), LAW.position(other), strict=True)))
    assert way <= LAW.speed * abs(other - one) + 1e-12


@given(st.floats(4.0, 13.99))
def test_on_its_way_it_has_its_speed(time):
    assert hypot(*LAW.velocity(time)) == pytest.approx(LAW.speed)
