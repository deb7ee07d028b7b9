"""Compiled functions against formulas over whole arrays, and the limits of the body."""

from math import inf, nan

import numpy as np
import pytest

from compilation.record import record
from navigation.angles import wrap_array
from navigation.motion import rollout as kernel
from navigation.motion.hypotheses import Disc
from navigation.parameters.motion import SafetyFilterParameters

ENVELOPE = (0.2, 0.1, 0.08, 0.8, 1.5)
FOOTSTEP, CHANGE, TURN_CHANGE = GAIT = (0.34, 0.1, 0.4)
STANDING = np.zeros(3)


def body_velocity(course, speed, heading, facing):
    """The same over arrays."""
    forward, left = speed * np.cos(course - heading), speed * np.sin(course - heading)
    reach = np.where(forward >= 0.0, 0.2, 0.1)
    scale = 1.0 / np.maximum(1.0, np.maximum(np.abs(forward) / reach, np.abs(left) / 0.08))
    turn = np.clip(1.5 * wrap_array(facing - heading), -0.8, 0.8)
    return np.stack([scale * forward, scale * left, turn], axis=-1)


@pytest.fixture
def candidates():
    rng = np.random.default_rng(0)
    return np.concatenate([np.zeros((1, 2)), rng.uniform(-0.2, 0.2, (30, 2))])


def followed(candidates, heading=0.0, facing=nan, now=STANDING, steps=10):
    return kernel.followed(
        np.asarray(candidates, float), heading, 0.3, facing, np.asarray(now, float), ENVELOPE,
        GAIT, steps,
    )  # fmt: skip


def test_body_velocities_obey_the_formula_over_arrays():
    inputs = np.random.default_rng(2).uniform(-4, 4, (4, 50))
    velocities = [kernel.body_velocity(c - h, v, f - h, ENVELOPE) for c, v, h, f in inputs.T]
    assert np.array(velocities) == pytest.approx(body_velocity(*inputs))


@pytest.mark.parametrize("facing", [nan, 2.0])
def test_footsteps_follow_one_another(candidates, facing):
    now = np.array([0.1, 0.02, 0.3])
    speed = np.hypot(*candidates.T)
    direction = np.where(speed < 1e-9, 0.3, np.arctan2(candidates[:, 1], candidates[:, 0]))
    to = direction if np.isnan(facing) else np.full(len(candidates), facing)
    heading, body = np.full(len(candidates), 2.8), np.tile(now, (len(candidates), 1))
    result = followed(candidates, 2.8, facing, now, 6)
    assert result.shape == (len(candidates), 6, 3)
    for step in range(6):
        delta = body_velocity(direction, speed, heading, to) - body
        size = np.hypot(delta[:, 0], delta[:, 1])
        delta[:, :2] *= np.minimum(1.0, CHANGE / np.maximum(size, 1e-9))[:, None]
        delta[:, 2] = np.clip(delta[:, 2], -TURN_CHANGE, TURN_CHANGE)
        body = body + delta
        assert result[:, step] == pytest.approx(body)
        heading = heading + body[:, 2] * FOOTSTEP


def test_a_fixed_heading_walks_sideways_at_once_and_at_the_lateral_limit():
    """Formerly the robot stood for the time of the turn, then walked at full speed."""
    body = followed([[0.0, 0.2], [0.0, -0.2]], facing=0.0)
    assert np.abs(body[:, :, 1]) == pytest.approx(0.08)
    assert np.sign(body[:, 0, 1]).tolist() == [1.0, -1.0]
    assert not body[..., 2].any()
    velocity, _ = kernel.walked(body, 0.0, FOOTSTEP)
    distance = FOOTSTEP * velocity.sum(axis=1)
    assert distance[:, 1] == pytest.approx([0.08 * 3.4, -0.08 * 3.4])


def test_a_candidate_behind_turns_at_once_and_is_walked_meanwhile():
    body = followed([[-0.2, 0.01], [-0.2, -0.01]])
    assert body[:, 0, 2] == pytest.approx([TURN_CHANGE, -TURN_CHANGE])
    velocity, heading = kernel.walked(body, 0.0, FOOTSTEP)
    assert np.all(velocity[:, 0, 0] < -0.05)
    assert np.abs(heading[:, -1]).min() > 1.5


def discs(places, velocities=None, radius=0.2, horizon=6.0):
    places = np.atleast_2d(np.asarray(places, float))
    result = np.zeros(len(places), Disc)
    result["position"], result["radius"] = places, radius
    result["velocity"] = 0.0 if velocities is None else velocities
    result["horizon"], result["weight"] = horizon, 1.0
    return result


def contacts(velocity, hypotheses, position=(0.0, 0.0)):
    velocity = np.atleast_3d(np.asarray(velocity, float))
    return kernel.contact_times(velocity, FOOTSTEP, np.array(position), hypotheses)


def test_contact_times_and_gaps_equal_brute_force():
    """Paths of 20 footsteps against time stepping."""
    rng = np.random.default_rng(0)
    n, m, steps, dt = 40, 40, 20, 0.34 / 68
    velocity = rng.normal(0, 0.2, (n, steps, 2))
    velocity = np.repeat(velocity[:, ::4], 4, axis=1)  # straight pieces, which go somewhere
    d = discs(rng.uniform(-1.5, 1.5, (m, 2)), rng.normal(0, 0.15, (m, 2)))
    first, gap, _ = contacts(velocity, d)
    fine = np.repeat(velocity, 68, axis=1)
    path = np.concatenate([np.zeros((n, 1, 2)), dt * np.cumsum(fine, axis=1)], axis=1)
    time = dt * np.arange(path.shape[1])
    outside = np.hypot(*d["position"].T) > 0.2
    assert outside.sum() > 20
    compared = 0
    for j in np.flatnonzero(outside).tolist():
        centre = d["position"][j] + time[:, None] * d["velocity"][j]
        distance = np.hypot(*np.moveaxis(path - centre, -1, 0))
        inside = distance < 0.2
        touched = np.where(inside.any(axis=1), time[inside.argmax(axis=1)], inf)
        clear = np.abs(distance.min(axis=1) - 0.2) > 0.003  # neither grazes nor just misses
        assert np.array_equal(np.isfinite(first[clear, j]), np.isfinite(touched[clear]))
        hit = np.isfinite(first[:, j]) & clear
        assert first[hit, j] == pytest.approx(touched[hit], abs=0.02)
        assert gap[hit, j] == pytest.approx(0.0, abs=1e-9)
        free = np.isinf(first[:, j]) & np.isinf(touched)
        assert gap[free, j] == pytest.approx(distance[free].min(axis=1) - 0.2, abs=0.003)
        compared += hit.sum()
    assert compared > 100


def test_inside_leaving_is_free_and_closing_is_now():
    both = np.array([[[1.0, 0.0]], [[-1.0, 0.0]]])
    first, gap, closing = contacts(both, discs([-0.1, 0.0]))
    assert first[:, 0].tolist() == [inf, 0.0]
    assert closing[:, 0] == pytest.approx([0.0, 1.0])
    assert gap[0, 0] == pytest.approx(-0.1)


def test_losses_are_the_sum_over_the_discs():
    p = SafetyFilterParameters(close_loss=3.0)
    rng = np.random.default_rng(3)
    first, closing = rng.uniform(0, 8, (20, 12)), rng.uniform(0, 0.2, (20, 12))
    first[rng.random((20, 12)) < 0.3] = inf
    gap = rng.uniform(0.0, 0.1, (20, 12))
    depth, horizon, weight = rng.uniform(-1, 0.5, 12), rng.uniform(1, 6, 12), rng.uniform(0, 1, 12)
    collides = first < horizon
    each = np.where(first < p.urgent_time, p.urgent_loss, p.collision_loss)
    each = np.where(collides, (1.0 - np.minimum(first, horizon) / horizon) * each, 0.0)
    inside = p.inside_loss + p.depth_loss * depth + p.closing_loss * closing / 0.2
    each += collides * (depth > 0.0) * inside
    close = ~collides & (gap < p.comfort)
    each += close * p.close_loss * (1.0 - gap / p.comfort)
    d = discs(np.zeros((12, 2)))
    d["horizon"], d["weight"] = horizon, weight
    d["position"][:, 0] = 0.2 * (1.0 - depth)
    result = kernel.losses((first, gap, closing), np.zeros(2), d, 0.2, record(p))
    assert result == pytest.approx(each @ weight)
