"""Feed-forward offsets, rates and counter-swing of the arms."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.body import leg_kernel
from walking.parameters import CONTROL_PERIOD

LEGS = np.array([[0.0, 0.037, -0.02, 0.1, 0.1, 0.03], [0.0, -0.037, -0.02, 0.1, 0.1, 0.03]])
ANKLES = np.array([54.0, 20.0, 25.0, 0.1])
SEEDS = st.integers(0, 10**6)


def test_rates_are_quotients_of_differences():
    rng = np.random.default_rng(1)
    angles = rng.uniform(-0.1, 0.1, (3, 26))
    before, velocity = angles[0].copy(), np.zeros(26)
    motion = np.zeros(33), np.zeros(32), np.zeros(32)
    where = rng.permutation(26) + 7, rng.permutation(26) + 6
    for now in angles[1:]:
        inertia = np.array([0.5, 1000.0, CONTROL_PERIOD])
        rest = (*motion, *where, (1.0, 2.0, 0.0), (0.3, -0.2), inertia)
        leg_kernel.rates(now, before, velocity, *rest)
    np.testing.assert_allclose(velocity, (angles[2] - angles[1]) / CONTROL_PERIOD)
    np.testing.assert_array_equal(before, angles[2])
    q, v, a = motion
    np.testing.assert_array_equal(q[where[0]], angles[2])
    np.testing.assert_array_equal(v[where[1]], velocity)
    second = 0.5 * np.diff(angles, n=2, axis=0)[0] / CONTROL_PERIOD**2
    np.testing.assert_allclose(a[where[1]], second.clip(-1000.0, 1000.0))
    assert a[:6].tolist() == [0.3, -0.2, 0.0, 0.0, 0.0, 0.0]
    assert not q[:7].any()
    assert not v[:6].any()


@settings(max_examples=30)
@given(SEEDS, st.sampled_from([0.0, 0.3, 1.0]))
def test_offsets_are_torques_and_rates_over_stiffness(seed, load):
    rng = np.random.default_rng(seed)
    where = rng.permutation(26) + 6
    forces = np.array([1.0, 2.0, 54.0, 0.3, -0.2, 0.1, *rng.normal(0.0, 1.0, 26)])
    position, velocity = rng.uniform(-0.5, 0.5, 26), rng.normal(0.0, 1.0, 26)
    servos = np.array([rng.uniform(0.01, 0.1, 26), rng.uniform(0.0, 0.1, 26)])
    soles = ((0.01, 0.04), (0.02, -0.04))
    pelvis = tuple(rng.uniform(-0.1, 0.1, 3).tolist())
    rest = (pelvis, soles, load, 0.22, LEGS)
    task, result = ((0.1, -0.2), (0.0, 0.0), np.zeros(3)), np.empty(26)
    leg_kernel.offsets(forces, where, position, velocity, servos, *rest, task, ANKLES, result)
    unloaded = slice(0, 6) if load == 1.0 else slice(12, 26)
    expected = forces[where] * servos[0] + velocity * servos[1]
    np.testing.assert_allclose(result[unloaded], expected[unloaded], rtol=0.0, atol=1e-12)
    fractions = [abs(result - expected)[part].max() for part in (slice(0, 6), slice(6, 12))]
    assert [fraction > 1e-6 for fraction in fractions] == [load < 1.0, load > 0.0]
