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
