"""Counter-swing of the arms."""

from hypothesis import given
from hypothesis import strategies as st

from walking.arms import arm_swing
from walking.parameters import ArmParameters

PARAMETERS = ArmParameters()


@given(st.floats(-1.0, 1.0))
def test_the_swing_is_odd_and_limited(apart):
    swing = arm_swing(apart, PARAMETERS)
    assert swing == -arm_swing(-apart, PARAMETERS)
    assert abs(swing) <= PARAMETERS.limit


def test_the_left_arm_goes_back_when_the_left_foot_is_ahead():
    assert arm_swing(0.05, PARAMETERS) > 0.0
