import numpy as np
import pytest

from navigation.confidence_gate import gate_points
from navigation.decision_parameters import GateParameters

P = GateParameters()


def test_the_points_lie_ahead_of_the_motion_in_any_frame():
    here = gate_points(np.zeros(3), 0.0, P)
    assert len(here) == 12
    assert here[:, 0].min() == pytest.approx(P.near)
    assert here[:, 0].max() == pytest.approx(P.far)
    assert np.abs(here[:, 1]).max() == pytest.approx(P.half_width)
    a, shift = 0.7, np.array([1.0, -2.0])
    r = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    there = gate_points(np.array([*shift, 3.0]), a, P)
    assert there == pytest.approx(here @ r.T + shift)
