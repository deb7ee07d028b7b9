import numpy as np
import pytest

from navigation.belief.belief import Motion
from navigation.belief.tracks import Tracks
from navigation.motion.univector import (
    blended_sum,
    extended_radius,
    nearness,
    normalized,
    physical_radius,
    shrunk_for_goal,
    weighted_sum,
)
from navigation.parameters.motion import UnivectorParameters

P = UnivectorParameters()
NO_VIRTUAL = np.zeros((0, 2)), np.zeros(0)


def unit(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def blended(goal, u_auf, ramp):
    return blended_sum(unit(goal), u_auf, np.array(ramp), *NO_VIRTUAL, virtual_weight=1.5)


def test_without_active_obstacles_only_the_goal_counts():
    u = unit(0.7)
    assert normalized(weighted_sum(u, np.zeros((3, 2)), 0.75, 0.25)) == pytest.approx(u)
    for ramp in ([], [0.0, 0.0], [1.0]):  # none, far ones, one behind the robot
        assert blended(0.7, np.zeros((len(ramp), 2)), ramp) == pytest.approx(u)
    opposite = unit(np.array([np.pi / 2, -np.pi / 2]))
    assert blended(0.7, opposite, [1.0, 1.0]) == pytest.approx(u)


def test_an_obstacle_at_hand_decides_alone():
    u_auf = unit(np.array([2.0]))
    assert normalized(blended(0.0, u_auf, [1.0])) == pytest.approx(u_auf[0])


def test_the_printed_weights_turn_at_most_19_5_degrees():
    u_auf = unit(np.linspace(-np.pi, np.pi, 3601))[:, None, :]
    total = weighted_sum(unit(0.0), u_auf, 0.75, 0.25)
    largest = np.degrees(np.abs(np.arctan2(total[:, 1], total[:, 0]))).max()
    assert largest == pytest.approx(np.degrees(np.arcsin(1 / 3)), abs=0.01)


def test_nearness_falls_from_one_to_zero():
    rho = np.linspace(0.0, 1.0, 1001)
    ramp = nearness(rho[:, None], np.array([0.3]), 0.2, 0.25)[:, 0]
    assert np.all(ramp[rho < 0.4 - 1e-9] == 1.0)
    assert np.all(ramp[rho > 0.75 + 1e-9] == 0.0)
    assert np.all(np.diff(ramp) <= 0.0)
    assert np.abs(np.diff(ramp)).max() < 0.01


def test_a_goal_near_an_obstacle_shrinks_it_but_never_into_the_bodies():
    s_phys = np.full(50, 0.2)
    distance = np.linspace(0.2, 1.0, 50)
    s, d_e = shrunk_for_goal(np.full(50, 0.3), s_phys, distance, UnivectorParameters())
    assert np.all(s > s_phys)
    assert np.all(s <= 0.3)
    assert np.all(d_e >= 0.03)
    untouched = distance >= 0.5
    assert np.all(s[untouched] == 0.3)
    assert np.all(d_e[untouched] == 0.2)
    reachable = distance > 0.235
    assert np.all((s < distance)[reachable])


def test_the_printed_sum_weighs_the_goal_against_the_direction_of_all_obstacles():
    u_auf = np.array([unit(0.4), unit(1.0), [0.0, 0.0]])
    total = weighted_sum(unit(-0.3), u_auf, 0.75, 0.25)
    assert total == pytest.approx(0.75 * unit(-0.3) + 0.25 * unit(0.7))


def test_obstacles_count_by_the_square_of_their_nearness():
    """Two at right angles, of nearness 0.8 and 0.4: the nearer one counts four times."""
    total = blended(1.0, unit(np.array([0.0, np.pi / 2])), [0.8, 0.4])
    avoid = np.array([4.0, 1.0]) / np.hypot(4.0, 1.0)
    assert total == pytest.approx(0.2 * unit(1.0) + 0.8 * avoid)


def test_virtual_obstacles_join_in_with_their_weight():
    u_auf, u_virtual = unit(np.array([0.0])), unit(np.array([np.pi / 2]))
    ramp, weight = np.array([0.4]), np.array([0.8])
    total = blended_sum(unit(1.0), u_auf, ramp, u_virtual, weight, virtual_weight=1.5)
    avoid = np.array([1.0, 6.0]) / np.hypot(1.0, 6.0)
    assert total == pytest.approx(0.2 * unit(1.0) + 0.8 * avoid)
    alone = blended_sum(
        unit(1.0), np.zeros((0, 2)), np.zeros(0), u_virtual, weight, virtual_weight=1.5
    )
    assert alone == pytest.approx(0.2 * unit(1.0) + 0.8 * u_virtual[0])


def test_near_the_goal_the_radius_leaves_its_fraction_of_the_room():
    p = UnivectorParameters(goal_fraction=0.5, min_goal_gap=0.02, min_goal_offset=0.03, d_e=0.2)
    s_oe, s_phys = np.full(3, 0.3), np.full(3, 0.2)
    s, d_e = shrunk_for_goal(s_oe, s_phys, np.array([0.21, 0.3, 0.45]), p)
    assert s == pytest.approx([0.21, 0.25, 0.3])
    assert d_e == pytest.approx([0.03, 0.05, 0.15])


def radius(track, velocity=(0.0, 0.0), motion=None, psi_sf=0.0, psi_ob=0.0):
    o = Tracks.of([track((1, 0), velocity, motion)])
    return float(extended_radius(o, psi_sf, np.array([psi_ob]), P)[0])


def test_a_still_certain_obstacle_has_the_sum_of_the_radii(track):
    assert radius(track) == pytest.approx(P.s_robot + P.margin + 0.08)
    o = Tracks.of([track((1, 0))])
    assert physical_radius(o, P) == pytest.approx([P.s_robot + 0.08])


def test_it_grows_with_speed_and_with_each_uncertainty(track):
    base = radius(track)
    assert radius(track, (0.1, 0.0)) == pytest.approx(base + 0.1 * P.eta_vo)
    assert radius(track, psi_sf=0.4) == pytest.approx(base + 0.4 * P.eta_imp)
    assert radius(track, psi_ob=0.6) == pytest.approx(base + 0.6 * P.eta_imp)


def test_a_track_called_static_does_not_grow_with_its_noise(track):
    assert radius(track, (0.1, 0.0), Motion.STATIC) == radius(track)
