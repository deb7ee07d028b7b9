"""Equations (7)-(11) as printed, with the repairs of `navigation.paper`."""

from dataclasses import replace
from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.decision import SpeedLimits
from navigation.motion.collision_band import Encounter
from navigation.motion.univector import normalized, unit_vectors
from navigation.paper import (
    WEIGHTS,
    Discs,
    PaperField,
    PaperMethod,
    avoid_obstacle,
    modified_speed,
    move_to_goal,
    oval,
)
from navigation.parameters.navigation import NavigationParameters
from navigation.parameters.planner import PaperParameters

PROFILE = NavigationParameters.paper()
P = PaperParameters()
TARGET = np.array([2.0, 0.0])
V_MAX, DESIRED = 0.2, 0.15
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


def test_the_avoiding_field_is_continuous_in_the_distance():
    rho = np.linspace(0.2, 0.3 + P.d_e + P.d_b - 1e-6, 4000)
    u = u_auf(rho[:, None] * normalized(np.array([-0.4, 0.1])))[:, 0]
    assert np.hypot(*np.diff(u, axis=0).T).max() < 0.1


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


def test_the_avoiding_field_moves_along_with_rigid_motion(rotation):
    rng, r, shift = np.random.default_rng(3), rotation(0.6), np.array([1.0, 4.0])
    points, centres = rng.uniform(-1, 1, (100, 2)), rng.uniform(-1, 1, (5, 2))
    u = u_auf(points, still(*centres))
    moved = u_auf(points @ r.T + shift, still(*(centres @ r.T + shift)), r @ TARGET + shift)
    assert moved == pytest.approx(u @ r.T, abs=1e-9)


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


def test_the_weights_are_those_of_figure_3_and_their_exchange():
    assert WEIGHTS == {"printed": (0.75, 0.25), "exchanged": (0.25, 0.75)}
    assert P.weights == "printed"


def test_the_printed_weights_turn_at_most_asin_one_third():
    """19.5 deg off the direction to the goal, whatever the obstacles."""
    rng, largest = np.random.default_rng(5), 0.0
    for _ in range(20):
        centres, points = rng.uniform(-1, 1, (6, 2)), rng.uniform(-1, 1, (200, 2))
        u = PaperField(TARGET, 0.5, still(*centres), P).at(points)
        turn = wrap_array(angle(u) - move_to_goal(points, TARGET, 0.5, P))
        largest = max(largest, float(np.abs(turn).max()))
    assert np.arcsin(1 / 3) - 0.01 < largest <= np.arcsin(1 / 3) + 1e-9


def test_without_obstacles_the_field_is_that_of_the_goal():
    point = np.array([0.3, -0.4])
    u = PaperField(TARGET, 0.5, still(), P).at(point)
    assert u == pytest.approx(0.75 * unit_vectors(move_to_goal(point, TARGET, 0.5, P)))


def test_the_field_is_mirrored():
    rng = np.random.default_rng(6)
    centres, points = rng.uniform(-1, 1, (6, 2)), rng.uniform(-2, 2, (100, 2))
    u = PaperField(np.array([2.0, 0.3]), 0.4, still(*centres), P).at(points)
    flip = np.array([1.0, -1.0])
    m = PaperField(np.array([2.0, -0.3]), -0.4, still(*(centres * flip)), P).at(points * flip)
    assert u == pytest.approx(m * flip, abs=1e-9)


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


# Velocity modification, Fig. 4 (a) and (b)


def limits_with(acceleration):
    return SpeedLimits(V_MAX, 0.1, 0.08, 0.8, acceleration, 0.34)


def modified(encounters, desired=DESIRED, now=DESIRED, acceleration=0.3, horizon=6.0):
    return modified_speed(tuple(encounters), desired, now, limits_with(acceleration), horizon)


def movers(rng):
    return [
        Encounter(*rng.uniform(-1, 1, 2).tolist(), *rng.normal(0, 0.1, 2).tolist(), 0.2)
        for _ in range(int(rng.integers(1, 4)))
    ]


def test_without_movers_the_speed_stays():
    assert modified(()) == (DESIRED, "free")


def test_the_chosen_speed_is_free_or_the_path_must_change():
    rng, situations = np.random.default_rng(0), set()
    for _ in range(1500):
        encounters, desired = movers(rng), float(rng.uniform(0.02, V_MAX))
        speed, situation = modified(encounters, desired, desired)
        situations.add(situation)
        assert 0.0 <= speed <= V_MAX
        if situation == "path_change":
            assert speed == desired
        else:
            assert all(e.contact_time(speed) > 6.0 for e in encounters)
            signs = {"free": 0.0, "brake": -1.0}
            assert np.sign(speed - desired) == signs.get(situation, 1.0)
    assert situations == {"free", "accelerate", "brake", "escape", "path_change"}


def test_accelerate_and_escape_are_reachable_at_the_speed_of_the_method():
    """The desired speed is 0.75 of the maximum: at the maximum a robot could only brake."""
    rng, counts = np.random.default_rng(1), {}
    for _ in range(3000):
        _, situation = modified(movers(rng))
        counts[situation] = counts.get(situation, 0) + 1
    assert P.nominal * V_MAX == pytest.approx(DESIRED)
    assert min(counts.get("accelerate", 0), counts.get("escape", 0)) > 10


def test_the_choice_is_that_of_brute_force():
    """The lowest free speed above, else the highest free one below, on a fine grid."""
    rng, grid, compared = np.random.default_rng(2), np.linspace(0.0, V_MAX, 401), 0
    for _ in range(300):
        encounters = movers(rng)
        free = [v for v in grid.tolist() if not any(e.collides(v, 6.0) for e in encounters)]
        speed, situation = modified(encounters, acceleration=inf)
        below, above = ([v for v in free if (v - DESIRED) * s > 0.0] for s in (-1.0, 1.0))
        if situation in {"accelerate", "escape"} and above:
            assert speed == pytest.approx(above[0], abs=6e-4)
            compared += 1
        elif situation == "brake":
            assert not above
            if below:
                assert speed == pytest.approx(below[-1], abs=6e-4)
                compared += 1
    assert compared > 30


CROSSING = (Encounter(0.45, -0.7, 0.0, 0.1, 0.2),)


def test_the_robot_passes_first_if_it_can_and_waits_if_it_cannot():
    fast = modified(CROSSING, 0.06, 0.06, acceleration=inf)
    slow = modified(CROSSING, 0.06, 0.06, acceleration=0.0)
    assert (fast[1], slow[1]) == ("accelerate", "brake")
    assert fast[0] > 0.06 > slow[0]


def test_the_acceleration_limit_is_that_of_the_printed_formula():
    """a_i = 2 (|p_oc| - |v_r| t_c)/t_c², the constant acceleration that is there in time."""
    now = 0.06
    fast, _ = modified(CROSSING, now, now, acceleration=inf)
    time = CROSSING[0].touch_time(fast)
    needed = 2.0 * (fast * time - now * time) / time**2
    assert now * time + 0.5 * needed * time**2 == pytest.approx(fast * time)
    assert modified(CROSSING, now, now, acceleration=1.001 * needed)[0] == fast
    assert modified(CROSSING, now, now, acceleration=0.999 * needed)[1] == "brake"


def test_collisions_beyond_the_horizon_are_ignored():
    far = (Encounter(1.9, 0.0, -0.05, 0.0, 0.3),)
    assert modified(far, horizon=6.0)[1] == "free"
    assert modified(far, horizon=60.0)[1] == "path_change"


def test_inside_the_band_the_robot_does_not_wait():
    """Slower is free only until the horizon: the contact is put off, not avoided."""
    head_on = (Encounter(1.4, 0.0, -0.1, 0.0, 0.3),)
    assert 6.0 < head_on[0].contact_time(0.0) < 12.0
    assert modified(head_on, 0.2, 0.2) == (0.2, "path_change")


def test_the_speed_that_passes_first_does_not_jump_where_the_robot_enters_the_band():
    """From case (a) to case (b): the lateral distance from the mover's path crosses S."""
    compared = 0
    for along in np.linspace(0.25, 1.5, 26).tolist():
        outside, inside = (
            modified((Encounter(0.3 + e, -along, 0.0, 0.1, 0.3),), 0.05, 0.05, inf, 60.0)
            for e in (1e-7, -1e-7)
        )
        if outside[1] == "accelerate":
            assert inside[1] == "escape"
            assert outside[0] == pytest.approx(inside[0], abs=1e-5)
            compared += 1
    assert compared > 10


# Equation (11)


@pytest.mark.parametrize("xi", [0.2, 0.4, 0.5, 0.6, 0.8])
def test_the_oval_starts_at_one_is_xi_in_the_middle_and_ends_at_zero(xi):
    assert [oval(h, xi) for h in (0.0, 0.5, 1.0)] == pytest.approx([1.0, xi, 0.0])
    assert np.all(np.diff([oval(k / 100, xi) for k in range(101)]) < 0.0)
    assert (oval(-1.0, xi), oval(2.0, xi)) == pytest.approx((1.0, 0.0))


def test_the_oval_is_concave_above_a_half_linear_at_it_and_continuous_there():
    h = np.linspace(0.0, 1.0, 101)
    assert np.all(np.diff([oval(x, 0.7) for x in h], 2) < 0.0)
    assert np.all(np.diff([oval(x, 0.3) for x in h], 2) > 0.0)
    assert [oval(x, 0.5) for x in h] == pytest.approx(1.0 - h)
    for x in h.tolist():
        assert oval(x, 0.5 + 2.6e-5) == pytest.approx(oval(x, 0.5), abs=3e-5)


@pytest.fixture
def virtual(planning, track):
    """Virtual obstacle of a mover at the origin, for a robot at a position."""

    def virtual(robot, velocity=(0.1, 0.0), mover=(0.0, 0.0), body=(0.15, 0.0, 0.0), psi=0.0):
        s = planning(
            [track(mover, velocity)], pose=(*robot, 0.0), body=body, psi=[psi], parameters=PROFILE
        )
        return PaperMethod(P).virtual_obstacle(s, 0), s

    return virtual


def test_the_virtual_obstacle_is_at_the_projection_on_the_path_of_the_mover(virtual):
    disc, _ = virtual((0.2, 0.3))
    assert disc.position == pytest.approx([0.2, 0.0])
    assert disc.track_id == 1


def test_the_radius_is_the_oval_but_never_reaches_over_the_robot(virtual):
    rng, capped = np.random.default_rng(1), set()
    for x, y in rng.uniform((0.02, -0.6), (1.5, 0.6), (300, 2)).tolist():
        disc, s = virtual((x, y))
        length = P.omega_dist * PROFILE.univector.eta_vo * 0.05
        if x >= length:
            assert disc is None
            continue
        printed = oval(x / length, P.xi) * float(s.s_oe[0])
        assert disc.radius == pytest.approx(min(printed, abs(y)))
        assert disc.radius <= hypot(*(disc.position - s.pose[:2])) + 1e-12
        capped.add(printed > abs(y))
    assert capped == {True, False}


def test_the_length_grows_with_relative_speed_and_uncertainty(virtual):
    """delta_dist = omega_dist (eta_vo |v_ro| + eta_imp (psi_sf + psi_ob))."""
    for velocity, body, psi in (
        ((0.1, 0.0), (0.15, 0.0, 0.0), 0.0),
        ((0.1, 0.0), (-0.05, 0.0, 0.0), 0.0),
        ((0.1, 0.0), (0.1, 0.0, 0.0), 0.7),
    ):
        u = PROFILE.univector
        length = P.omega_dist * (u.eta_vo * abs(velocity[0] - body[0]) + u.eta_imp * psi)
        for factor, exists in ((0.99, True), (1.01, False)):
            disc, _ = virtual((factor * length, 0.3), velocity, body=body, psi=psi)
            assert (disc is not None) == exists


@pytest.mark.parametrize("velocity", [(-0.1, 0.0), (0.0, 0.0)])
def test_a_mover_that_goes_away_or_stands_has_none(velocity, virtual):
    assert virtual((0.4, 0.1), velocity)[0] is None


def test_the_virtual_obstacle_moves_with_the_robot_along_the_path(virtual):
    """v_r_perp_op = (v_r . q) q/|q|², by finite differences of p_vo."""
    rng, compared, step = np.random.default_rng(2), 0, 1e-6
    for _ in range(50):
        course, (vx, vy) = rng.uniform(-pi, pi), rng.normal(0.0, 0.1, 2).tolist()
        path, robot = np.array([cos(course), sin(course)]), rng.uniform(-0.5, 0.5, 2)
        here, s = virtual(robot, 0.1 * path)
        there, _ = virtual(robot + step * np.array([vx, vy]), 0.1 * path)
        if here is None or there is None:
            continue
        slope = (there.position - here.position) / step
        q = here.position - s.obstacles.position[0]
        assert slope == pytest.approx((np.array([vx, vy]) @ q) * q / (q @ q), abs=1e-6)
        compared += 1
    assert compared > 15


def test_the_virtual_obstacle_does_not_depend_on_the_frame(virtual, planning, track, rotation):
    a, shift = 0.8, np.array([3.0, -1.0])
    r = rotation(a)
    for robot in np.random.default_rng(3).uniform((0.05, -0.5), (0.29, 0.5), (20, 2)):
        here, _ = virtual(robot)
        s = planning(
            [track(shift, r @ [0.1, 0.0])],
            pose=(*(r @ robot + shift), a),
            body=(0.15, 0.0, 0.0),
            parameters=PROFILE,
        )
        there = PaperMethod(P).virtual_obstacle(s, 0)
        assert there.position == pytest.approx(r @ here.position + shift)
        assert there.radius == pytest.approx(here.radius)


# The method


@pytest.fixture
def desired(planning, task):
    """Desired velocity among tracks, walking at the desired speed."""

    def desired(tracks, target=TARGET, weights="printed", **details):
        settings = {"body": (DESIRED, 0.0, 0.0), "parameters": PROFILE, **details}
        s = planning(tracks, task(target), **settings)
        return PaperMethod(replace(P, weights=weights)).desired(s)

    return desired


def test_a_definite_collision_makes_a_virtual_obstacle_in_place_of_the_mover(desired, track):
    mover = track((0.6, 0.1), (-0.12, 0.0), id=5)
    w = desired([mover, track((0.5, 0.9), id=2)])
    assert [v.track_id for v in w.virtual] == [5]
    assert w.virtual[0].position == pytest.approx([0.0, 0.1])
    plain = desired([track((0.6, 0.1), id=5), track((0.5, 0.9), id=2)])
    near_mover = np.array([0.6 - 0.3, 0.1])
    assert plain.field.at(near_mover) != pytest.approx(w.field.at(near_mover))
    alone = desired([track((0.5, 0.9), id=2)]).field.at(near_mover)
    assert w.field.at(near_mover) == pytest.approx(alone)
    assert w.direction < -0.05  # away from the path of the mover, on the robot's side


def test_a_mover_that_can_be_avoided_by_speed_has_no_virtual_obstacle(desired, track):
    w = desired([track((0.7, -0.5), (0.0, 0.12))])
    assert w.situation in {"brake", "accelerate"}
    assert w.virtual == ()
    assert np.hypot(*w.velocity) != pytest.approx(DESIRED)
    assert w.direction == pytest.approx(0.0, abs=1e-9)


def test_a_robot_on_the_path_of_a_mover_leaves_it_on_the_side_of_its_goal(desired, track):
    for side in (1.0, -1.0):
        w = desired([track((0.6, 0.0), (-0.12, 0.0))], (1.5, 0.8 * side), body=(0.1, 0.1 * side, 0))
        assert w.virtual[0].radius == pytest.approx(0.0, abs=1e-9)
        assert np.sign(np.sin(w.direction - np.arctan2(0.8 * side, 1.5))) == side


@BOTH
def test_the_desired_speed_is_the_nominal_ratio(weights, desired):
    assert np.hypot(*desired([], weights=weights).velocity) == pytest.approx(0.75 * V_MAX)


def test_the_scheme_is_mirrored(desired, tracks):
    rng, situations = np.random.default_rng(7), set()
    flip = np.array([1.0, -1.0])
    for _ in range(60):
        places = rng.uniform((0.2, -0.6), (1.2, 0.6), (3, 2))
        velocities = rng.normal((-0.08, 0.0), 0.06, (3, 2))
        one = desired(tracks(places, velocities), (1.6, 0.3))
        other = desired(tracks(places * flip, velocities * flip), (1.6, -0.3))
        assert other.velocity == pytest.approx(one.velocity * flip, abs=1e-9)
        assert other.situation == one.situation
        assert [v.radius for v in other.virtual] == pytest.approx([v.radius for v in one.virtual])
        situations.add(one.situation)
    assert "path_change" in situations


@BOTH
@pytest.mark.parametrize("lateral", [0.02, -0.05])
def test_a_mover_head_on_is_passed_with_the_scheme(weights, lateral, walker, track, task):
    """Fig. 4 (c) in closed loop; with the printed weights the field alone runs into the mover."""
    least = []
    for min_speed in (P.min_speed, 1.0):  # with the second one no obstacle is a mover
        walk, gaps = walker("paper", weights=weights, min_speed=min_speed), []
        for step in range(60):
            x = 3.0 - 0.034 * step
            walk.step(task((4.5, 0.0)), [track((x, lateral), (-0.1, 0.0), radius=0.1)])
            gaps.append(walk.distance((x - 0.034, lateral)) - 0.1 - PROFILE.univector.s_robot)
            if walk.pose[0] > x + 0.4:
                break
        assert walk.pose[0] > x
        least.append(min(gaps))
    assert least[0] > max(0.0, least[1])
    assert (least[1] < 0.0) == (weights == "printed")
