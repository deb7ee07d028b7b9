from dataclasses import replace

import numpy as np
import pytest

from navigation.baselines.sampling import DynamicWindow, PathIntegral, gaps, rollout
from navigation.parameters.planner import DwaParameters, MppiParameters

DT = 0.34


def test_a_constant_turn_walks_a_circle():
    body = np.broadcast_to([0.2, 0.0, 0.5], (1, 40, 3))
    position, heading = rollout(np.zeros(3), body, DT)
    middle = np.array([0.0, 0.4])
    assert np.hypot(*(position[0] - middle).T) == pytest.approx(0.4, abs=0.002)
    assert heading[0, -1] == pytest.approx(40 * DT * 0.5)


def test_gaps_equal_brute_force(tracks, planning):
    rng = np.random.default_rng(0)
    obstacles = tracks(rng.uniform(-1, 1, (6, 2)), rng.normal(0, 0.1, (6, 2)))
    s = planning(obstacles)
    position = rng.uniform(-1, 1, (5, 8, 2))
    radii = rng.uniform(0.1, 0.3, 6)
    most = 0.8
    result = gaps(position, s, radii, most)
    for k in range(5):
        for t in range(8):
            there = [x.position + DT * (t + 1) * x.velocity for x in obstacles]
            least = min(
                float(np.hypot(*(position[k, t] - x))) - r
                for x, r in zip(there, radii, strict=True)
            )
            assert result[k, t] == pytest.approx(min(most, least))


def test_the_window_is_what_one_footstep_reaches(planning):
    """A slow robot far from its goal takes the highest speed within reach."""
    s = planning(body=(0.05, 0.0, 0.0))
    w = DynamicWindow(DwaParameters()).desired(s)
    assert np.all(np.abs(w.body - s.body) <= s.change() + 1e-12)
    assert w.body[0] == pytest.approx(0.05 + s.change()[0])


def test_samples_come_from_the_generator_alone(planner, scene, belief, task, track):
    s = scene(belief([track((0.6, 0.05))]), task())
    first, again, other = (
        planned.plan(planned.begin(), s)[0].velocity
        for planned in (planner("mppi", rng=np.random.default_rng(seed)) for seed in (0, 0, 1))
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


class Silent:
    """Generator of zeros: all samples are the plan."""

    def standard_normal(self, shape):
        return np.zeros(shape)


def test_the_plan_of_mppi_lives_in_the_memory_alone(planning, task):
    """A planner that has decided elsewhere decides as a fresh one; the plan is shifted by one."""

    def method():
        return PathIntegral(MppiParameters(spread=0.0), Silent())

    used, s = method(), planning(task=task((2.0, 0.5)))
    plan = np.zeros((MppiParameters().steps, 3))
    plan[:, 0] = np.linspace(0.05, 0.15, len(plan))
    used.desired(replace(s, plan=plan))
    for kept in (None, plan):
        one, other = (m.desired(replace(s, plan=kept)) for m in (used, method()))
        assert np.array_equal(one.body, other.body)
        assert np.array_equal(one.plan, other.plan)
    start = used.desired(replace(s, plan=plan))
    assert len(start.plan) == len(plan)
    assert np.array_equal(start.plan[-1], start.plan[-2])
    assert start.plan[0] != pytest.approx(start.body)
