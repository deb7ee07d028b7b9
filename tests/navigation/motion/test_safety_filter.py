import numpy as np
import pytest

from navigation.motion.hypotheses import DISC
from navigation.motion.rollout import contact_times
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters

HERE = np.zeros(3)
STANDING = np.zeros(3)
AHEAD = np.array([0.2, 0.0])
ON_COURSE = None


def discs(places, velocities=None, radius=0.25, horizon=6.0, weight=1.0):
    places = np.atleast_2d(np.asarray(places, float))
    n = len(places)
    result = np.zeros(n, DISC).view(np.recarray)
    result.position, result.velocity = places, 0.0 if velocities is None else velocities
    result.radius, result.horizon, result.weight = radius, horizon, weight
    return result


def start(pose=HERE, body=STANDING, course=0.0, facing=ON_COURSE):
    return RolloutStart(np.asarray(pose), np.asarray(body), course, facing)


def filter_of(limits, **changes):
    return SafetyFilter(SafetyFilterParameters(**changes), VelocityMappingParameters(), limits)


def choose(limits, wanted, hypotheses):
    course = float(np.arctan2(wanted[1], wanted[0]))
    wanted = np.asarray(wanted, float)
    direction, speed = filter_of(limits).choose(start(course=course), wanted, hypotheses)
    return speed * np.array([np.cos(direction), np.sin(direction)])


def times(velocity, duration, d):
    return contact_times(velocity, duration, np.zeros(2), d.view(np.ndarray))


def test_contact_times_equal_brute_force():
    """2000 paths of three pieces against time stepping."""
    rng = np.random.default_rng(0)
    n, m, dt, end = 50, 40, 0.005, 8.0
    velocity = rng.normal(0, 0.2, (3, n, 2))
    duration = np.concatenate([rng.uniform(0, 2, (2, n)), np.full((1, n), np.inf)])
    d = discs(rng.uniform(-1.5, 1.5, (m, 2)), rng.normal(0, 0.15, (m, 2)), radius=0.2)
    time, _ = times(velocity, duration, d)
    point = np.zeros((n, 2))
    touched = np.full((n, m), np.inf)
    near = np.full((n, m), np.inf)
    for step in range(round(end / dt)):
        t = step * dt
        gap = point[:, None] - (d.position + t * d.velocity)
        distance = np.hypot(gap[..., 0], gap[..., 1])
        near = np.minimum(near, np.abs(distance - 0.2))
        fresh = (distance < 0.2) & np.isinf(touched)
        touched[fresh] = t
        piece = (t >= duration[0]).astype(int) + (t >= duration[0] + duration[1])
        point = point + dt * velocity[piece, np.arange(n)]
    outside = np.hypot(*d.position.T) > 0.2
    grazed = (near < 0.004) & np.isinf(touched)
    clear = outside[None, :] & ~grazed & (time < end - 0.1)
    late = np.where(clear, time, 0.0) - np.where(clear, touched, 0.0)
    assert (np.abs(late[clear]) < 0.03).mean() > 0.995
    missed = outside[None, :] & np.isinf(time) & np.isfinite(touched)
    assert not missed.any()
    assert clear.sum() > 100


def test_inside_leaving_is_free_and_closing_is_now():
    both = np.array([[[1.0, 0.0], [-1.0, 0.0]]])
    time, closing = times(both, np.full((1, 2), np.inf), discs([-0.1, 0.0]))
    assert time[:, 0].tolist() == [np.inf, 0.0]
    assert closing[:, 0] == pytest.approx([0.0, 1.0])


def test_without_near_obstacles_the_wanted_velocity_stays(limits):
    assert choose(limits, AHEAD, discs([5.0, 0.0])) == pytest.approx(AHEAD)
    assert choose(limits, AHEAD, discs([-0.6, 0.0], horizon=2.0)) == pytest.approx(AHEAD)


def test_a_disc_on_the_path_changes_the_velocity(limits):
    v = choose(limits, AHEAD, discs([0.45, 0.02], horizon=2.0))
    assert v != pytest.approx(AHEAD)
    time, _ = times(v[None, None], np.full((1, 1), np.inf), discs([0.45, 0.02]))
    assert time[0, 0] > 1.5


def test_a_standing_robot_leaves_the_band_of_a_mover(limits):
    v = choose(limits, [0.0, 0.0], discs([0.7, 0.0], [-0.14, 0.0]))
    assert abs(v[1]) > 0.02


def test_without_footsteps_the_path_is_turn_then_straight(limits):
    candidates = np.array([[-0.2, 0.0], [0.2, 0.0], [0.0, 0.05]])
    velocity, duration = filter_of(limits, steps=0).rollout(start(), candidates)
    assert duration[0] == pytest.approx([(np.pi - 0.5) / limits.wz, 0.0, 0.0])
    assert velocity[0] == pytest.approx(np.zeros((3, 2)))
    assert velocity[1, 0] == pytest.approx([-0.2, 0.0])


def test_the_rollout_obeys_the_limits(limits):
    filter_ = filter_of(limits)
    velocity, _ = filter_.rollout(start(), filter_.candidates(AHEAD, 0.0))
    speed = np.hypot(velocity[..., 0], velocity[..., 1])[: SafetyFilterParameters().steps]
    assert speed.max() <= limits.vx + 1e-9
    assert speed[0].max() <= limits.acceleration * limits.footstep + 1e-9


def test_a_turned_body_is_rolled_out_along_its_course(limits):
    """The lateral speed limit slows the turned body down."""
    turned, straight = (
        filter_of(limits).rollout(start((0.0, 0.0, a), body, 0.0, a), AHEAD[None])
        for a, body in ((1.0, (0.05, -0.08, 0.0)), (0.0, (0.2, 0.0, 0.0)))
    )
    last = turned[0][-3, 0]
    assert np.arctan2(last[1], last[0]) == pytest.approx(0.0, abs=1e-9)
    assert last[0] == pytest.approx(limits.vy / np.sin(1.0))
    assert straight[0][-3, 0] == pytest.approx(AHEAD)


def test_weightless_hypotheses_do_not_matter(limits):
    assert choose(limits, AHEAD, discs([0.4, 0.0], weight=0.0)) == pytest.approx(AHEAD)


def test_a_standing_robot_keeps_its_course(limits):
    there = start(course=1.0)
    assert filter_of(limits).choose(there, np.zeros(2), discs([5.0, 0.0])) == (1.0, 0.0)


def test_the_penalty_does_not_depend_on_the_frame(limits, rotation):
    rng, filter_, shift = np.random.default_rng(1), filter_of(limits), np.array([2.0, -1.0])
    for _ in range(20):
        places, velocities = rng.uniform(-1, 1, (8, 2)), rng.normal(0, 0.1, (8, 2))
        heading, a = rng.uniform(-3, 3, 2).tolist()
        wanted, r, body = rng.normal(0, 0.1, 2), rotation(a), (0.1, 0.0, 0.2)
        course = float(np.arctan2(wanted[1], wanted[0]))
        here, there = (
            filter_.penalty(
                start((*origin, heading + turn), body, course + turn),
                filter_.candidates(matrix @ wanted, course + turn),
                discs(places @ matrix.T + origin, velocities @ matrix.T),
            )
            for origin, turn, matrix in ((np.zeros(2), 0.0, np.eye(2)), (shift, a, r))
        )
        assert here == pytest.approx(there, abs=1e-6)
