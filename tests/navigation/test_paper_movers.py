"""Velocity modification, (11) and the method of `navigation.paper`."""

from dataclasses import replace
from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest

from navigation.decision import SpeedLimits
from navigation.motion.collision_band import Encounter
from navigation.paper import PaperMethod, modified_speed, oval
from navigation.parameters.motion import UnivectorParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.parameters.planner import PaperParameters, PlannerParameters

P = PaperParameters(d_con=0.8, d_e=0.15, d_b=0.3, k_r=0.3, omega_dist=12.0, horizon=6.0)
PROFILE = replace(
    NavigationParameters.paper(),
    planner=PlannerParameters(method="paper", paper=P),
    univector=UnivectorParameters(margin=0.03, eta_vo=0.5, holonomic_distance=0.0),
)
TARGET = np.array([2.0, 0.0])
V_MAX, DESIRED = 0.2, 0.15
BOTH = pytest.mark.parametrize("weights", ["printed", "exchanged"])


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


@BOTH
@pytest.mark.parametrize("lateral", [0.02, -0.05])
def test_a_mover_head_on_is_passed_with_the_scheme(weights, lateral, walker, track, task):
    """Fig. 4 (c) in closed loop; with the printed weights the field alone runs into the mover."""
    least = []
    for min_speed in (P.min_speed, 1.0):  # with the second one no obstacle is a mover
        method = replace(P, weights=weights, min_speed=min_speed)
        planner = replace(PROFILE.planner, paper=method)
        walk, gaps = walker("paper", parameters=replace(PROFILE, planner=planner)), []
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
