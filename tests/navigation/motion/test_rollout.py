"""Compiled functions against formulas over whole arrays."""

from math import inf, nan

import numpy as np
import pytest

from compilation.record import record
from navigation.angles import wrap_array
from navigation.motion import rollout as kernel
from navigation.motion.hypotheses import DISC
from navigation.parameters.motion import SafetyFilterParameters

ENVELOPE = (0.2, 0.1, 0.08, 0.8, 1.5)
GAIT = (0.34, 0.1, 0.4, 0.5, 0.096)


def body_velocity(course, speed, heading, facing):
    """The same over arrays."""
    forward, left = speed * np.cos(course - heading), speed * np.sin(course - heading)
    reach = np.where(forward >= 0.0, 0.2, 0.1)
    scale = 1.0 / np.maximum(1.0, np.maximum(np.abs(forward) / reach, np.abs(left) / 0.08))
    turn = np.clip(1.5 * wrap_array(facing - heading), -0.8, 0.8)
    return np.stack([scale * forward, scale * left, turn], axis=-1)


@pytest.fixture
def scene():
    """Candidates, present velocity."""
    rng = np.random.default_rng(0)
    candidates = np.concatenate([np.zeros((1, 2)), rng.uniform(-0.2, 0.2, (30, 2))])
    return candidates, np.array([0.1, 0.02, 0.3])


def test_body_velocities_obey_the_formula_over_arrays():
    inputs = np.random.default_rng(2).uniform(-4, 4, (4, 50))
    velocities = [kernel.body_velocity(c - h, v, f - h, ENVELOPE) for c, v, h, f in inputs.T]
    assert np.array(velocities) == pytest.approx(body_velocity(*inputs))


@pytest.mark.parametrize("facing", [nan, 2.0])
def test_footsteps_follow_one_another(scene, facing):
    candidates, now = scene
    footstep, change, turn_change, turn_first_angle, fast = GAIT
    speed = np.hypot(*candidates.T)
    direction = np.where(speed < 1e-9, 0.3, np.arctan2(candidates[:, 1], candidates[:, 0]))
    to = direction if np.isnan(facing) else np.full(len(candidates), facing)
    heading, body = np.full(len(candidates), 2.8), np.tile(now, (len(candidates), 1))
    velocity, duration = kernel.rollout(candidates, 2.8, 0.3, facing, now, ENVELOPE, GAIT, 4)
    for step in range(4):
        delta = body_velocity(direction, speed, heading, to) - body
        size = np.hypot(delta[:, 0], delta[:, 1])
        delta[:, :2] *= np.minimum(1.0, change / np.maximum(size, 1e-9))[:, None]
        delta[:, 2] = np.clip(delta[:, 2], -turn_change, turn_change)
        body = body + delta
        middle = heading + 0.5 * body[:, 2] * footstep
        c, s = np.cos(middle), np.sin(middle)
        moved = [c * body[:, 0] - s * body[:, 1], s * body[:, 0] + c * body[:, 1]]
        assert velocity[step] == pytest.approx(np.stack(moved, axis=1))
        heading = heading + body[:, 2] * footstep
    wait = np.maximum(0.0, np.abs(wrap_array(direction - heading)) - turn_first_angle) / 0.8
    assert duration[4] == pytest.approx(np.where(speed > fast, wait, 0.0))
    assert velocity[5] == pytest.approx(candidates)
    assert (duration[:4] == footstep).all()
    assert (duration[5] == inf).all()
    assert not velocity[4].any()


def test_penalties_are_the_sum_over_the_discs():
    rng = np.random.default_rng(3)
    time, closing = rng.uniform(0, 8, (20, 12)), rng.uniform(0, 0.2, (20, 12))
    time[rng.random((20, 12)) < 0.3] = inf
    depth, horizon, weight = rng.uniform(-1, 0.5, 12), rng.uniform(1, 6, 12), rng.uniform(0, 1, 12)
    each = np.maximum(0.0, 1.0 - time / horizon) * np.where(time < 1.5, 20.0, 6.0)
    within = (depth > 0.0) & (time < horizon)
    each += within * (10.0 + 40.0 * depth + 100.0 * closing)
    discs = np.zeros(12, DISC)
    discs["radius"], discs["horizon"], discs["weight"] = 0.2, horizon, weight
    discs["position"][:, 0] = 0.2 * (1.0 - depth)
    p = record(SafetyFilterParameters())
    result = kernel.penalties(time, closing, np.zeros(2), discs, p)
    assert result == pytest.approx(each @ weight)
