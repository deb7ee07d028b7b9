from dataclasses import replace

import numpy as np
import pytest

from navigation.motion.facing import Facing
from navigation.motion.hypotheses import Hypotheses
from navigation.motion.safety_filter import (
    Paths,
    SafetyFilter,
    contact_times,
    direction_and_speed,
)
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters

HERE = np.zeros(3)
STANDING = np.zeros(3)
AHEAD = np.array([0.2, 0.0])
ON_COURSE = Facing()


def discs(places, velocities=None, radius=0.25, horizon=6.0, weight=1.0):
    places = np.atleast_2d(np.asarray(places, float))
    n = len(places)
    velocities = np.zeros((n, 2)) if velocities is None else np.atleast_2d(velocities)
    return Hypotheses(
        places,
        np.asarray(velocities, float),
        np.full(n, radius),
        np.full(n, horizon),
        np.full(n, weight),
    )


def choose(limits, wanted, hypotheses, pose=HERE, facing=ON_COURSE, body=STANDING, **changes):
    p = replace(SafetyFilterParameters(), **changes)
    return SafetyFilter(p, VelocityMappingParameters(), limits).choose(
        pose, np.asarray(wanted, float), float(np.arctan2(wanted[1], wanted[0])),
        facing=facing, body_now=body, discs=hypotheses,
    )  # fmt: skip


def test_contact_times_equal_brute_force():
    """2000 paths of three pieces against time stepping."""
    rng = np.random.default_rng(0)
    n, m, dt, end = 50, 40, 0.005, 8.0
    velocity = rng.normal(0, 0.2, (3, n, 2))
    duration = np.concatenate([rng.uniform(0, 2, (2, n)), np.full((1, n), np.inf)])
    d = discs(rng.uniform(-1.5, 1.5, (m, 2)), rng.normal(0, 0.15, (m, 2)), radius=0.2)
    time, _ = contact_times(Paths(velocity, duration), np.zeros(2), d)
    place = np.zeros((n, 2))
    touched = np.full((n, m), np.inf)
    near = np.full((n, m), np.inf)
    for step in range(round(end / dt)):
        t = step * dt
        gap = place[:, None] - (d.position + t * d.velocity)
        distance = np.hypot(gap[..., 0], gap[..., 1])
        near = np.minimum(near, np.abs(distance - 0.2))
        fresh = (distance < 0.2) & np.isinf(touched)
        touched[fresh] = t
        piece = (t >= duration[0]).astype(int) + (t >= duration[0] + duration[1])
        place = place + dt * velocity[piece, np.arange(n)]
    outside = np.hypot(*d.position.T) > 0.2
    grazed = (near < 0.004) & np.isinf(touched)
    clear = outside[None, :] & ~grazed & (time < end - 0.1)
    late = np.where(clear, time, 0.0) - np.where(clear, touched, 0.0)
    assert (np.abs(late[clear]) < 0.03).mean() > 0.995
    missed = outside[None, :] & np.isinf(time) & np.isfinite(touched)
    assert not missed.any()
    assert clear.sum() > 100


def test_inside_leaving_is_free_and_closing_is_now():
    paths = Paths(np.array([[[1.0, 0.0], [-1.0, 0.0]]]), np.full((1, 2), np.inf))
    time, closing = contact_times(paths, np.zeros(2), discs([-0.1, 0.0]))
    assert time[:, 0].tolist() == [np.inf, 0.0]
    assert closing[:, 0] == pytest.approx([0.0, 1.0])


def test_without_near_obstacles_the_wanted_velocity_stays(limits):
    assert choose(limits, AHEAD, discs([5.0, 0.0])) == pytest.approx(AHEAD)
    assert choose(limits, AHEAD, discs([-0.6, 0.0], horizon=2.0)) == pytest.approx(AHEAD)


def test_a_disc_on_the_path_changes_the_velocity(limits):
    v = choose(limits, AHEAD, discs([0.45, 0.02], horizon=2.0))
    assert v != pytest.approx(AHEAD)
    time, _ = contact_times(
        Paths(v[None, None], np.full((1, 1), np.inf)), np.zeros(2), discs([0.45, 0.02])
    )
    assert time[0, 0] > 1.5


def test_a_standing_robot_leaves_the_band_of_a_mover(limits):
    v = choose(limits, [0.0, 0.0], discs([0.7, 0.0], [-0.14, 0.0]))
    assert abs(v[1]) > 0.02


def test_the_choice_turns_with_the_scene(limits, rotation):
    rng = np.random.default_rng(1)
    for _ in range(20):
        places, velocities = rng.uniform(-1, 1, (8, 2)), rng.normal(0, 0.1, (8, 2))
        heading, a = float(rng.uniform(-3, 3)), float(rng.uniform(-3, 3))
        r = rotation(a)
        wish, body = rng.normal(0, 0.1, 2), np.array([0.1, 0.0, 0.2])
        filter_ = SafetyFilter(SafetyFilterParameters(), VelocityMappingParameters(), limits)
        course = float(np.arctan2(wish[1], wish[0]))
        one, other = (
            filter_.penalty(
                np.array([0, 0, h]),
                filter_.candidates(v, c),
                c,
                facing=ON_COURSE,
                body_now=body,
                discs=d,
            )
            for h, v, c, d in (
                (heading, wish, course, discs(places, velocities)),
                (heading + a, r @ wish, course + a, discs(places @ r.T, velocities @ r.T)),
            )
        )
        assert one == pytest.approx(other, abs=1e-6)


def test_without_rollout_the_path_is_turn_then_straight(limits):
    filter_ = SafetyFilter(
        replace(SafetyFilterParameters(), steps=0), VelocityMappingParameters(), limits
    )
    paths = filter_.paths(
        HERE, np.array([[-0.2, 0.0], [0.2, 0.0], [0.0, 0.05]]), 0.0, ON_COURSE, STANDING
    )
    assert paths.duration[0] == pytest.approx([(np.pi - 0.5) / limits.wz, 0.0, 0.0])
    assert paths.velocity[0] == pytest.approx(np.zeros((3, 2)))
    assert paths.velocity[1, 0] == pytest.approx([-0.2, 0.0])


def test_the_rollout_obeys_the_envelope(limits):
    p = SafetyFilterParameters()
    filter_ = SafetyFilter(p, VelocityMappingParameters(), limits)
    paths = filter_.paths(HERE, filter_.candidates(AHEAD, 0.0), 0.0, ON_COURSE, STANDING)
    speed = np.hypot(paths.velocity[..., 0], paths.velocity[..., 1])[: p.steps]
    assert speed.max() <= limits.vx + 1e-9
    change = limits.acceleration * limits.footstep
    assert speed[0].max() <= change + 1e-9


def test_a_turned_body_is_rolled_out_along_its_course(limits):
    """The lateral speed limit slows the turned body down."""
    filter_ = SafetyFilter(SafetyFilterParameters(), VelocityMappingParameters(), limits)
    turned, straight = (
        filter_.paths(np.array([0.0, 0.0, a]), AHEAD[None], 0.0, Facing(offset=a), body)
        for a, body in ((1.0, np.array([0.05, -0.08, 0.0])), (0.0, np.array([0.2, 0.0, 0.0])))
    )
    lateral = turned.velocity[-2 - 1, 0]
    assert np.arctan2(lateral[1], lateral[0]) == pytest.approx(0.0, abs=1e-9)
    assert lateral[0] == pytest.approx(limits.vy / np.sin(1.0))
    assert straight.velocity[-2 - 1, 0] == pytest.approx(AHEAD)


def test_weightless_hypotheses_do_not_matter(limits):
    assert choose(limits, AHEAD, discs([0.4, 0.0], weight=0.0)) == pytest.approx(AHEAD)


def test_direction_and_speed():
    assert direction_and_speed(np.array([0.0, 0.1]), 1.0) == pytest.approx((np.pi / 2, 0.1))
    assert direction_and_speed(np.zeros(2), 1.0) == (1.0, 0.0)
