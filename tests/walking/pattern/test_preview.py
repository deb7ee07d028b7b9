"""Gains of Kajita's regulator."""

import numpy as np
import pytest

from walking.parameters import PatternParameters
from walking.pattern.lipm import Lipm
from walking.pattern.preview import preview_gains

LIPM = Lipm(0.19)
GAINS = preview_gains(LIPM, PatternParameters(preview_time=2.0))


def test_preview_weights_fade_and_are_complete_within_the_horizon():
    weights = np.diff(GAINS.sums)
    assert weights[0] > 0.0
    assert abs(weights[-1]) < 1e-4 * weights.max()
    assert GAINS.sums[-1] == pytest.approx(GAINS.total, rel=1e-3)


def test_moments_are_the_weighted_sums():
    weights = np.diff(GAINS.sums)
    expected = np.cumsum(weights * np.arange(1, len(weights) + 1))
    np.testing.assert_allclose(GAINS.moments[1:], expected, atol=1e-12)


def test_a_body_at_rest_over_its_reference_stays():
    # u = -K z + total p_ref is zero for x = p = p_ref, v = 0.
    assert GAINS.position + GAINS.zmp == pytest.approx(GAINS.total)


def test_closed_loop_is_stable():
    columns = [LIPM.step(1.0, 0.0, 0.0), LIPM.step(0.0, 1.0, 0.0), LIPM.step(0.0, 0.0, 1.0)]
    A = np.eye(3)
    A[:2] = np.array(columns).T
    B = np.array([[A[0, 2]], [A[1, 2]], [1.0]])
    K = np.array([[GAINS.position, GAINS.velocity, GAINS.zmp]])
    assert np.abs(np.linalg.eigvals(A - B @ K)).max() < 1.0
