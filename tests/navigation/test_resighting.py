import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navigation.belief_parameters import TrackingParameters
from navigation.resighting import found_again, resight_mover
from navigation.track_filter import predict_moving

P = TrackingParameters()
R = np.eye(2) * 0.02**2
SEEN = np.array([0.0, 0.0])
V = np.array([0.1, 0.0])


def resight(gap, place, turn=0.0):
    c, s = np.cos(turn), np.sin(turn)
    M = np.array([[c, -s], [s, c]])
    start, covariance = found_again(SEEN, R, M @ V, 0.02)
    x, C = predict_moving(start[None], covariance[None], gap, P.acceleration_noise)
    z = M @ np.array(place)
    return resight_mover(x[0], C[0], (SEEN, gap), (z, R), P), M, z, C[0]


def test_found_where_expected_it_has_gone_on():
    (state, covariance), _, _, predicted = resight(3.0, (0.3, 0.0))
    assert np.allclose(state, [0.3, 0.0, 0.1, 0.0])
    assert np.linalg.eigvalsh(covariance - predicted)[0] > -1e-12


@pytest.mark.parametrize("along", [-0.29, -0.1])
def test_found_behind_on_its_line_it_has_turned_back(along):
    (state, covariance), _, z, _ = resight(3.0, (along, 0.02))
    assert np.allclose(state, [*z, -0.1, 0.0])
    assert covariance[2, 2] == pytest.approx(P.reversal_sigma**2)


def test_found_off_its_line_its_velocity_is_unknown():
    (state, covariance), _, z, _ = resight(3.0, (0.0, 0.5))
    assert np.allclose(state, [*z, 0.0, 0.0])
    assert covariance[2, 2] == pytest.approx(P.resighting_sigma**2)


def test_after_a_short_gap_noise_is_not_taken_for_a_reversal():
    (state, _), _, _, _ = resight(0.4, (0.01, 0.0))
    assert np.allclose(state[2:], V)


@given(st.floats(-3.0, 3.0), st.floats(-0.5, 0.5), st.floats(-0.3, 0.3))
def test_is_the_same_in_every_direction(turn, along, aside):
    (plain, C), _, _, _ = resight(2.0, (along, aside))
    (turned, D), M, _, _ = resight(2.0, (along, aside), turn)
    both = np.kron(np.eye(2), M)
    assert np.allclose(turned, both @ plain, atol=1e-9)
    assert np.allclose(D, both @ C @ both.T, atol=1e-9)
    assert np.linalg.eigvalsh(D)[0] > 0


def test_a_mover_whose_velocity_was_given_up_is_found_again():
    start, covariance = found_again(SEEN, R, np.zeros(2), P.resighting_sigma)
    x, C = predict_moving(start[None], covariance[None], 1.0, P.acceleration_noise)
    state, widened = resight_mover(x[0], C[0], (SEEN, 1.0), (np.array([0.02, 0.01]), R), P)
    assert np.isfinite(state).all()
    assert np.linalg.eigvalsh(widened)[0] > 0
