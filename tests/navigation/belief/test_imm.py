from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter
from scipy.stats import multivariate_normal

from compilation.record import record
from navigation.belief import imm, mode_filter
from navigation.belief.imm import FORWARD, REVERSED, STATIC
from navigation.parameters.belief import TrackingParameters

P = TrackingParameters()
STOP, KEEP, TURN = [1.0, 1.0, 0.0, 0.0, 0.0], 5 * [1.0], [1.0, 1.0, -1.0, -1.0, -1.0]
CHANGES = np.array([[STOP, STOP, STOP], [STOP, KEEP, TURN], [STOP, TURN, KEEP]])
DT = 0.06
R = np.diag([1e-4, 2e-4])


class Modes(NamedTuple):
    """Filters of obstacles."""

    weights: np.ndarray
    states: np.ndarray
    covariances: np.ndarray

    @property
    def moving(self):
        return 1.0 - self.weights[..., STATIC]


def several(n, z, R, moving, p=P):
    """Filters of n obstacles after their first detections."""
    modes = Modes(np.zeros((n, 3)), np.zeros((n, 3, 5)), np.zeros((n, 3, 5, 5)))
    for k in range(n):
        imm.initialize(*(part[k] for part in modes), z[k], R, moving, record(p)[0])
    return modes


def one(moving=0.5, z=(1.0, 0.0), R=R, p=P):
    return several(1, np.array([z]), R, moving, p)


def predict(modes, dt, p=P):
    """Predicted filters, new arrays."""
    later = Modes(*(part.copy() for part in modes))
    imm.predict(*later, dt, record(p)[0])
    return later


def update(modes, rows, z, R, limit=P.max_log_ratio):
    for k, row in enumerate(rows):
        imm.update(*(part[row] for part in modes), z[k], R[k], limit)


def test_covariances_stay_positive_definite_over_6000_updates():
    """100 obstacles, 60 looks each: precise, coarse and needle-shaped, after any gap."""
    rng = np.random.default_rng(4)
    n = 100
    z = rng.uniform(-2, 2, (n, 2))
    modes = several(n, z, R, 0.4)
    for _ in range(60):
        modes = predict(modes, float(rng.choice([DT, DT, 0.5, 20.0])))
        sigma = 10.0 ** rng.uniform(-3.5, -0.5, (n, 2))
        turn = rng.uniform(-np.pi, np.pi, n)
        c, s = np.cos(turn), np.sin(turn)
        Q = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
        noise = Q @ (sigma[:, :, None] ** 2 * np.eye(2)) @ np.swapaxes(Q, 1, 2)
        z = z + rng.normal(0, 0.03, (n, 2))
        update(modes, range(n), z, noise)
        C = modes.covariances
        assert np.array_equal(C, np.swapaxes(C, 2, 3))
        assert np.linalg.eigvalsh(C[:, FORWARD:]).min() > 0.0
        assert np.linalg.eigvalsh(C[:, STATIC, :2, :2]).min() > 0.0
        assert np.allclose(modes.weights.sum(axis=1), 1.0)


def only(mode, velocity=(0.0, 0.0)):
    """An obstacle known to be in one mode."""
    modes = one()
    modes.weights[0] = np.maximum(np.eye(3)[mode], 1e-12)
    modes.states[0, :, 2:4] = velocity
    return modes


def test_modes_change_at_their_rates():
    p, dt = TrackingParameters(reversal_rate=0.2, start_rate=0.1, stop_rate=0.3), 0.7
    starts, stops = 1.0 - np.exp(-0.1 * dt), 1.0 - np.exp(-0.3 * dt)
    turns = 0.5 * (1.0 - np.exp(-2 * 0.2 * dt)) * (1.0 - stops)
    goes_on = 1.0 - stops - turns
    for mode, wanted in (
        (STATIC, [1.0 - starts, starts, 0.0]),
        (FORWARD, [stops, goes_on, turns]),
        (REVERSED, [stops, turns, goes_on]),
    ):
        changed = predict(only(mode), dt, p).weights[0]
        assert changed == pytest.approx(wanted, abs=1e-9)
        assert predict(only(mode), dt, p).moving[0] == pytest.approx(1 - wanted[0])


def test_a_new_obstacle_has_no_velocity_and_as_much_doubt_about_it_as_is_given():
    p = TrackingParameters(velocity_sigma=0.15, turn_rate_sigma=0.25)
    modes = Modes(*(part[0] for part in one(0.3, (1.0, 2.0), p=p)))
    assert modes.weights == pytest.approx([0.7, 0.3, 0.0], abs=1e-5)
    assert modes.weights.sum() == pytest.approx(1.0)
    assert modes.weights.min() > 0.0
    for mode, moves in ((STATIC, 0.0), (FORWARD, 1.0), (REVERSED, 1.0)):
        assert modes.states[mode] == pytest.approx([1.0, 2.0, 0.0, 0.0, 0.0])
        doubt = np.array([0.15, 0.15, 0.25]) ** 2 * moves
        assert modes.covariances[mode] == pytest.approx(np.diag([1e-4, 2e-4, *doubt]))


def test_one_look_changes_the_odds_by_the_likelihoods_but_no_more_than_the_limit():
    modes = one()
    modes.states[0, FORWARD, 0] += 0.02
    modes.weights[0] = 0.5, 0.5 - 1e-6, 1e-6
    z = np.array([[1.0, 0.0]])
    still, on = (
        multivariate_normal(modes.states[0, m, :2], modes.covariances[0, m, :2, :2] + R)
        for m in (STATIC, FORWARD)
    )
    ratio = still.logpdf(z[0]) - on.logpdf(z[0])
    assert 0.1 < ratio < 2.0
    for limit in (10.0, 0.5 * ratio):
        corrected = Modes(*(a.copy() for a in modes))
        update(corrected, [0], z, R[None], limit)
        after = corrected.weights[0]
        assert np.log(after[STATIC] / after[FORWARD]) == pytest.approx(min(ratio, limit), abs=1e-4)
        assert after.sum() == pytest.approx(1.0)


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
    inner[:, imm.STATIC, FORWARD, (2, 3, 4), (2, 3, 4)] += (variance, variance, turning)
    p = replace(P, velocity_sigma=variance**0.5, turn_rate_sigma=turning**0.5)
    actual = imm.mix(weights, states, covariances, rates, dt, record(p)[0])
    assert actual[0] == pytest.approx(joint.sum(axis=1))
    assert actual[1] == pytest.approx(mean)
    assert actual[2] == pytest.approx(np.einsum("nij,nijab->njab", share, inner))


def move(states, covariances, dt, q=0.0, diffusion=0.0, keep=1.0, turn_variance=0.0):
    """Predict by `imm.move`; `keep` is the autocorrelation of the turn rate after `dt`."""
    p = replace(
        P,
        acceleration_noise=q,
        static_diffusion=diffusion,
        turn_rate_time=np.inf if keep == 1.0 else -dt / np.log(keep),
        turn_rate_sigma=turn_variance**0.5,
    )
    imm.move(states, covariances, dt, record(p)[0])


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
        move(x, P, dt, q, 1e-6)
        likelihood = mode_filter.correct(x[0, FORWARD], P[0, FORWARD], z, R)
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
    move(moved, spread, 0.5, 0.03, 2e-3, 0.9, 0.04)
    assert np.array_equal(moved[:, 0], states[:, 0])
    grown = np.broadcast_to(np.diag([1e-3, 1e-3, 0.0, 0.0, 0.0]), (4, 5, 5))
    assert spread[:, 0] - covariances[:, 0] == pytest.approx(grown)


def moved(x, dt, keep=1.0):
    """One state, carried on."""
    states = np.tile(np.array(x, float), (1, 3, 1))
    move(states, np.zeros((1, 3, 5, 5)), dt, keep=keep)
    return states[0, FORWARD]


@pytest.mark.parametrize("turn", [0.0, 1e-4, 1.7e-3, -0.3, 2.0])
def test_doubt_follows_the_slope_of_the_motion(turn):
    """Column by column, against central differences."""
    x, dt, keep, step = np.array([0.3, -0.2, 0.1, 0.05, turn]), 0.7, 0.8, 1e-5
    for j in range(5):
        covariances = np.zeros((1, 3, 5, 5))
        covariances[..., j, j] = 1.0
        states = np.tile(x, (1, 3, 1))
        move(states, covariances, dt, keep=keep)
        off = step * np.eye(5)[j]
        slope = (moved(x + off, dt, keep) - moved(x - off, dt, keep)) / (2.0 * step)
        assert covariances[0, FORWARD] == pytest.approx(np.outer(slope, slope), abs=1e-9)


def test_predictions_add_up():
    _, states, covariances, *_ = drawn(2)
    once, twice = (states.copy(), covariances.copy()), (states.copy(), covariances.copy())
    move(*once, 1.0, diffusion=1e-4)
    move(*twice, 0.4, diffusion=1e-4)
    move(*twice, 0.6, diffusion=1e-4)
    assert np.allclose(once[0], twice[0])
    assert np.allclose(once[1], twice[1])


def test_turn_rates_of_movers_keep_their_spread():
    """The stationary variance of the turn rate is invariant."""
    states, covariances = np.zeros((1, 3, 5)), np.zeros((1, 3, 5, 5))
    states[..., 4], covariances[..., 4, 4] = 0.3, 0.04
    move(states, covariances, 2.0, keep=0.7, turn_variance=0.04)
    assert states[0, FORWARD, 4] == pytest.approx(0.21)
    assert covariances[0, FORWARD, 4, 4] == pytest.approx(0.04)


def test_costs_are_those_of_the_gaussian_mixture_up_to_their_constant():
    weights, states, covariances, z, R = drawn(3)
    actual = imm.costs(weights, states, covariances, z, R, np.inf)
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
    own = [imm.nis(states[k], covariances[k], z[k], R[k]) for k in range(4)]
    assert own == pytest.approx(np.diag(least))
    gate = np.median(least)
    gated = imm.costs(weights, states, covariances, z, R, gate)
    assert np.array_equal(np.isfinite(gated), least < gate)


@pytest.mark.parametrize("seed", range(3))
def test_the_moments_of_a_mover_are_those_of_the_mixture_of_both_moving_modes(seed):
    weights, states, covariances, *_ = drawn(seed)
    for k in range(4):
        fraction = weights[k, FORWARD:] / weights[k, FORWARD:].sum()
        mean, off = fraction @ states[k, FORWARD:], np.diff(states[k, FORWARD:], axis=0)[0]
        spread = np.einsum("m,mab->ab", fraction, covariances[k, FORWARD:])
        spread += fraction[0] * fraction[1] * np.outer(off, off)
        actual = imm.moments(weights[k], states[k], covariances[k])
        assert actual[0] == pytest.approx(mean)
        assert actual[1] == pytest.approx(spread)
        assert imm.mean(weights[k], states[k]) == pytest.approx(mean)
        assert imm.speed(weights[k], states[k]) == pytest.approx(np.hypot(*mean[2:4]))
