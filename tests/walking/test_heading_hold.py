"""The heading hold on a body that turns as it is told."""

import pytest

from walking.heading_hold import HeadingHold
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

PARAMETERS = StabilizerParameters()


def test_a_slip_of_the_body_is_turned_back():
    hold, plan, body = HeadingHold(PARAMETERS), 0.4, 0.3
    hold.rest(plan - body)
    body -= 0.05
    for _ in range(1000):
        turned = hold.rate(plan - body) * CONTROL_PERIOD
        plan, body = plan + turned, body + turned
    assert body == pytest.approx(0.3, abs=1e-3)


def test_it_holds_what_it_was_told_to_rest_at():
    hold = HeadingHold(PARAMETERS)
    hold.rest(0.2)
    assert hold.rate(0.2) == 0.0


def test_its_rate_is_limited_and_mirrored():
    one, other = HeadingHold(PARAMETERS), HeadingHold(PARAMETERS)
    assert one.rate(2.0) == PARAMETERS.heading_rate
    assert other.rate(-2.0) == -PARAMETERS.heading_rate
