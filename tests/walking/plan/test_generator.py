"""Pattern generators: preview of the reference, tracking, and its relation to preview control."""

from math import cosh, exp, sinh

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import solve_discrete_are

from walking.data import Ramp
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold
from walking.plan.generator import advance_pendulum
from walking.plan.pendulum import dcm_reference
from walking.plan.reference import set_ramp
from walking.plan.support import clip, support_region

LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.0), Foothold(False, 0.0, -0.042, 0.0)


class Tracker:
    """Pendulum of the default generator between two parallel feet."""

    def __init__(self, model, make_walk, x, y, vy=0.0):
        self.robot = model.robot
        self.walk = make_walk()
        self.plan, self.pendulum = self.walk.plan, self.walk.pendulum
        p = self.pendulum
        p.x, p.y, p.vy, p.zmp_x, p.zmp_y = x, y, vy, x, y
        self.region = support_region(model.robot.support, RIGHT, LEFT, 0.005)

    def advance(self, ramps):
        self.plan.ramps[: len(ramps)], self.plan.ramp_count = ramps, len(ramps)
        advance_pendulum(self.walk, self.region, self.robot)
        zmp = (self.pendulum.zmp_x, self.pendulum.zmp_y)
        assert clip(self.region, *zmp) == zmp


def shift(ticks, start, end):
    """Shift of the ZMP, then rest."""
    ramps = np.zeros(2, Ramp)
    set_ramp(ramps[0], ticks, start, end, RIGHT, LEFT)
    set_ramp(ramps[1], 200, end, end, RIGHT, LEFT)
    return ramps


def test_a_displaced_pendulum_comes_to_rest_over_the_reference(model, make_walk):
    tracker = Tracker(model, make_walk, 0.02, 0.01, 0.05)
    for _ in range(400):
        tracker.advance(shift(1, (0.01, 0.0), (0.01, 0.0)))
    p = tracker.pendulum
    np.testing.assert_allclose([p.x, p.y, p.vx, p.vy], [0.01, 0.0, 0.0, 0.0], atol=2e-4)


def test_the_dcm_of_a_reference_is_its_infinite_preview_sum(model):
    omega, time = float(model.robot.omega), 40 * CONTROL_PERIOD

    def weighted(s):
        return omega * exp(-omega * s) * (0.05 * min(s / time, 1.0) - 0.02)

    preview = quad(weighted, 0.0, time)[0] + quad(weighted, time, np.inf)[0]
    dcm = dcm_reference(shift(40, (-0.02, 0.0), (0.03, 0.0)), model.robot)
    assert dcm == pytest.approx((preview, 0.0), abs=1e-9)


def test_preview_control_without_weight_on_the_rate_is_dcm_tracking_with_gain_two(model):
    """Kajita et al., ICRA 2003: the cart-table with state (x, x', p) and input p⁺ - p."""
    w = float(model.robot.omega)
    c, s, growth = cosh(w * CONTROL_PERIOD), sinh(w * CONTROL_PERIOD), exp(w * CONTROL_PERIOD)
    A = np.array([[c, s / w, 1.0 - c], [w * s, c, -w * s], [0.0, 0.0, 1.0]])
    B, Q, R = A[:, 2:] * [[1.0], [1.0], [1.0]], np.diag([0.0, 0.0, 1.0]), np.array([[1e-9]])
    P = solve_discrete_are(A, B, Q, R)
    feedback = np.array([0.0, 0.0, 1.0]) - np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A)[0]
    # The gain tends to 2 with the tick.
    gain = 1.0 + 1.0 / growth
    assert feedback == pytest.approx([gain, gain / w, 0.0], abs=1e-4)
