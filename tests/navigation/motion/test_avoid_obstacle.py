from math import pi

import numpy as np
import pytest

from navigation.motion.avoid_obstacle import avoid_obstacle, spiral_turn
from navigation.parameters.motion import UnivectorParameters

S, D_E, D_B, K_R = np.array([0.3]), 0.2, 0.25, 0.3
CENTRE, TARGET = np.zeros((1, 2)), np.array([2.0, 0.0])


def field(points, centres=CENTRE, s=S, inside="zero", target=TARGET, **details):
    p = UnivectorParameters(d_e=D_E, d_b=D_B, k_r=K_R, inside=inside)
    return avoid_obstacle(np.asarray(points, float), target, centres, s, p, **details)


def test_outward_then_tangential_then_inward():
    assert spiral_turn(0.0, 0.3, D_E, K_R) == pytest.approx(0.0)
    assert spiral_turn(D_E, 0.3, D_E, K_R) == pytest.approx(pi / 2)
    assert spiral_turn(1e9, 0.3, D_E, K_R) == pytest.approx(pi, abs=1e-6)
    assert spiral_turn(0.05, 0.3, 0.2, 0.3) == pytest.approx(0.5 * pi * 0.5)
    assert spiral_turn(0.7, 0.3, 0.2, 0.3) == pytest.approx(0.5 * pi * (2.0 - 0.8 / 1.3))


def test_the_spiral_is_continuous_and_grows():
    gaps = np.linspace(0.0, 3.0, 30001)
    turn = spiral_turn(gaps, 0.3, D_E, K_R)
    assert np.all(np.diff(turn) > 0.0)
    assert np.abs(np.diff(turn[gaps > 0.01])).max() < 1e-2


def test_plus_circulates_counter_clockwise_on_the_shorter_side():
    # Left of the line to the target the shorter side is the left one: clockwise.
    left, right = field([[-0.4, 0.1], [-0.4, -0.1]])[:, 0]
    for point, u, sense in (((-0.4, 0.1), left, -1), ((-0.4, -0.1), right, 1)):
        circulation = point[0] * u[1] - point[1] * u[0]
        assert np.sign(circulation) == sense
    assert left == pytest.approx(right * [1, -1])


def test_it_is_a_unit_vector_where_it_acts():
    rng = np.random.default_rng(0)
    norm = np.hypot(*field(rng.uniform(-1, 1, (500, 2))).reshape(-1, 2).T)
    assert np.all(np.isclose(norm, 1.0) | (norm == 0.0))
    assert 0 < (norm > 0).sum() < 500


def test_it_acts_in_its_ring_before_the_target_and_ahead_only():
    ring = 0.3 + D_E + D_B
    assert not field([-ring - 1e-6, 0.0]).any()
    assert field([-ring + 0.01, 0.05]).any()
    assert not field([0.4, 0.0]).any()  # behind the robot
    assert not field([-0.4, 0.0], target=np.array([-1.0, 0.0])).any()
    beyond = np.array([[1.0, 0.0]])
    assert not field([0.3, 0.0], centres=beyond, target=np.array([0.39, 0.0])).any()


def test_inside_it_is_zero_as_printed_and_outward_in_extended():
    point = [-0.1, 0.05]
    assert not field(point).any()
    u = field(point, inside="outward")[0]
    assert u == pytest.approx(np.array(point) / np.hypot(*point))
    behind = field([0.1, 0.0], inside="outward")[0]
    assert behind == pytest.approx([1.0, 0.0])


def test_at_a_centre_the_given_direction_counts():
    u = field([0.002, 0.002], inside="outward", outward=np.array([1.2]))
    assert np.arctan2(u[0, 1], u[0, 0]) == pytest.approx(1.2)
    apart = field([0.02, 0.02], inside="outward", outward=np.array([1.2]))
    assert np.arctan2(apart[0, 1], apart[0, 0]) == pytest.approx(pi / 4)


def test_a_given_sign_overrides_the_shorter_side():
    for sign in (1, -1):
        point = np.array([-0.4, 0.1])
        u = field(point, signs=np.array([sign]))[0]
        assert np.sign(point[0] * u[1] - point[1] * u[0]) == sign


def test_an_obstacle_acts_as_far_as_its_radius_reaches_back_to_the_target():
    """The second condition: the path from the robot is longer than that from the obstacle."""
    target, point = np.array([1.0, 0.0]), np.array([0.0, 0.5])
    for x, acts in ((-0.1, True), (-0.6, False)):
        centre = np.array([[x, 0.6]])
        far = np.hypot(*(target - centre[0])) - np.hypot(*(target - point))
        assert (far <= S[0]) == acts
        u = field(point, centres=centre, target=target, abeam=True, inside="outward")
        assert u.any() == acts


def test_a_centre_exactly_abeam_acts_only_if_the_third_condition_is_waived():
    abeam = np.array([[0.0, 0.3]])
    assert not field([0.0, 0.0], centres=abeam).any()
    assert field([0.0, 0.0], centres=abeam, abeam=True)[0] == pytest.approx([0.0, -1.0])
    behind_target = np.array([[3.0, 0.3]])
    assert not field([2.2, 0.0], centres=behind_target, abeam=True).any()


def test_rigid_motion_moves_the_field_along(rotation):
    rng = np.random.default_rng(3)
    points, centres = rng.uniform(-1, 1, (100, 2)), rng.uniform(-1, 1, (5, 2))
    s, r, shift = rng.uniform(0.1, 0.3, 5), rotation(0.6), np.array([1.0, 4.0])
    u = field(points, centres, s, "outward")
    moved = field(points @ r.T + shift, centres @ r.T + shift, s, "outward", r @ TARGET + shift)
    assert moved == pytest.approx(u @ r.T, abs=1e-9)
