"""A reference as ramps and as a table."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from walking.foothold import Foothold
from walking.pattern.ramps import Ramps, ZmpRamp, table_of

NUMBER = st.floats(-1.0, 1.0)
LEFT = st.builds(Foothold, st.just(True), NUMBER, NUMBER, NUMBER)
RIGHT = st.builds(Foothold, st.just(False), NUMBER, NUMBER, NUMBER)
FEET = st.one_of(
    st.tuples(LEFT, RIGHT), st.tuples(RIGHT, LEFT), LEFT.map(lambda foot: (foot, foot))
)
RAMPS = st.lists(
    st.builds(ZmpRamp, st.integers(1, 100), NUMBER, NUMBER, NUMBER, NUMBER, FEET),
    min_size=1,
    max_size=5,
)


@given(RAMPS)
def test_a_table_holds_all_of_a_reference(ramps):
    table = table_of(ramps)
    read = Ramps(table)
    assert list(read) == ramps
    assert table_of(read) is table


@given(RAMPS)
def test_only_in_single_support_both_feet_are_one(ramps):
    for ramp, read in zip(ramps, Ramps(table_of(ramps)), strict=True):
        assert (read.feet[0] is read.feet[1]) == (ramp.feet[0] is ramp.feet[1])


@given(RAMPS, st.integers(0, 5))
def test_what_is_left_of_a_reference_is_one(ramps, gone):
    read = Ramps(table_of(ramps))
    left = read[gone:]
    assert isinstance(left, Ramps)
    assert list(left) == ramps[gone:]
    np.testing.assert_array_equal(left.table, read.table[gone:])


@given(RAMPS)
def test_the_goal_is_the_end_of_the_ramp_under_way(ramps):
    assert Ramps(table_of(ramps)).goal == (ramps[0].bx, ramps[0].by)
