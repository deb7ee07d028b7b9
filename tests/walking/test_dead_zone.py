"""Dead zone."""

from hypothesis import given
from hypothesis import strategies as st

from walking.dead_zone import dead_zone


@given(st.floats(-10.0, 10.0), st.floats(0.0, 5.0))
def test_dead_zone_is_odd_and_takes_away_at_most_the_zone(value, zone):
    rest = dead_zone(value, zone)
    assert rest == -dead_zone(-value, zone)
    assert abs(rest) == max(0.0, abs(value) - zone)
