from math import exp, inf

import numpy as np
import pytest

from navigation.belief.correlated_noise import variance_inflation


def test_independent_measurements_keep_their_variance():
    assert variance_inflation(0.06, 0.0) == 1.0
    assert variance_inflation(inf, 0.1) == 1.0
    assert variance_inflation(5.0, 0.1) == pytest.approx(1.0)


def test_more_correlation_means_less_information():
    factors = [variance_inflation(dt, 0.1) for dt in (0.02, 0.06, 0.2, 1.0)]
    assert factors == sorted(factors, reverse=True)
    assert min(factors) >= 1.0


def test_is_the_variance_of_a_mean_of_autocorrelated_noise():
    dt, tau, n = 0.06, 0.1, 4000
    a = exp(-dt / tau)
    lags = np.arange(1, n)
    variance_of_mean = (1 + 2 * np.sum((1 - lags / n) * a**lags)) / n
    assert variance_inflation(dt, tau) / n == pytest.approx(variance_of_mean, rel=2e-3)
