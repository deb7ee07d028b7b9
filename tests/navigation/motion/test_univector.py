import numpy as np
import pytest

from navigation.motion.move_to_goal import move_to_goal
from navigation.motion.univector import (
    Univector,
    UnivectorField,
    blended_sum,
    nearness,
    normalized,
    shrunk_for_goal,
)
from navigation.parameters.motion import UnivectorParameters

P = UnivectorParameters()
TARGET = (2.0, 0.0)
BODIES = P.s_robot + 0.08  # distance at which robot and an obstacle of 0.08 m touch [m]


def unit(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def blended(goal, u_auf, ramp):
    return blended_sum(unit(goal), u_auf, np.array(ramp))


@pytest.fixture
def field(planning, task):
    """Builds the field of tracks and a destination."""

    def field(tracks, target=TARGET, heading=0.0, **details):
        return UnivectorField.of(planning(tracks, task(target, heading), **details))

    return field


def walk(field, starts, reach, length=6.0, step=0.01):
    """Follow the field; return whether it arrives, and the minimum distances to the centres."""
    point = np.array(starts, float)
    least, arrived = np.full(len(point), np.inf), np.zeros(len(point), bool)
    for _ in range(round(length / step)):
        point = point + step * normalized(field.at(point)) * ~arrived[:, None]
        away = point[:, None] - field.centres
        least = np.minimum(least, np.hypot(away[..., 0], away[..., 1]).min(axis=1))
        arrived |= np.hypot(*(point - field.target).T) < reach
    return arrived, least


def test_obstacles_count_by_the_square_of_their_nearness():
    """Two at right angles, of nearness 0.8 and 0.4: the nearer one counts four times."""
    total = blended(1.0, unit(np.array([0.0, np.pi / 2])), [0.8, 0.4])
    avoid = np.array([4.0, 1.0]) / np.hypot(4.0, 1.0)
    assert total == pytest.approx(0.2 * unit(1.0) + 0.8 * avoid)


def test_the_sum_is_continuous_where_an_obstacle_appears():
    u_auf = unit(np.array([0.3, 2.0]))
    for ramp in (0.0, 0.5):
        near = blended(1.0, u_auf, [ramp, 1e-6])
        assert near == pytest.approx(blended(1.0, u_auf, [ramp, 0.0]), abs=1e-5)


def test_nearness_falls_from_one_to_zero():
    rho = np.linspace(0.0, 1.0, 1001)
    ramp = nearness(rho[:, None], np.array([0.3]), 0.2, 0.25)[:, 0]
    assert np.all(ramp[rho < 0.4 - 1e-9] == 1.0)
    assert np.all(ramp[rho > 0.75 + 1e-9] == 0.0)
    assert np.all(np.diff(ramp) <= 0.0)
    assert np.abs(np.diff(ramp)).max() < 0.01


def test_a_goal_near_an_obstacle_shrinks_it_but_never_into_the_bodies():
    s_phys, distance = np.full(50, 0.2), np.linspace(0.2, 1.0, 50)
    s, d_e = shrunk_for_goal(np.full(50, 0.3), s_phys, distance, P)
    assert np.all(s > s_phys)
    assert np.all(s <= 0.3)
    assert np.all(d_e >= P.min_goal_offset)
    untouched = distance >= 0.3 + P.d_e
    assert np.all(s[untouched] == 0.3)
    assert np.all(d_e[untouched] == P.d_e)
    assert np.all((s < distance)[distance > 0.235])


def test_near_the_goal_the_radius_leaves_its_fraction_of_the_room():
    p = UnivectorParameters(goal_fraction=0.5, min_goal_gap=0.02, min_goal_offset=0.03, d_e=0.2)
    s_oe, s_phys = np.full(3, 0.3), np.full(3, 0.2)
    s, d_e = shrunk_for_goal(s_oe, s_phys, np.array([0.21, 0.3, 0.45]), p)
    assert s == pytest.approx([0.21, 0.25, 0.3])
    assert d_e == pytest.approx([0.03, 0.05, 0.15])


def test_without_obstacles_the_field_leads_to_the_goal_and_is_zero_there(field):
    u = field([], heading=0.6)
    points = np.random.default_rng(0).uniform(-1, 3, (100, 2))
    phi = move_to_goal(points, np.array(TARGET), 0.6, P)
    assert u.at(points) == pytest.approx(unit(phi))
    assert not u.at(np.array(TARGET)).any()


def test_fifteen_starts_pass_one_disc_on_their_line(field, track):
    u = field([track((0, 0), radius=0.30 - P.s_robot - P.margin)])
    assert u.radii == pytest.approx([0.30])
    arrived, least = walk(u, [(-1.5, y) for y in np.linspace(-0.7, 0.7, 15)], 0.05)
    assert arrived.all()
    assert least.min() >= 0.30


@pytest.mark.parametrize("gap", [0.02, 0.05, 0.10, 0.15, 0.25])
def test_goals_next_to_an_obstacle_are_reached(gap, field, track):
    u = field([track((0, 0))], (BODIES + gap, 0.0))
    arrived, least = walk(u, 1.5 * unit(np.arange(24) * np.pi / 12), 0.06, length=5.0)
    assert arrived.all()
    assert least.min() >= BODIES - 0.05


def test_inside_the_extended_radius_the_field_is_outward(field, track):
    u, rng = field([track((0, 0))]), np.random.default_rng(0)
    outward = unit(rng.uniform(-np.pi, np.pi, 200))
    points = rng.uniform(0.01, float(u.radii[0]) - P.inside, (200, 1)) * outward
    assert u.at(points) == pytest.approx(outward)


def test_close_to_an_obstacle_ahead_the_field_leads_away(field, track):
    """Up to S_oe + d_e/2, for obstacles that have their full effect."""
    u, rng = field([track((0, 0))]), np.random.default_rng(0)
    outward = unit(rng.uniform(-np.pi, np.pi, 500))
    points = (float(u.radii[0]) + rng.uniform(0.0, 0.5 * P.d_e, (500, 1))) * outward
    to_goal = normalized(TARGET - points)
    ahead = -(to_goal * outward).sum(axis=1) > P.fade
    assert ahead.sum() > 50
    away = (normalized(u.at(points)) * outward).sum(axis=1)
    assert away[ahead].min() >= np.cos(0.5 * np.pi * np.sqrt(0.5)) - 1e-9


def steepest(values, step):
    """Maximum rate of change along the first axis, per metre."""
    change = np.diff(values, axis=0)
    return np.hypot(change[..., 0], change[..., 1]).max() / step


@pytest.mark.parametrize("lateral", [0.26, 0.30, 0.40, 0.55])
def test_the_field_does_not_jump_where_an_obstacle_passes_abeam(lateral, field, track):
    """The third condition of (9) is a step; here the obstacle fades out."""
    step = 1e-3
    u = field([track((0.0, lateral))], (3.0, 0.0))
    points = np.stack([np.arange(-0.5, 0.5, step), np.zeros(1000)], axis=1)
    rates = [steepest(u.at(points[::k]), k * step) for k in (1, 4)]
    assert max(rates) < 30.0
    abeam = field([track((0.0, lateral))], (3.0, 0.0)).at(np.array([1e-9, 0.0]))
    assert abeam == pytest.approx([1.0, 0.0], abs=1e-6)


def test_the_field_does_not_jump_where_an_obstacle_passes_beyond_the_destination(field, track):
    target, step, jumps = np.array([0.15, 0.0]), 1e-4, []
    for bearing in np.linspace(0.3, 1.3, 6).tolist():
        rho = 0.25 + step * np.arange(5000)
        values = [
            field([track(r * unit(bearing))], target).at(np.zeros(2)) for r in rho[::10].tolist()
        ]
        jumps.append(steepest(np.array(values), 10 * step) * 10 * step)
    assert max(jumps) < 0.1


def test_the_field_does_not_jump_where_the_robot_leaves_the_extended_radius(field, track):
    u = field([track((0, 0))])
    directions = unit(np.linspace(-np.pi, np.pi, 361))
    inner, outer = (u.at((float(u.radii[0]) + e) * directions) for e in (-1e-6, 1e-6))
    assert np.hypot(*(outer - inner).T).max() < 0.1


def test_a_mover_has_its_shorter_side_at_every_point(field, track):
    left, right = field([track((0, 0), (0.0, 0.1))]).at(np.array([[-0.4, 0.05], [-0.4, -0.05]]))
    assert left[1] > 0.1
    assert right == pytest.approx(left * [1, -1])


def test_the_motion_follows_the_field_one_footstep_ahead_at_the_desired_speed(
    planning, task, track
):
    """The command takes effect a footstep later, where robot and movers are then."""
    mover, target = ((0.7, 0.2), (0.0, -0.1)), task(TARGET)
    s = planning([track(*mover)], target, body=(0.2, 0.0, 0.0), speed=0.15)
    desired = Univector().desired(s)
    later = np.array([0.34 * 0.2, 0.0])
    moved = planning([track((0.7, 0.2 - 0.034), (0.0, -0.1))], target)
    u = UnivectorField.of(moved).at(later)
    assert desired.direction == pytest.approx(float(np.arctan2(u[1], u[0])))
    assert desired.velocity == pytest.approx(0.15 * normalized(u))
    assert desired.field.at(later) == pytest.approx(u)
