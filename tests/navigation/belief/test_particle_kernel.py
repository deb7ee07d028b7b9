"""Compiled against plain Python, and against formulas over whole arrays."""

import numpy as np
import pytest

from navigation.belief import particle_kernel as kernel


@pytest.fixture
def cloud():
    """Positions, velocities, weights; points and their variance."""
    rng = np.random.default_rng(0)
    positions, velocities = rng.normal(0, 0.3, (16, 2)), rng.normal(0, 0.1, (16, 2))
    z, variance = rng.normal(0, 0.3, (5, 2)), rng.uniform(1e-4, 1e-2, 5)
    return positions, velocities, rng.dirichlet(np.ones(16)), z, variance


def test_compiled_and_plain_agree(cloud):
    positions, velocities, weights, z, variance = cloud
    rates = weights - 0.06
    bends, draws, wander = velocities[:, 0].copy(), weights, (0.9, 0.1)
    for function, arguments in (
        (kernel.advance, (positions, velocities, rates, bends, draws, wander, 0.05, 0.1)),
        (kernel.moments, (positions, velocities, weights)),
        (kernel.costs, (positions, weights, z, variance, 0.03, positions[0], 0.4, 0.2)),
    ):
        result, plain = function(*arguments), function.py_func(*arguments)
        for a, b in zip(result, plain, strict=True):
            assert np.allclose(a, b, rtol=1e-12, atol=1e-15)


def test_only_drawn_particles_reverse(cloud):
    positions, velocities, *_ = cloud
    draws = np.linspace(0, 1, 16, endpoint=False)
    straight = np.zeros(16)
    moved, turned, _ = kernel.advance(
        positions, velocities, straight, straight, draws, (1.0, 0.0), 0.25, 0.5
    )
    sign = np.where(draws < 0.25, -1.0, 1.0)[:, None]
    assert turned == pytest.approx(sign * velocities)
    assert moved == pytest.approx(positions + 0.5 * sign * velocities)


def test_a_reversed_particle_returns_on_its_path(cloud):
    positions, velocities, weights, *_ = cloud
    rates, never, always = 20.0 * (weights - 0.06), np.ones(16), np.zeros(16)
    there = kernel.advance(positions, velocities, rates, never, never, (1.0, 0.0), 0.5, 0.1)
    assert np.hypot(*there[1].T) == pytest.approx(np.hypot(*velocities.T))
    assert np.array_equal(there[2], rates)
    back = kernel.advance(*there, never, always, (1.0, 0.0), 0.5, 0.1)
    assert back[0] == pytest.approx(positions)
    assert back[1] == pytest.approx(-velocities)
    assert back[2] == pytest.approx(-rates)


def test_turn_rates_are_autocorrelated_noise(cloud):
    positions, velocities, weights, *_ = cloud
    rates, bends, never = weights - 0.06, velocities[:, 0].copy(), np.ones(16)
    _, _, after = kernel.advance(positions, velocities, rates, bends, never, (0.9, 0.1), 0.5, 0.1)
    assert after == pytest.approx(0.9 * rates + 0.1 * bends)


def test_the_moments_are_those_of_weighted_samples(cloud):
    positions, velocities, weights, *_ = cloud
    values = np.hstack([positions, velocities])
    mean, covariance = kernel.moments(positions, velocities, weights)
    assert mean == pytest.approx(weights @ values)
    assert covariance == pytest.approx(np.cov(values.T, aweights=weights, ddof=0))
    assert np.array_equal(covariance, covariance.T)


def test_the_likelihood_is_a_kernel_density_mixed_with_a_uniform_one(cloud):
    positions, _, weights, z, variance = cloud
    off = positions - weights @ positions
    scott = 0.5 * (weights @ np.sum(off * off, axis=1)) * (weights @ weights) ** (1 / 3)
    wide = variance + scott + 0.03**2
    square = np.sum((positions[:, None] - z) ** 2, axis=2)
    density = weights @ (np.exp(-0.5 * square / wide) / wide)
    reach, uniform = 0.4, 0.2
    flat = uniform * 2.0 / reach**2 * (np.hypot(*(z - z[0]).T) < reach)
    wanted = -2.0 * np.log((1.0 - uniform) * density + flat)
    result = kernel.costs(positions, weights, z, variance, 0.03, z[0], reach, uniform)
    assert result == pytest.approx(wanted)
    assert 1 < np.count_nonzero(flat) < 5
