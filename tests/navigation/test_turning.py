import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from navigation.turning import ALLOWANCE, accumulated_lag, perhaps_turned

S = np.diag([0.02**2, 0.03**2])
FORWARD = np.array([0.1, 0.0])


@given(lag=st.floats(0.0, 10.0), across=st.floats(-0.1, 0.1))
def test_a_mover_that_goes_on_is_forgiven_and_aside_does_not_count(lag, across) -> None:
    after = accumulated_lag(lag, np.array([0.0, across]), S, FORWARD)
    assert np.isclose(after, max(0.0, lag - ALLOWANCE))


@given(angle=st.floats(-np.pi, np.pi), speed=st.floats(0.01, 1.0), behind=st.floats(0.0, 5.0))
def test_lag_is_counted_in_standard_deviations_along_the_way(angle, speed, behind) -> None:
    way = np.array([np.cos(angle), np.sin(angle)])
    spread = np.sqrt(way @ S @ way)
    after = accumulated_lag(1.0, -behind * spread * way, S, speed * way)
    assert np.isclose(after, max(0.0, 1.0 + behind - ALLOWANCE))


def test_chance_seldom_sums_up() -> None:
    rng = np.random.default_rng(0)
    lag, alarms = 0.0, 0
    for residual in rng.standard_normal((2000, 2)) @ np.sqrt(S):
        lag = accumulated_lag(lag, residual, S, FORWARD)
        if lag > 5.0:
            lag, alarms = 0.0, alarms + 1
    assert alarms <= 5


@given(ago=st.floats(0.0, 1.0), turned=st.booleans())
def test_both_ways_of_going_lie_one_standard_deviation_off_their_mean(ago, turned) -> None:
    state = np.array([0.3, -0.2, 0.08, -0.05])
    prior = 1e-8 * np.eye(4)
    way = np.concatenate([ago * state[2:], state[2:]])
    spread = perhaps_turned(state, prior, ago)
    offset = way if turned else -way
    assert np.isclose(offset @ np.linalg.solve(spread, offset), 1.0, atol=1e-3)
    assert np.array_equal(spread, spread.T)
