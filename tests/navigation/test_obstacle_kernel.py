"""Compiled against plain Python, and against the eigenvalues."""

import numpy as np
import pytest

from navigation import obstacle_kernel as kernel


def test_deviations_are_those_of_the_largest_eigenvalues():
    a = np.random.default_rng(0).normal(size=(50, 2, 2))
    p = a @ a.transpose(0, 2, 1)
    expected = np.sqrt(np.linalg.eigvalsh(p)[:, -1])
    both = np.zeros((50, 4, 4))
    both[:, :2, :2], both[:, 2:, 2:] = p, p[::-1]
    for deviations in (kernel.deviations, kernel.deviations.py_func):
        places, velocities = deviations(both)
        assert places == pytest.approx(expected)
        assert velocities == pytest.approx(expected[::-1])
