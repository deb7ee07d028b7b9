"""Equations (7)-(10) as printed, with the repairs of `navigation.paper`."""

from dataclasses import replace
from math import hypot, inf, pi

import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.motion.univector import normalized, unit_vectors
from navigation.paper import (
    WEIGHTS,
    Discs,
    PaperField,
    avoid_obstacle,
    move_to_goal,
)
from navigation.parameters.planner import PaperParameters

P = PaperParameters()
TARGET = np.array([2.0, 0.0])
BOTH = pytest.mark.parametrize("weights", ["printed", "exchanged"])


def still(*centres, radius=0.3):
    """Obstacles of (9) that are not virtual."""
    n = len(centres)
    return Discs(
        np.array(centres, float).reshape(n, 2), np.full(n, radius), np.zeros(n), np.zeros(n, bool)
    )


def u_auf(points, discs=None, target=TARGET, p=P):
    """Field of (9) of all obstacles."""
    discs = still((0.0, 0.0)) if discs is None else discs
    return avoid_obstacle(np.asarray(points, float), np.asarray(target, float), discs, p)


def angle(v):
    return np.arctan2(v[..., 1], v[..., 0])


# Equation (9)


def test_the_avoiding_field_is_outward_on_and_inside_the_circle():
    outward = unit_vectors(np.linspace(-3.0, 3.0, 60))
    outward = outward[outward[:, 0] < -0.01]  # the obstacle is ahead
    for rho in (0.3, 0.29, 0.1, 0.001):
        assert u_auf(rho * outward)[:, 0] == pytest.approx(outward)


def test_the_avoiding_field_is_tangential_at_the_offset_and_circulates_on_the_shorter_side():
    for y, sense in ((0.1, -1.0), (-0.1, 1.0)):
        out = normalized(np.array([-0.4, y]))
        u = u_auf((0.3 + P.d_e) * out)[0]
        assert u @ out == pytest.approx(0.0, abs=1e-6)
        assert out[0] * u[1] - out[1] * u[0] == pytest.approx(sense)


def test_the_avoiding_field_acts_in_its_ring_before_the_target_and_ahead_only():
    ring = 0.3 + P.d_e + P.d_b
    assert not u_auf([-ring - 1e-6, 0.0]).any()
    assert u_auf([-ring + 0.01, 0.05]).any()
    assert not u_auf([0.4, 0.0]).any()  # behind the robot
    assert not u_auf([-0.4, 0.0], target=(-1.0, 0.0)).any()
    assert not u_auf([0.3, 0.0], still((1.0, 0.0)), (0.39, 0.0)).any()  # beyond the target
    norm = np.hypot(*u_auf(np.random.default_rng(0).uniform(-1, 1, (500, 2))).reshape(-1, 2).T)
    assert np.all(np.isclose(norm, 1.0) | (norm == 0.0))


def test_an_obstacle_acts_as_far_as_its_radius_reaches_back_to_the_target():
    """Second condition: rho_rd + S_oe >= rho_od."""
    rng, target = np.random.default_rng(1), np.array([0.4, 0.0])
    acted = set()
    for centre, point in rng.uniform(-0.6, 0.9, (300, 2, 2)):
        p_or, p_rd = point - centre, target - point
        gap = hypot(*(target - centre)) - 0.3 - hypot(*p_rd)
        near = hypot(*p_or) <= 0.3 + P.d_e + P.d_b
        if near and p_or @ p_rd < 0.0 and abs(gap) > 1e-9:
            acts = bool(u_auf(point, still(centre), target).any())
            assert acts == (gap < 0.0)
            acted.add(acts)
    assert acted == {True, False}


def test_a_virtual_obstacle_acts_abeam_and_has_its_own_outward_direction_at_its_centre():
    def disc(virtual):
        return Discs(np.array([[0.0, 0.3]]), np.full(1, 0.3), np.full(1, 1.2), np.full(1, virtual))

    assert not u_auf([0.0, 0.0], disc(False)).any()
    assert u_auf([0.0, 0.0], disc(True))[0] == pytest.approx([0.0, -1.0])
    assert angle(u_auf([0.002, 0.302], disc(True))[0]) == pytest.approx(1.2)
    assert angle(u_auf([0.02, 0.32], disc(True))[0]) == pytest.approx(pi / 4)


# Equation (10)


@BOTH
def test_the_sum_weighs_the_goal_against_the_direction_of_all_obstacles(weights):
    p = replace(P, weights=weights)
    discs = still((0.3, 0.1), (0.2, -0.35))
    rng = np.random.default_rng(4)
    points = rng.uniform((-0.5, -0.5), (0.3, 0.5), (50, 2))
    u_muf = unit_vectors(move_to_goal(points, TARGET, 0.5, p))
    avoid = normalized(u_auf(points, discs, p=p).sum(axis=1))
    w_muf, w_auf = WEIGHTS[weights]
    total = PaperField(TARGET, 0.5, discs, p).at(points)
    assert total == pytest.approx(w_muf * u_muf + w_auf * avoid)
    assert np.hypot(*total.T).max() <= 1.0 + 1e-12


def test_the_printed_weights_turn_at_most_asin_one_third():
    """19.5 deg off the direction to the goal, whatever the obstacles."""
    rng, largest = np.random.default_rng(5), 0.0
    for _ in range(20):
        centres, points = rng.uniform(-1, 1, (6, 2)), rng.uniform(-1, 1, (200, 2))
        u = PaperField(TARGET, 0.5, still(*centres), P).at(points)
        turn = wrap_array(angle(u) - move_to_goal(points, TARGET, 0.5, P))
        largest = max(largest, float(np.abs(turn).max()))
    assert np.arcsin(1 / 3) - 0.01 < largest <= np.arcsin(1 / 3) + 1e-9


def test_exchanged_weights_pass_one_disc_on_the_line_of_fifteen_starts():
    p = replace(P, weights="exchanged")
    field = PaperField(TARGET, 0.0, still((0.0, 0.0)), p)
    point = np.array([(-1.5, y) for y in np.linspace(-0.7, 0.7, 15)])
    arrived, least = np.zeros(15, bool), np.full(15, inf)
    for _ in range(600):
        point = point + 0.01 * normalized(field.at(point)) * ~arrived[:, None]
        least = np.minimum(least, np.hypot(*point.T))
        arrived |= np.hypot(*(point - TARGET).T) < 0.05
    assert arrived.all()
    assert least.min() > 0.29
