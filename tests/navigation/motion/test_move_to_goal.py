"""Equation (8), in the reading of the default planner and in that of the paper."""

from dataclasses import replace
from functools import partial
from math import pi

import numpy as np
import pytest

from navigation import paper
from navigation.angles import wrap_array
from navigation.decision import Task
from navigation.motion.move_to_goal import arrival_gain, arrival_side, move_to_goal
from navigation.motion.velocity_mapping import body_velocity
from navigation.parameters.motion import UnivectorParameters
from navigation.parameters.planner import PaperParameters

DEFAULT = UnivectorParameters()
PAPER = PaperParameters(d_con=DEFAULT.d_con)
DIRECTIONS = {
    "default": partial(move_to_goal, parameters=DEFAULT),
    "paper": partial(paper.move_to_goal, p=PAPER),
}
EACH = pytest.mark.parametrize("direction", DIRECTIONS.values(), ids=DIRECTIONS.keys())
ORIGIN = np.zeros(2)


def straight(point, target, _):
    offset = target - point
    return np.arctan2(offset[..., 1], offset[..., 0])


def arrivals(direction, limits, radius=1.5, r_goal=0.06, duration=60.0):
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
                phi = direction(point, ORIGIN, goal_heading)
                body = np.array([
                    body_velocity(a, 0.15, h, a, limits=limits, turn_gain=1.5)
                    for a, h in zip(phi.tolist(), heading.tolist(), strict=True)
                ])  # fmt: skip
            here = np.isnan(error) & (np.hypot(*point.T) < r_goal)
            error[here] = np.abs(wrap_array(heading - goal_heading))[here]
            if not np.isnan(error).any():
                break
            middle = heading + 0.5 * body[:, 2] * 0.085
            c, s = np.cos(middle), np.sin(middle)
            point = point + 0.085 * np.stack(
                [c * body[:, 0] - s * body[:, 1], s * body[:, 0] + c * body[:, 1]], axis=1
            )
            heading = heading + 0.085 * body[:, 2]
        errors.append(error)
    return np.concatenate(errors)


@EACH
def test_all_of_192_starts_arrive(direction, limits):
    errors = arrivals(direction, limits)
    assert len(errors) == 192
    assert not np.isnan(errors).any()
    assert np.median(errors) < 0.7 * np.median(arrivals(straight, limits))


@EACH
def test_far_away_and_on_the_line_it_points_at_the_destination(direction):
    rng = np.random.default_rng(0)
    for point in rng.normal(0, 3, (50, 2)):
        if np.hypot(*point) > 0.8:
            assert direction(point, ORIGIN, 1.0) == pytest.approx(straight(point, ORIGIN, 1.0))
    for rho in (0.1, 0.5, 1.5):
        point = -rho * np.array([np.cos(0.7), np.sin(0.7)])
        assert direction(point, ORIGIN, 0.7) == pytest.approx(0.7)


@EACH
def test_the_distance_never_grows(direction):
    places = np.random.default_rng(3).uniform(-1, 1, (2000, 2))
    phi = direction(places, ORIGIN, 0.5)
    inward = -(places * np.stack([np.cos(phi), np.sin(phi)], axis=1)).sum(axis=1)
    assert inward.min() >= -1e-12


def test_the_default_field_is_continuous_at_d_con():
    for bearing in np.linspace(-3.0, 3.0, 25).tolist():
        d = np.array([np.cos(bearing), np.sin(bearing)])
        inside, outside = (
            move_to_goal((DEFAULT.d_con + e) * d, ORIGIN, 0.5, DEFAULT) for e in (-1e-6, 1e-6)
        )
        assert abs(float(wrap_array(inside - outside))) < 1e-4


def test_the_printed_field_turns_by_its_gain_within_d_con():
    p = replace(PAPER, k_beta=-0.4, d_con=1.0)
    for rho, gain in ((0.99, -0.4), (0.3, -0.4), (1.01, 0.0)):
        point = -rho * np.array([np.cos(0.8), np.sin(0.8)])
        phi = paper.move_to_goal(point, ORIGIN, 1.1, p)
        assert phi == pytest.approx(0.8 + gain * (1.1 - 0.8))


def test_the_arrival_is_ramped_in_and_clamped():
    p = replace(DEFAULT, d_con=0.8, arrival_ramp=0.5, k_beta=-0.5, arrival_clamp=0.6)
    for x, heading, expected in (
        (-0.6, 0.8, -0.5 * 0.8 * 0.5),
        (-0.4, 0.8, -0.5 * 0.8),
        (-0.1, 0.8, -0.5 * 0.8),
        (-0.1, 2.0, -0.6),
        (-0.1, -2.0, 0.6),
    ):
        assert move_to_goal((x, 0.0), ORIGIN, heading, p) == pytest.approx(expected)


def test_k_rho_falls_at_the_goal_only():
    p = replace(DEFAULT, slow_fraction=0.2, slow_distance=0.4)
    gains = [arrival_gain(d, True, p) for d in (0.0, 0.1, 0.4, 2.0)]
    assert gains == pytest.approx([0.2, 0.4, 1.0, 1.0])
    assert arrival_gain(0.0, False, p) == 1.0


def leg(beta):
    """A task with `beta` at the origin."""
    return Task(np.array([1.0, 0.0]), beta, False, 0, False, False)


def sides(betas, side=0):
    result = []
    for beta in betas:
        side = arrival_side(ORIGIN, leg(beta), side, DEFAULT)
        result.append(side)
    return result


def test_the_side_is_kept_while_beta_passes_pi():
    assert sides((1.0, 3.0, -3.1, -2.0, -1.7)) == [0, 1, 1, 1, 0]
    assert sides((-1.0, -3.0, 3.1, 2.0, 1.7)) == [0, -1, -1, -1, 0]
    assert sides((2.0, 2.2, 2.0)) == [0, 0, 0]  # not beyond the upper threshold


def test_a_remembered_side_turns_a_whole_turn_the_other_way():
    p = replace(DEFAULT, arrival_clamp=10.0, k_beta=-0.5, arrival_ramp=0.5, d_con=0.8)
    point = (0.1, 0.0)  # beyond the destination, which bears pi
    for side, beta in ((1, 3.0), (-1, 3.0 - 2 * pi)):
        phi = move_to_goal(point, ORIGIN, wrap_array(np.array(pi + 3.0)), p, side=side)
        assert wrap_array(phi - pi + 0.5 * beta) == pytest.approx(0.0, abs=1e-9)
