import numpy as np
import pytest
from scipy.stats import multivariate_normal

from navigation.belief import imm, imm_kernel
from navigation.belief.imm import Modes
from navigation.belief.imm_kernel import FORWARD, REVERSED, STATIC
from navigation.parameters.belief import TrackingParameters

P = TrackingParameters()
DT = 0.06
R = np.diag([1e-4, 2e-4])


def one(moving=0.5, z=(1.0, 0.0), R=R):
    modes = imm.initial(np.array(z), R, moving, P)
    return Modes(*(a[None] for a in modes))


def watch(modes, positions, R=R, rng=None):
    """Frames with a detection at each place."""
    for position in positions:
        modes = imm.predict(modes, DT, P)
        z = np.array([position]) + (0.0 if rng is None else rng.multivariate_normal((0, 0), R))
        imm_kernel.update(*modes, np.array([0]), z, R[None], P.max_log_ratio)
    return modes


def line(seconds, velocity, start=(1.0, 0.0)):
    steps = np.arange(1, round(seconds / DT) + 1)[:, None]
    return np.array(start) + DT * steps * np.array(velocity)


@pytest.mark.parametrize("seed", range(10))
def test_mode_probabilities_separate_static_from_moving_obstacles(seed):
    rng = np.random.default_rng(seed)
    still = watch(one(), line(2.0, (0.0, 0.0)), rng=rng)
    moving = watch(one(), line(1.0, (0.06, 0.05)), rng=rng)
    assert still.moving[0] < 0.2
    assert moving.moving[0] > 0.95


def test_a_reversal_shows_within_three_frames():
    before = watch(one(), line(2.0, (0.1, 0.0)))
    mean, _ = imm_kernel.moments(*(a[0] for a in before))
    assert mean[2] == pytest.approx(0.1, abs=0.01)
    after = watch(before, line(3 * DT, (-0.1, 0.0), mean[:2]))
    mean, _ = imm_kernel.moments(*(a[0] for a in after))
    assert mean[2] < 0.0


def test_a_reversal_out_of_sight_is_weighed_against_going_on():
    modes = watch(one(), line(2.0, (0.1, 0.0)))
    for _ in range(50):
        modes = imm.predict(modes, DT, P)
    on, back = (modes.states[0, m, 0] for m in (FORWARD, REVERSED))
    assert back < 1.2 < on
    assert modes.weights[0, REVERSED] == pytest.approx(0.5 - 0.5 * np.exp(-2 * 3 / 12), abs=0.03)
    assert modes.covariances[0, REVERSED, 0, 0] > 4 * modes.covariances[0, FORWARD, 1, 1]
    observed = watch(modes, [(1.15, 0.0)])
    assert observed.weights[0, REVERSED] > 0.7
    later = watch(observed, line(0.5, (-0.1, 0.0), (1.15, 0.0)))
    assert later.weights[0, REVERSED] > 0.95


def test_mirrored_worlds_have_mirrored_filters():
    flip = np.array([1.0, -1.0, 1.0, -1.0, -1.0])
    positions = np.random.default_rng(3).normal((1.0, 0.2), 0.05, (40, 2))
    plain = watch(one(z=(1.0, 0.2)), positions)
    mirrored = watch(one(z=(1.0, -0.2)), positions * flip[:2])
    assert np.allclose(mirrored.weights, plain.weights)
    assert np.allclose(mirrored.states, plain.states * flip)
    assert np.allclose(mirrored.covariances, plain.covariances * np.outer(flip, flip))


def test_covariances_stay_positive_definite_over_100000_updates():
    """400 obstacles, 250 looks each: precise, coarse and needle-shaped, after any gap."""
    rng = np.random.default_rng(4)
    n = 400
    z = rng.uniform(-2, 2, (n, 2))
    start = [imm.initial(p, R, 0.4, P) for p in z]
    modes = Modes(*(np.stack(parts) for parts in zip(*start, strict=True)))
    for _ in range(250):
        modes = imm.predict(modes, float(rng.choice([DT, DT, 0.5, 20.0])), P)
        sigma = 10.0 ** rng.uniform(-3.5, -0.5, (n, 2))
        turn = rng.uniform(-np.pi, np.pi, n)
        c, s = np.cos(turn), np.sin(turn)
        Q = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
        noise = Q @ (sigma[:, :, None] ** 2 * np.eye(2)) @ np.swapaxes(Q, 1, 2)
        z = z + rng.normal(0, 0.03, (n, 2))
        imm_kernel.update(*modes, np.arange(n), z, noise, P.max_log_ratio)
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
        changed = imm.predict(only(mode), dt, p).weights[0]
        assert changed == pytest.approx(wanted, abs=1e-9)
        assert imm.predict(only(mode), dt, p).moving[0] == pytest.approx(1 - wanted[0])


def test_a_new_obstacle_has_no_velocity_and_as_much_doubt_about_it_as_is_given():
    p = TrackingParameters(velocity_sigma=0.15, turn_rate_sigma=0.25)
    modes = imm.initial(np.array([1.0, 2.0]), R, 0.3, p)
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
        imm_kernel.update(*corrected, np.array([0]), z, R[None], limit)
        after = corrected.weights[0]
        assert np.log(after[STATIC] / after[FORWARD]) == pytest.approx(min(ratio, limit), abs=1e-4)
        assert after.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("turn", [-0.3, 0.0, 0.2])
def test_a_turn_rate_is_estimated(turn):
    """After four seconds of looks at what walks a circle at 0.1 m/s."""
    angle = turn * DT * np.arange(round(4.0 / DT) + 1)
    direction = 0.1 * DT * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    positions = np.array([1.0, 0.0]) + np.cumsum(direction, axis=0)
    modes = watch(one(), positions, R=1e-5 * np.eye(2))
    assert modes.states[0, FORWARD, 4] == pytest.approx(turn, abs=0.05)
    later = modes
    for _ in range(round(1.0 / DT)):
        later = imm.predict(later, DT, P)
    ahead = angle[-1] + turn * DT * np.arange(1, round(1.0 / DT) + 1)
    met = positions[-1] + 0.1 * DT * np.array([np.cos(ahead).sum(), np.sin(ahead).sum()])
    assert later.states[0, FORWARD, :2] == pytest.approx(met, abs=0.01)


def test_only_detected_obstacles_are_corrected():
    both = Modes(*(np.repeat(a, 2, axis=0) for a in one()))
    z = np.array([[1.01, 0.0]])
    imm_kernel.update(*both, np.array([1]), z, R[None], P.max_log_ratio)
    observed = one()
    imm_kernel.update(*observed, np.array([0]), z, R[None], P.max_log_ratio)
    for parts, before, after in zip(both, one(), observed, strict=True):
        assert np.array_equal(parts, np.concatenate([before, after]))


def test_obstacles_join_the_rows_and_leave_them():
    first, second = (imm.initial(np.array([x, 0.0]), R, 0.4, P) for x in (1.0, 2.0))
    both = imm.empty().append([first]).append([second])
    for row, one_ in enumerate((first, second)):
        for result, wanted in zip(both.at(row), one_, strict=True):
            assert np.array_equal(result, wanted)
    for result, wanted in zip(both.at(np.array([False, True])), second, strict=True):
        assert np.array_equal(result, wanted[None])
    both.at(0).states[:] = 0.0
    assert not both.states[0].any()
