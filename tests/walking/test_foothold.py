"""Footholds and their rows."""

from hypothesis import given
from hypothesis import strategies as st

from walking.foothold import Foothold

NUMBER = st.floats(-10.0, 10.0)


@given(st.booleans(), NUMBER, NUMBER, NUMBER)
def test_a_row_holds_all_of_a_foothold(left, x, y, yaw):
    foothold = Foothold(left, x, y, yaw)
    assert Foothold.from_row(foothold.row) == foothold
    assert Foothold.from_row(list(foothold.row)).left is left
