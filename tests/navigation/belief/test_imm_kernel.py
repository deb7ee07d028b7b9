"""Compiled against plain Python, against filterpy, and against formulas over whole arrays."""

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter
from scipy.stats import multivariate_normal

from navigation.belief import imm_kernel as kernel

STOP, KEEP, TURN = [1.0, 1.0, 0.0, 0.0, 0.0], 5 * [1.0], [1.0, 1.0, -1.0, -1.0, -1.0]
CHANGES = np.array([[STOP, STOP, STOP], [STOP, KEEP, TURN], [STOP, TURN, KEEP]])
FORWARD, REVERSED = kernel.FORWARD, kernel.REVERSED


def random_covariances(rng, *shape):
    A = rng.standard_normal((*shape, shape[-1]))
    return A @ np.swapaxes(A, -1, -2) * 1e-3 + 1e-5 * np.eye(shape[-1])


def drawn(seed, n=4):
    """Weights, states and covariances of n obstacles; a position of each with its covariance."""
    rng = np.random.default_rng(seed)
    states = 0.1 * rng.standard_normal((n, 3, 5))
    z = 0.1 * rng.standard_normal((n, 2))
    weights = rng.dirichlet(np.ones(3), n)
    return weights, states, random_covariances(rng, n, 3, 5), z, random_covariances(rng, n, 2)


def change(seed):
    return np.random.default_rng(seed).dirichlet(np.ones(3), 3)


def after(function, arguments, changed):
    """What a function that works in place leaves of the arrays at `changed`."""
    copies = [a.copy() if isinstance(a, np.ndarray) else a for a in arguments]
    result = function(*copies)
    kept = [copies[i] for i in changed]
    return kept if result is None else [result, *kept]


def test_compiled_and_plain_agree():
    weights, states, covariances, z, R = drawn(0)
    one, rows = (weights[0], states[0], covariances[0]), np.array([2, 0])
    static = np.array([True, False, False, True])
    for function, arguments, changed in (
        (kernel.mix, (weights, states, covariances, change(1), 0.3, 5e-3, 0.04), ()),
        (kernel.predict, (states, covariances, 0.3, 0.02, 1e-4, 0.9, 0.04), (0, 1)),
        (kernel.nis, (states, covariances, rows, z, R), ()),
        (kernel.costs, (weights, states, covariances, z, R, 13.8), ()),
        (kernel.correct, (states[0, 1], covariances[0, 1], z[0], R[0]), (0, 1)),
        (kernel.update, (weights, states, covariances, rows, z, R, 6.0), (0, 1, 2)),
        (kernel.mean, one[:2], ()),
        (kernel.moments, one, ()),
        (kernel.positions, (weights, states, static), ()),
        (kernel.estimates, (weights, states, covariances, static, R, 0.04, 1e-5), ()),
    ):
        compiled = after(function, arguments, changed)
        plain = after(function.py_func, arguments, changed)
        for a, b in zip(compiled, plain, strict=True):
            for p, q in zip(a, b, strict=True) if isinstance(a, tuple) else [(a, b)]:
                assert np.allclose(p, q, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("seed", range(3))
def test_mixing_is_the_mixture_of_all_that_may_have_happened(seed):
    """The first two moments, over arrays; what turned is on average where it was."""
    weights, states, covariances, *_ = drawn(seed)
    dt, variance, turning, rates = 0.4, 5e-3, 0.04, change(seed)
    joint = weights[:, :, None] * rates
    share = joint / joint.sum(axis=1)[:, None]
    parts = states[:, :, None] * CHANGES
    forth = dt * states[:, FORWARD:, 2:4]
    parts[:, (FORWARD, REVERSED), (REVERSED, FORWARD), :2] += forth
    mean = np.einsum("nij,nija->nja", share, parts)
    spread = parts - mean[:, None]
    inner = covariances[:, :, None] * CHANGES[..., None] * CHANGES[..., None, :]
    inner = inner + spread[..., None] * spread[..., None, :]
    inner[:, (FORWARD, REVERSED), (REVERSED, FORWARD), :2, :2] += (
        forth[..., None] * forth[..., None, :] / 3.0
    )
    inner[:, kernel.STATIC, FORWARD, (2, 3, 4), (2, 3, 4)] += (variance, variance, turning)
    actual = kernel.mix(weights, states, covariances, rates, dt, variance, turning)
    assert actual[0] == pytest.approx(joint.sum(axis=1))
    assert actual[1] == pytest.approx(mean)
    assert actual[2] == pytest.approx(np.einsum("nij,nijab->njab", share, inner))


def test_without_turn_rate_it_is_the_kalman_filter_of_filterpy():
    rng = np.random.default_rng(0)
    dt, q = 0.06, 0.03
    x, P = rng.standard_normal((1, 3, 5)), random_covariances(rng, 1, 3, 5)
    x[..., 4] = P[..., 4, :] = P[..., 4] = 0.0
    kf = KalmanFilter(dim_x=4, dim_z=2)
    kf.x, kf.P = x[0, FORWARD, :4].copy(), P[0, FORWARD, :4, :4].copy()
    kf.F = np.eye(4) + dt * np.eye(4, k=2)
    kf.H = np.eye(2, 4)
    block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]) * q * q
    kf.Q = np.kron(block, np.eye(2))
    for _ in range(30):
        z, R = rng.standard_normal(2), random_covariances(rng, 2)
        kernel.predict(x, P, dt, q, 1e-6, 1.0, 0.0)
        likelihood = kernel.correct(x[0, FORWARD], P[0, FORWARD], z, R)
        kf.predict()
        kf.update(z, R=R)
        assert np.allclose(x[0, FORWARD], [*kf.x, 0.0], atol=1e-12)
        assert np.allclose(P[0, FORWARD, :4, :4], kf.P, atol=1e-12)
        assert not P[0, FORWARD, 4].any()
        assert likelihood - np.log(2 * np.pi) == pytest.approx(kf.log_likelihood)
        assert np.array_equal(P, np.swapaxes(P, 2, 3))


def test_a_static_obstacle_has_random_walk_noise_only():
    _, states, covariances, *_ = drawn(5)
    moved, spread = states.copy(), covariances.copy()
    kernel.predict(moved, spread, 0.5, 0.03, 2e-3, 0.9, 0.04)
    assert np.array_equal(moved[:, 0], states[:, 0])
    grown = np.broadcast_to(np.diag([1e-3, 1e-3, 0.0, 0.0, 0.0]), (4, 5, 5))
    assert spread[:, 0] - covariances[:, 0] == pytest.approx(grown)


def moved(x, dt, keep=1.0):
    """One state, carried on."""
    states = np.tile(np.array(x, float), (1, 3, 1))
    kernel.predict(states, np.zeros((1, 3, 5, 5)), dt, 0.0, 0.0, keep, 0.0)
    return states[0, FORWARD]


@pytest.mark.parametrize("turn", [0.0, 1e-4, 1.7e-3, -0.3, 2.0])
def test_doubt_follows_the_slope_of_the_motion(turn):
    """Column by column, against central differences."""
    x, dt, keep, step = np.array([0.3, -0.2, 0.1, 0.05, turn]), 0.7, 0.8, 1e-5
    for j in range(5):
        covariances = np.zeros((1, 3, 5, 5))
        covariances[..., j, j] = 1.0
        states = np.tile(x, (1, 3, 1))
        kernel.predict(states, covariances, dt, 0.0, 0.0, keep, 0.0)
        off = step * np.eye(5)[j]
        slope = (moved(x + off, dt, keep) - moved(x - off, dt, keep)) / (2.0 * step)
        assert covariances[0, FORWARD] == pytest.approx(np.outer(slope, slope), abs=1e-9)


@pytest.mark.parametrize("turn", [-0.4, 1e-6, 0.25])
def test_a_constant_turn_rate_gives_a_circle(turn):
    """At constant speed about a fixed point, and in the end back where it came from."""
    x = [0.5, -0.1, 0.08, 0.06, turn]
    centre = np.array([0.5 - 0.06 / turn, -0.1 + 0.08 / turn])
    for dt in (0.3, 2.0, 7.0):
        position, velocity = moved(x, dt)[:2], moved(x, dt)[2:4]
        assert np.hypot(*velocity) == pytest.approx(0.1)
        assert np.hypot(*(position - centre)) == pytest.approx(0.1 / abs(turn))
        assert velocity @ (position - centre) == pytest.approx(0.0, abs=1e-6)
    assert moved(x, 2.0 * np.pi / abs(turn)) == pytest.approx(x, abs=1e-8)


def test_predictions_add_up():
    _, states, covariances, *_ = drawn(2)
    once, twice = (states.copy(), covariances.copy()), (states.copy(), covariances.copy())
    kernel.predict(*once, 1.0, 0.0, 1e-4, 1.0, 0.0)
    kernel.predict(*twice, 0.4, 0.0, 1e-4, 1.0, 0.0)
    kernel.predict(*twice, 0.6, 0.0, 1e-4, 1.0, 0.0)
    assert np.allclose(once[0], twice[0])
    assert np.allclose(once[1], twice[1])


def test_turn_rates_of_movers_keep_their_spread():
    """The stationary variance of the turn rate is invariant."""
    states, covariances = np.zeros((1, 3, 5)), np.zeros((1, 3, 5, 5))
    states[..., 4], covariances[..., 4, 4] = 0.3, 0.04
    kernel.predict(states, covariances, 2.0, 0.0, 0.0, 0.7, 0.04)
    assert states[0, FORWARD, 4] == pytest.approx(0.21)
    assert covariances[0, FORWARD, 4, 4] == pytest.approx(0.04)


def test_costs_are_those_of_the_gaussian_mixture_up_to_their_constant():
    weights, states, covariances, z, R = drawn(3)
    actual = kernel.costs(weights, states, covariances, z, R, np.inf)
    least = np.empty((4, 4))
    for k in range(4):
        for m in range(4):
            gaussians = [
                multivariate_normal(x[:2], P[:2, :2] + R[m])
                for x, P in zip(states[k], covariances[k], strict=True)
            ]
            likelihood = weights[k] @ [2 * np.pi * g.pdf(z[m]) for g in gaussians]
            assert actual[k, m] == pytest.approx(-2 * np.log(likelihood + 1e-30))
            off = [(z[m] - g.mean, g.cov) for g in gaussians]
            least[k, m] = min(y @ np.linalg.solve(S, y) for y, S in off)
    assert kernel.nis(states, covariances, np.arange(4), z, R) == pytest.approx(np.diag(least))
    gate = np.median(least)
    gated = kernel.costs(weights, states, covariances, z, R, gate)
    assert np.array_equal(np.isfinite(gated), least < gate)


@pytest.mark.parametrize("seed", range(3))
def test_estimates_are_those_of_the_verdicts(seed):
    """Of the mixture of both moving modes, or of the static mode with its bias."""
    weights, states, covariances, _, best = drawn(seed)
    static = np.array([True, False, True, False])
    position, velocity, covariance, turn = kernel.estimates(
        weights, states, covariances, static, best, 0.04, 1e-5
    )
    for k in range(4):
        if static[k]:
            mean, spread = states[k, 0], covariances[k, 0, :4, :4].copy()
            spread[:2, :2] += 0.04 * best[k]
            spread[(2, 3), (2, 3)] = 1e-5
        else:
            share = weights[k, FORWARD:] / weights[k, FORWARD:].sum()
            mean, off = share @ states[k, FORWARD:], np.diff(states[k, FORWARD:], axis=0)[0, :4]
            spread = np.einsum("m,mab->ab", share, covariances[k, FORWARD:, :4, :4])
            spread += share[0] * share[1] * np.outer(off, off)
        assert position[k] == pytest.approx(mean[:2])
        assert velocity[k] == pytest.approx(mean[2:4])
        assert covariance[k] == pytest.approx(spread)
        assert turn[k] == pytest.approx(mean[4])
        moving = kernel.mean(weights[k], states[k])
        assert static[k] or moving == pytest.approx(mean)
    assert kernel.positions(weights, states, static) == pytest.approx(position)
