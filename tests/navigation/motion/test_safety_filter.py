import numpy as np
import pytest

from navigation.motion.hypotheses import DISC
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.parameters.motion import SafetyFilterParameters, VelocityMappingParameters

HERE = np.zeros(3)
STANDING = np.zeros(3)
WALKING = (0.2, 0.0, 0.0)
AHEAD = np.array([0.2, 0.0])
ON_COURSE = None


def discs(places, velocities=None, radius=0.25, horizon=6.0, weight=1.0):
    places = np.atleast_2d(np.asarray(places, float))
    result = np.zeros(len(places), DISC).view(np.recarray)
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


def test_far_obstacles_do_not_matter(filter_):
    assert choose(filter_, AHEAD, discs([5.0, 0.0])) == pytest.approx(AHEAD)
    assert choose(filter_, AHEAD, discs([-0.6, 0.0], horizon=2.0)) == pytest.approx(AHEAD)


def test_the_choice_has_the_minimum_loss_of_all_candidates(filter_):
    rng, changed = np.random.default_rng(1), 0
    for _ in range(100):
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
    assert changed > 20


def test_a_disc_on_the_path_changes_the_velocity(filter_):
    d = discs([0.45, 0.02], horizon=2.0)
    v = choose(filter_, AHEAD, d, WALKING)
    assert v != pytest.approx(AHEAD)
    risks = filter_.risk(start(body=WALKING), np.stack([AHEAD, v]), d)
    assert risks[1] < 0.5 * risks[0]


def test_a_standing_robot_leaves_the_band_of_a_mover(filter_):
    v = choose(filter_, [0.0, 0.0], discs([0.7, 0.0], [-0.14, 0.0]))
    assert abs(v[1]) > 0.02


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


def test_the_rollout_obeys_the_limits_over_the_whole_horizon(filter_, limits):
    body = filter_.rollout(start(), filter_.candidates(AHEAD, 0.0))
    steps = round(SafetyFilterParameters().moving_horizon / limits.footstep)
    assert body.shape[1:] == (steps, 3)
    assert np.abs(body[..., 1]).max() <= limits.vy + 1e-12
    assert body[..., 0].min() >= -limits.vx_backward - 1e-12
    first = np.hypot(body[:, 0, 0], body[:, 0, 1])
    assert first.max() <= limits.acceleration * limits.footstep + 1e-9


def test_a_turned_body_is_rolled_out_along_its_course(filter_, limits):
    """The lateral speed limit slows the turned body down."""
    body = filter_.rollout(start((0.0, 0.0, 1.0), (0.05, -0.08, 0.0), 0.0, 1.0), AHEAD[None])
    vx, vy, wz = body[0, -1]
    assert np.arctan2(vy, vx) == pytest.approx(-1.0, abs=1e-9)
    assert np.hypot(vx, vy) == pytest.approx(limits.vy / np.sin(1.0))
    assert wz == 0.0


def test_weightless_hypotheses_do_not_matter(filter_):
    assert choose(filter_, AHEAD, discs([0.4, 0.0], weight=0.0)) == pytest.approx(AHEAD)


def test_a_standing_robot_keeps_its_course(filter_):
    there = start(course=1.0)
    velocity, direction = filter_.choose(there, np.zeros(2), discs([5.0, 0.0]))
    assert (velocity.tolist(), direction) == ([0.0, 0.0], 1.0)


def test_losses_do_not_depend_on_the_frame(filter_, rotation):
    rng, shift = np.random.default_rng(1), np.array([2.0, -1.0])
    for _ in range(20):
        places, velocities = rng.uniform(-1, 1, (8, 2)), rng.normal(0, 0.1, (8, 2))
        heading, a = rng.uniform(-3, 3, 2).tolist()
        desired, r, body = rng.normal(0, 0.1, 2), rotation(a), (0.1, 0.0, 0.2)
        course = float(np.arctan2(desired[1], desired[0]))
        losses = []
        for origin, turn, matrix in ((np.zeros(2), 0.0, np.eye(2)), (shift, a, r)):
            s = start((*origin, heading + turn), body, course + turn)
            candidates = filter_.candidates(matrix @ desired, course + turn)
            d = discs(places @ matrix.T + origin, velocities @ matrix.T)
            losses.append((filter_.risk(s, candidates, d), filter_.delay(s, candidates)))
        assert losses[1][0] == pytest.approx(losses[0][0], abs=1e-6)
        assert losses[1][1] == pytest.approx(losses[0][1], abs=1e-9)


def test_the_risk_is_mirrored_and_does_not_depend_on_the_order(filter_):
    rng = np.random.default_rng(2)
    places, velocities = rng.uniform(-1, 1, (8, 2)), rng.normal(0, 0.1, (8, 2))
    # No candidate is exactly behind: both turns towards it are equally short.
    candidates, flip = filter_.candidates(AHEAD, 0.05), np.array([1.0, -1.0])
    risk = filter_.risk(start(body=(0.1, 0.02, 0.1)), candidates, discs(places, velocities))
    mirrored = filter_.risk(
        start(body=(0.1, -0.02, -0.1)), candidates * flip, discs(places * flip, velocities * flip)
    )
    assert mirrored == pytest.approx(risk, abs=1e-9)
    order = discs(places[::-1], velocities[::-1])
    assert filter_.risk(start(body=(0.1, 0.02, 0.1)), candidates, order) == pytest.approx(risk)
