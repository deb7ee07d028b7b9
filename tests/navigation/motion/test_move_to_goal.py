from dataclasses import replace
from math import pi

import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.decision import Task
from navigation.motion.move_to_goal import ArrivalSide, arrival_gain, move_to_goal, muf
from navigation.motion.velocity_mapping import body_velocity
from navigation.parameters.motion import UnivectorParameters
from navigation.parameters.navigation import NavigationParameters

EXTENDED = UnivectorParameters()
PAPER = NavigationParameters.paper().univector
POSTURE = replace(EXTENDED, arrival="nposture")
ORIGIN = np.zeros(2)
ALL = [EXTENDED, PAPER, POSTURE]


def arrivals(p, limits, radius, r_goal=0.06, duration=60.0):
    """Heading errors at arrival of 192 starts, NaN for those that never arrive."""
    errors = []
    for goal_heading in np.arange(4) * pi / 2 + 0.3:
        bearing, heading = (
            a.ravel() for a in np.meshgrid(np.arange(16) * pi / 8, np.array([0.0, 2.0, 4.0]))
        )
        point = radius * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
        error = np.full(len(point), np.nan)
        body = np.zeros((len(point), 3))
        for step in range(round(duration / 0.085)):
            if step % 4 == 0:
                phi = move_to_goal(point, heading, ORIGIN, goal_heading, p)
                body = np.array([
                    body_velocity(a, 0.15, h, a, limits=limits, turn_gain=1.5)
                    for a, h in zip(phi.tolist(), heading.tolist(), strict=True)
                ])  # fmt: skip
            here = np.isnan(error) & (np.hypot(*point.T) < r_goal)
            error[here] = np.abs(wrap_array(heading - goal_heading))[here]
            middle = heading + 0.5 * body[:, 2] * 0.085
            c, s = np.cos(middle), np.sin(middle)
            point = point + 0.085 * np.stack(
                [c * body[:, 0] - s * body[:, 1], s * body[:, 0] + c * body[:, 1]], axis=1
            )
            heading = heading + 0.085 * body[:, 2]
        errors.append(error)
    return np.concatenate(errors)


@pytest.mark.parametrize("p", ALL, ids=["extended", "paper", "nposture"])
@pytest.mark.parametrize("radius", [1.0, 2.0])
def test_all_of_192_starts_arrive(p, limits, radius):
    errors = arrivals(p, limits, radius)
    assert len(errors) == 192
    assert not np.isnan(errors).any()
    straight = arrivals(replace(p, k_beta=-1e-9, arrival="hard"), limits, radius)
    assert np.median(errors) < 0.7 * np.median(straight)


@pytest.mark.parametrize("p", ALL)
def test_far_away_and_on_the_line_it_points_at_the_destination(p):
    rng = np.random.default_rng(0)
    if p.arrival != "nposture":
        for x, y in rng.normal(0, 3, (50, 2)).tolist():
            if np.hypot(x, y) > p.d_con:
                phi = move_to_goal((x, y), 0.3, ORIGIN, 1.0, p)
                assert phi == pytest.approx(np.arctan2(-y, -x))
    for rho in (0.1, 0.5, 1.5):
        point = -rho * np.array([np.cos(0.7), np.sin(0.7)])
        assert move_to_goal(point, 2.0, ORIGIN, 0.7, p) == pytest.approx(0.7)


@pytest.mark.parametrize("p", ALL)
def test_mirror_symmetry(p):
    rng = np.random.default_rng(1)
    places = rng.normal(0, 0.6, (200, 2))
    phi = move_to_goal(places, 0.4, ORIGIN, 0.9, p)
    mirrored = move_to_goal(places * [1, -1], -0.4, ORIGIN, -0.9, p)
    assert wrap_array(phi + mirrored) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("p", ALL)
def test_rigid_motion_moves_the_field_along(p, rotation):
    rng = np.random.default_rng(2)
    places, a = rng.normal(0, 0.6, (100, 2)), 1.1
    r = rotation(a)
    target, shift = np.array([0.2, -0.1]), np.array([5.0, 2.0])
    phi = move_to_goal(places, 0.4, target, 0.9, p)
    moved = move_to_goal(places @ r.T + shift, 0.4 + a, r @ target + shift, 0.9 + a, p)
    assert wrap_array(moved - phi - a) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])
def test_the_distance_never_grows(p):
    rng = np.random.default_rng(3)
    places = rng.uniform(-1, 1, (2000, 2))
    phi = move_to_goal(places, 0.0, ORIGIN, 0.5, p)
    inward = -(places * np.stack([np.cos(phi), np.sin(phi)], axis=1)).sum(axis=1)
    assert inward.min() >= -1e-12


def test_the_ramped_field_is_continuous_at_d_con():
    for bearing in np.linspace(-3.0, 3.0, 25).tolist():
        d = np.array([np.cos(bearing), np.sin(bearing)])
        inside = move_to_goal((EXTENDED.d_con - 1e-6) * d, 0.0, ORIGIN, 0.5, EXTENDED)
        outside = move_to_goal((EXTENDED.d_con + 1e-6) * d, 0.0, ORIGIN, 0.5, EXTENDED)
        assert abs(float(wrap_array(inside - outside))) < 1e-4


def leg(beta, index=0):
    """A task with `beta` at the origin."""
    return Task(np.array([1.0, 0.0]), beta, False, index, False, False)


def test_the_side_is_kept_while_beta_passes_pi():
    side = ArrivalSide(EXTENDED)
    betas = (1.0, 3.0, -3.1, -2.0, -1.7)
    assert [side.update(ORIGIN, leg(beta)) for beta in betas] == [0, 1, 1, 1, 0]
    point = np.array([0.3, 0.01])
    free = move_to_goal(point, 0.0, ORIGIN, 0.0, EXTENDED)
    held = move_to_goal(point, 0.0, ORIGIN, 0.0, EXTENDED, side=1)
    other = move_to_goal(point, 0.0, ORIGIN, 0.0, EXTENDED, side=-1)
    assert free in (pytest.approx(float(held)), pytest.approx(float(other)))
    assert held != pytest.approx(float(other))


def test_k_rho_falls_at_the_goal_only():
    p = replace(EXTENDED, slow_fraction=0.2, slow_distance=0.4)
    gains = [arrival_gain(d, True, p) for d in (0.0, 0.1, 0.4, 2.0)]
    assert gains == pytest.approx([0.2, 0.4, 1.0, 1.0])
    assert arrival_gain(0.0, False, p) == 1.0


@pytest.mark.parametrize("p", ALL)
def test_the_vector_has_the_direction_phi_and_is_zero_at_the_destination(p):
    places = np.random.default_rng(5).uniform(-1, 1, (50, 2))
    phi = move_to_goal(places, 0.0, ORIGIN, 0.5, p)
    u = muf(places, ORIGIN, phi)
    assert u == pytest.approx(np.stack([np.cos(phi), np.sin(phi)], axis=1))
    assert not muf(ORIGIN, ORIGIN, 0.5).any()


def test_the_printed_field_is_the_weighted_sum_of_both_angles():
    p = replace(PAPER, arrival="hard", k_alpha=0.6, k_beta=-0.4, d_con=1.0)
    point, heading, target_heading = (-0.3, -0.3), 0.2, 1.1  # the destination bears pi/4
    alpha, beta = pi / 4 - heading, target_heading - pi / 4
    phi = move_to_goal(point, heading, ORIGIN, target_heading, p)
    assert phi == pytest.approx(heading + 0.6 * alpha - 0.4 * beta)


def test_the_arrival_is_ramped_in_and_clamped():
    p = replace(
        EXTENDED, arrival="ramped", d_con=0.8, arrival_ramp=0.5, k_beta=-0.5, arrival_clamp=0.6
    )
    assert move_to_goal((-0.6, 0.0), 0.0, ORIGIN, 0.8, p) == pytest.approx(-0.5 * 0.8 * 0.5)
    assert move_to_goal((-0.4, 0.0), 0.0, ORIGIN, 0.8, p) == pytest.approx(-0.5 * 0.8)
    assert move_to_goal((-0.1, 0.0), 0.0, ORIGIN, 0.8, p) == pytest.approx(-0.5 * 0.8)
    assert move_to_goal((-0.1, 0.0), 0.0, ORIGIN, 2.0, p) == pytest.approx(-0.6)
    assert move_to_goal((-0.1, 0.0), 0.0, ORIGIN, -2.0, p) == pytest.approx(0.6)


def test_the_posture_field_turns_by_the_angle_to_the_point_beyond():
    p = replace(POSTURE, posture_gain=2.0, posture_offset=0.3)
    beyond = np.arctan2(0.3, 0.4)  # 0.4 m before the destination, 0.3 m to its left beyond
    phi = move_to_goal((-0.4, 0.0), 0.0, ORIGIN, pi / 2, p)
    assert phi == pytest.approx(-2.0 * beyond)


def test_each_side_is_set_and_forgotten():
    side = ArrivalSide(EXTENDED)
    assert [side.update(ORIGIN, leg(beta)) for beta in (-3.0, 3.1)] == [-1, -1]
    assert [side.update(ORIGIN, leg(beta, 1)) for beta in (2.0, 2.5)] == [0, 1]
    there = np.array([3.0, 2.0])
    moved = replace(leg(-3.0, 2), target=leg(-3.0).target + there)
    assert side.update(there, moved) == -1


@pytest.mark.parametrize("p", [PAPER, POSTURE])
def test_arrivals_that_are_not_ramped_in_have_no_side(p):
    side = ArrivalSide(p)
    assert [side.update(ORIGIN, leg(beta)) for beta in (3.0, -3.1)] == [0, 0]


def test_a_remembered_side_turns_a_whole_turn_the_other_way():
    p = replace(EXTENDED, arrival_clamp=10.0, k_beta=-0.5, arrival_ramp=0.5, d_con=0.8)
    point = (0.1, 0.0)  # beyond the destination, which bears pi
    for side, beta in ((1, 3.0), (-1, 3.0 - 2 * pi)):
        phi = move_to_goal(point, 0.0, ORIGIN, wrap_array(np.array(pi + 3.0)), p, side=side)
        assert wrap_array(phi - pi + 0.5 * beta) == pytest.approx(0.0, abs=1e-9)
