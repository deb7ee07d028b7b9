import numpy as np
import pytest

from navigation.motion.hypotheses import Disc
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters

HERE = np.zeros(3)
STANDING = np.zeros(3)
WALKING = (0.2, 0.0, 0.0)
AHEAD = np.array([0.2, 0.0])
ON_COURSE = None


def discs(places, velocities=None, radius=0.25, horizon=6.0, weight=1.0):
    places = np.atleast_2d(np.asarray(places, float))
    result = np.zeros(len(places), Disc).view(np.recarray)
    result.position, result.velocity = places, 0.0 if velocities is None else velocities
    result.radius, result.horizon, result.weight = radius, horizon, weight
    return result


def start(pose=HERE, body=STANDING, course=0.0, facing=ON_COURSE):
    return RolloutStart(np.asarray(pose, float), np.asarray(body, float), course, facing)


@pytest.fixture
def filter_(limits):
    return SafetyFilter(SafetyFilterParameters(), VelocityMappingParameters(), limits)


def choose(filter_, desired, hypotheses, body=STANDING):
    course = float(np.arctan2(desired[1], desired[0]))
    desired = np.asarray(desired, float)
    velocity, _ = filter_.choose(start(body=body, course=course), desired, hypotheses)
    return velocity


def test_a_safe_velocity_passes_unchanged(filter_):
    """A veto, not an optimizer."""
    rng, passed = np.random.default_rng(0), 0
    for _ in range(200):
        d = discs(rng.uniform(-1.5, 1.5, (6, 2)), rng.normal(0, 0.08, (6, 2)), horizon=3.0)
        desired = rng.normal(0, 0.1, 2)
        desired *= min(1.0, 0.2 / np.hypot(*desired))
        course = float(np.arctan2(desired[1], desired[0]))
        if filter_.risk(start(course=course), desired[None], d)[0] == 0.0:
            assert choose(filter_, desired, d) == pytest.approx(desired)
            passed += 1
    assert 20 < passed < 190


def test_the_choice_has_the_minimum_loss_of_all_candidates(filter_):
    rng, changed = np.random.default_rng(1), 0
    for _ in range(30):
        d = discs(rng.uniform(-1, 1, (5, 2)), rng.normal(0, 0.1, (5, 2)))
        s, desired = start(body=(0.15, 0.0, 0.1), course=0.2), np.array([0.196, 0.04])
        candidates = filter_.candidates(desired, 0.2)
        loss = filter_.risk(s, candidates, d) + filter_.delay(s, candidates)
        v, direction = filter_.choose(s, desired, d)
        if v is not desired:
            assert np.hypot(*v) * np.exp(1j * direction) == pytest.approx(v[0] + 1j * v[1])
        chosen = int(np.argmin(np.hypot(*(candidates - v).T)))
        assert v == pytest.approx(candidates[chosen], abs=1e-9)
        if filter_.risk(s, desired[None], d)[0] > 0.0:
            assert loss[chosen] == pytest.approx(loss.min())
            changed += 1
    assert changed > 6


def test_a_standing_robot_leaves_the_band_of_a_mover(filter_):
    v, direction = filter_.choose(start(), np.zeros(2), discs([0.7, 0.0], [-0.14, 0.0]))
    assert abs(v[1]) > 0.02
    assert direction == pytest.approx(np.arctan2(v[1], v[0]))


def test_a_collision_beyond_the_horizon_of_its_disc_does_not_matter(filter_):
    """0.6 m ahead at 0.2 m/s: 1.75 s to the disc when already walking."""
    for horizon, vetoed in ((1.5, False), (2.0, True)):
        v = choose(filter_, AHEAD, discs([0.6, 0.0], horizon=horizon), WALKING)
        assert (v != pytest.approx(AHEAD)) == vetoed


def test_the_candidates_are_the_wanted_velocity_zero_and_a_fan(filter_, limits):
    p, desired = SafetyFilterParameters(), np.array([0.03, 0.05])
    candidates = filter_.candidates(desired, 0.7)
    assert len(candidates) == 2 + p.headings * p.speeds
    assert candidates[0] == pytest.approx(desired)
    assert not candidates[1].any()
    speed = np.hypot(*candidates[2:].T)
    assert speed.max() == pytest.approx(limits.vx)
    assert speed.min() == pytest.approx(limits.vx / p.speeds)
    ahead = limits.vx * np.array([np.cos(0.7), np.sin(0.7)])
    assert np.hypot(*(candidates - ahead).T).min() < 1e-12


def test_the_delay_is_the_lost_way_and_grows_with_the_detour(filter_):
    s = start(body=WALKING)
    angles = np.linspace(0.0, np.pi, 20)
    turned = 0.2 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    slower = np.linspace(1.0, 0.0, 20)[:, None] * AHEAD
    for candidates in (turned, slower):
        delay = filter_.delay(s, candidates)
        assert delay[0] == pytest.approx(0.0)
        assert np.all(np.diff(delay) > 0.0)
    p = SafetyFilterParameters()
    steps = round(p.moving_horizon / 0.34)
    assert filter_.delay(s, slower)[-1] == pytest.approx(0.34 * steps + p.change_loss)


def test_a_standing_robot_keeps_its_course(filter_):
    there = start(course=1.0)
    velocity, direction = filter_.choose(there, np.zeros(2), discs([5.0, 0.0]))
    assert (velocity.tolist(), direction) == ([0.0, 0.0], 1.0)
