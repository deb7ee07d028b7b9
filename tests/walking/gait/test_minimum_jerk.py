"""Motion of minimum jerk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.gait.minimum_jerk import PEAK, minimum_jerk


@given(st.floats(0.0, 1.0))
def test_minimum_jerk_is_symmetric_in_time(fraction):
    assert minimum_jerk(fraction) + minimum_jerk(1.0 - fraction) == pytest.approx(1.0)


def test_minimum_jerk_starts_and_ends_at_rest_and_peaks_in_the_middle():
    fractions = np.linspace(0.0, 1.0, 2001)
    position = np.array([minimum_jerk(s) for s in fractions])
    speed, force = (
        np.gradient(position, fractions),
        np.gradient(np.gradient(position, fractions), fractions),
    )
    assert position[0] == 0.0
    assert position[-1] == 1.0
    assert speed.max() == pytest.approx(PEAK, rel=1e-4)
    assert abs(speed[[0, -1]]).max() < 1e-4
    assert abs(force[[0, -1]]).max() < 0.1
