from dataclasses import replace

import numpy as np
import pytest

from navigation.belief.tracks import Tracks
from navigation.motion.motion_field import FieldScene, MotionField
from navigation.motion.univector import extended_radius, normalized
from navigation.motion.virtual_obstacle import oval
from navigation.parameters.navigation import NavigationParameters

EXTENDED, PAPER = NavigationParameters.extended(), NavigationParameters.paper()
TARGET = np.array([2.0, 0.0])


def scene(tracks, p=EXTENDED, target=TARGET, heading=0.0):
    o = Tracks.of(tracks)
    return FieldScene(o, extended_radius(o, 0.0, np.zeros(len(o)), p.univector), np.zeros(len(o)),
                      np.asarray(target, float), heading)  # fmt: skip


def walk(field, s, starts, reach, length=6.0, step=0.01):
    """Follow the field; return final distance to the target and least distance to centres."""
    point = np.array(starts, float)
    least = np.full(len(point), np.inf)
    arrived = np.zeros(len(point), bool)
    for _ in range(round(length / step)):
        u = normalized(field.at(point, 0.0, s, ()))
        point = point + step * u * ~arrived[:, None]
        away = point[:, None] - s.obstacles.position
        least = np.minimum(least, np.hypot(away[..., 0], away[..., 1]).min(axis=1))
        arrived |= np.hypot(*(point - s.target).T) < reach
    return arrived, least


@pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])
def test_fifteen_starts_pass_one_disc_on_their_line(p, track):
    field = MotionField(p.univector, p.moving_obstacles)
    s = scene([track((0, 0), radius=0.15)], p)
    assert s.s_oe[0] == pytest.approx(0.30)
    starts = [(-1.5, y) for y in np.linspace(-0.7, 0.7, 15)]
    arrived, least = walk(field, s, starts, 0.05)
    assert arrived.all()
    assert least.min() >= 0.30 + (0.10 if p is EXTENDED else 0.0)


def test_goals_next_to_an_obstacle_are_reached(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s_phys = EXTENDED.univector.s_robot + 0.1
    angle = np.arange(24) * np.pi / 12
    starts = 1.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for gap in (0.02, 0.05, 0.10, 0.15, 0.25):
        s = scene([track((0, 0), radius=0.1)], target=(s_phys + gap, 0.0))
        arrived, least = walk(field, s, starts, 0.06, length=5.0)
        assert arrived.all(), gap
        assert least.min() >= s_phys - 0.05


def test_close_to_one_obstacle_the_field_leads_away(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s = scene([track((0, 0))])
    rng = np.random.default_rng(0)
    rho = rng.uniform(0.05, float(s.s_oe[0]) + 0.1, 500)
    angle = rng.uniform(-np.pi, np.pi, 500)
    outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = rho[:, None] * outward
    u = normalized(field.at(points, 0.0, s, ()))
    inside = rho < s.s_oe[0]
    ahead = ((TARGET - points) * points).sum(axis=1) < 0.0
    shows = inside | ahead
    assert (u * outward).sum(axis=1)[shows].min() >= np.cos(np.radians(63.8))


def test_the_blend_is_continuous_where_it_begins(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s = scene([track((0, 0))])
    edge = float(s.s_oe[0]) + EXTENDED.univector.d_e + EXTENDED.univector.d_b
    for angle in np.linspace(2.2, 4.0, 20):
        d = np.array([np.cos(angle), np.sin(angle)])
        inner, outer = (field.at((edge + e) * d, 0.0, s, ()) for e in (-1e-6, 1e-6))
        assert inner == pytest.approx(outer, abs=1e-4)


def test_a_mover_in_whose_band_the_robot_stands_pushes_it_sideways(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s = scene([track((1.0, 0.02), (-0.1, 0.0))])
    (active,) = field.uncapped_obstacles(np.zeros(3), np.array([0.15, 0.0]), s)
    assert active.obstacle.track_id == 1
    assert active.obstacle.position == pytest.approx([0.0, 0.02])
    assert 0.0 < active.weight < 1.0
    u = field.at(np.zeros(2), 0.0, s, (active,))
    assert abs(u[1]) > 0.3


def test_receding_or_static_obstacles_have_no_virtual_obstacle(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    for t in (track((1, 0), (0.1, 0)), track((1, 0)), track((1, 1), (-0.1, 0))):
        assert field.uncapped_obstacles(np.zeros(3), np.zeros(2), scene([t])) == ()


def test_both_forms_leave_a_mover_s_path_on_the_remembered_side_of_the_arrival(track):
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s = scene([track((0.5, 0.0), (-0.1, 0.0))], target=(0.3, 0.0), heading=np.pi)
    for side in (1, -1):
        held = replace(s, side=side)
        direction = field.at(np.zeros(2), 0.0, replace(held, obstacles=scene([]).obstacles,
                       s_oe=np.zeros(0), psi=np.zeros(0)), ())  # fmt: skip
        (printed,) = field.printed_obstacles(np.zeros(3), np.array([0.15, 0.0]), held, (0,))
        assert np.sin(printed.outward) * direction[1] > 0.5 * abs(direction[1]) > 0.1


def test_mirror_symmetry(track):
    rng = np.random.default_rng(2)
    centres, points = rng.uniform(-1, 1, (6, 2)), rng.uniform(-2, 2, (100, 2))
    for p in (EXTENDED, PAPER):
        field = MotionField(p.univector, p.moving_obstacles)
        s = scene([track(c) for c in centres], p, (2.0, 0.3), 0.4)
        m = scene([track(c * [1, -1]) for c in centres], p, (2.0, -0.3), -0.4)
        mirrored = field.at(points * [1, -1], 0.0, m, ())
        assert field.at(points, 0.0, s, ()) == pytest.approx(mirrored * [1, -1], abs=1e-9)


def test_without_obstacles_the_field_leads_to_the_goal():
    field = MotionField(EXTENDED.univector, EXTENDED.moving_obstacles)
    s = scene([], target=(0.0, 3.0))
    assert field.at(np.zeros(2), 0.0, s, ()) == pytest.approx([0.0, 1.0])


@pytest.mark.parametrize("p", [EXTENDED, PAPER], ids=["extended", "paper"])
def test_rigid_motion_moves_field_and_virtual_obstacles_along(p, track, rotation):
    a, shift = 0.7, np.array([3.0, -1.0])
    r = rotation(a)
    rng = np.random.default_rng(6)
    acting = 0
    for _ in range(40):
        centre, velocity = rng.uniform((0.3, -0.4), (1.2, 0.4)), rng.normal((-0.1, 0.0), 0.04)
        pose, walking = np.array([*rng.normal(0.0, 0.1, 2), 0.2]), np.array([0.15, 0.02])
        turned = np.array([*(r @ pose[:2] + shift), pose[2] + a])
        here = scene([track(centre, velocity), track((0.5, 0.6))], p, TARGET, 0.3)
        there = scene(
            [track(r @ centre + shift, r @ velocity), track(r @ [0.5, 0.6] + shift)],
            p, r @ TARGET + shift, 0.3 + a,
        )  # fmt: skip
        virtual = []
        for s, at, v in ((here, pose, walking), (there, turned, r @ walking)):
            field = MotionField(p.univector, p.moving_obstacles)
            if p is PAPER:
                result = field.printed_obstacles(at, v, s, (0,))
            else:
                result = field.uncapped_obstacles(at, v, s)
            # The printed circle goes through the robot: rounding decides whether it is inside.
            u = field.at(at[:2], at[2], s, () if p is PAPER else result)
            virtual.append((result, u))
        (own, u), (moved, u_moved) = virtual
        assert u_moved == pytest.approx(r @ u, abs=1e-9)
        for f, g in zip(own, moved, strict=True):
            acting += 1
            assert g.obstacle.position == pytest.approx(r @ f.obstacle.position + shift)
            assert (g.obstacle.radius, g.weight) == pytest.approx((f.obstacle.radius, f.weight))
            assert np.exp(1j * (g.direction - f.direction - a)) == pytest.approx(1.0)
            assert np.exp(1j * (g.outward - f.outward - a)) == pytest.approx(1.0)
    assert acting > 15


def test_the_uncapped_radius_is_the_oval_of_the_relative_speed(track):
    p = EXTENDED
    s = scene([track((1.0, 0.1), (-0.1, 0.0))])
    pose, velocity = np.zeros(3), np.array([0.15, 0.0])
    field = MotionField(p.univector, p.moving_obstacles)
    (active,) = field.uncapped_obstacles(pose, velocity, s)
    length = p.moving_obstacles.path_time * 0.25
    assert active.weight == pytest.approx(oval(1.0 / length, p.moving_obstacles.xi))
    assert active.obstacle.radius == pytest.approx(active.weight * s.s_oe[0])
    (active,) = field.uncapped_obstacles(pose, velocity, replace(s, psi=np.ones(1)))
    length += p.univector.eta_imp
    assert active.weight == pytest.approx(oval(1.0 / length, p.moving_obstacles.xi))
