"""Feed-forward offsets and rates."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.body import feedforward_kernel
from walking.parameters import CONTROL_PERIOD

ANKLES = np.array([54.0, 0.1, 4.0])
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
        feedforward_kernel.rates(now, before, velocity, *rest)
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
@given(SEEDS, st.sampled_from([0.0, 0.3, 1.0]), st.sampled_from([14, 26]))
def test_offsets_are_torques_and_rates_over_stiffness(seed, load, joints):
    rng = np.random.default_rng(seed)
    where = rng.permutation(joints) + 6
    forces = np.array([1.0, 2.0, 54.0, 0.3, -0.2, 0.1, *rng.normal(0.0, 1.0, joints)])
    velocity = rng.normal(0.0, 1.0, joints)
    servos = rng.uniform(0.01, 0.1, (3, joints))
    soles = ((0.01, 0.04), (0.02, -0.04))
    pelvis = tuple(rng.uniform(-0.1, 0.1, 3).tolist())
    legs = rng.normal(0.0, 1.0, (2, 6, 3)), rng.normal(0.0, 0.1, (2, 6, 3))
    rest = (pelvis, soles, load, 0.22, *legs)
    task, result = ((0.0, 0.0), np.zeros(3)), np.empty(joints)
    feedforward_kernel.offsets(forces, where, velocity, servos, *rest, task, ANKLES, result)
    unloaded = slice(0, 6) if load == 1.0 else slice(12, joints)
    expected = forces[where] * servos[0] + velocity * servos[1]
    np.testing.assert_allclose(result[unloaded], expected[unloaded], rtol=0.0, atol=1e-12)
    fractions = [abs(result - expected)[part].max() for part in (slice(0, 6), slice(6, 12))]
    assert [fraction > 1e-6 for fraction in fractions] == [load < 1.0, load > 0.0]


@pytest.mark.parametrize(
    ("axis", "shift", "sign"), [((0, 1, 0), (0.01, 0.0), 1), ((1, 0, 0), (0.0, 0.01), -1)]
)
def test_an_ankle_shifts_the_zmp_by_its_compliance(axis, shift, sign):
    axis, still = np.array(axis, float), np.zeros(3)
    offset = feedforward_kernel.ankle((shift, still), 0.0, 0.5, axis, 0.02, ANKLES)
    assert offset == pytest.approx(sign * 0.5 * 54.0 * 0.02 * 0.01)
    # The axis and the shift turn together.
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.array([c * axis[0] - s * axis[1], s * axis[0] + c * axis[1], 0.0])
    again = feedforward_kernel.ankle((shift, still), -0.7, 0.5, turned, 0.02, ANKLES)
    assert again == pytest.approx(offset)


@given(SEEDS)
def test_support_torques_are_the_virtual_work_of_the_force(robot, seed):
    # The joints do as much work on the foot as the floor takes, the base held still.
    rng = np.random.default_rng(seed)
    leg, step = robot.legs[0], 1e-6
    angles = leg.bent + rng.uniform(-0.3, 0.3, 6)
    force = tuple(rng.uniform(-1.0, 1.0, 3) * (8.0, 8.0, 30.0))
    foot = leg.pose(angles)
    axes, origins = leg.joints(angles)
    for k in range(6):
        ends = []
        for sign in (1.0, -1.0):
            moved = angles.copy()
            moved[k] += sign * step
            pose = leg.pose(moved)
            ends.append(np.array([pose.x, pose.y, pose.z]))
        motion = (ends[0] - ends[1]) / (2.0 * step)
        point = (foot.x, foot.y, foot.z)
        torque = feedforward_kernel.support_torque(axes[k], origins[k], point, force)
        assert torque == pytest.approx(-np.dot(force, motion), abs=1e-6)
