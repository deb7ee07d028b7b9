from dataclasses import replace

import numpy as np
import pytest

from navigation.baselines.planning_scene import PlanningScene
from navigation.baselines.sampling import contact_cost, gaps, rollout
from navigation.belief.tracks import Tracks
from navigation.decision import Task
from navigation.parameters.navigation import NavigationParameters

DT = 0.34


def scene(tracks, limits, pose=(0.0, 0.0, 0.0), body=(0.0, 0.0, 0.0)):
    obstacles = Tracks.of(tracks)
    return PlanningScene(
        pose=np.array(pose, float),
        body=np.array(body, float),
        obstacles=obstacles,
        inflation=np.zeros(len(obstacles)),
        task=Task(np.array([2.0, 0.0]), 0.0, False, 0, False, False),
        course=0.0,
        speed=0.2,
        facing=None,
        side=0,
        limits=limits,
        parameters=NavigationParameters(),
    )


def test_a_constant_turn_walks_a_circle():
    body = np.broadcast_to([0.2, 0.0, 0.5], (1, 40, 3))
    position, heading = rollout(np.zeros(3), body, DT)
    middle = np.array([0.0, 0.4])
    assert np.hypot(*(position[0] - middle).T) == pytest.approx(0.4, abs=0.002)
    assert heading[0, -1] == pytest.approx(40 * DT * 0.5)


def test_gaps_equal_brute_force(tracks, limits):
    rng = np.random.default_rng(0)
    obstacles = tracks(rng.uniform(-1, 1, (6, 2)), rng.normal(0, 0.1, (6, 2)))
    s = scene(obstacles, limits)
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


def test_obstacles_within_lateral_reach_count(track, limits):
    wide = replace(limits, vy=0.5)
    s = scene([track((0.0, 1.4))], wide)
    aside = np.zeros((1, 6, 3))
    aside[..., 1] = wide.vy
    position, _ = rollout(s.pose, aside, DT)
    gap = gaps(position, s, np.array([0.2]), 0.3)
    assert gap[0, -1] == pytest.approx(1.4 - 6 * DT * 0.5 - 0.2)


def test_an_earlier_collision_costs_more():
    gap = np.full((4, 5), 0.3)
    gap[1, 3] = gap[2, 1] = gap[3, 0] = -0.01
    cost = contact_cost(gap)
    assert cost[0] == 0.0
    assert cost.tolist() == sorted(cost.tolist())
    assert cost[3] == pytest.approx(1.01)


def test_the_predicted_scene_is_a_footstep_later(track, limits):
    s = scene([track((1.0, 0.0), (0.0, 0.1))], limits, (0, 0, np.pi / 2), (0.1, 0.0, 0.2))
    later = s.predicted()
    assert later.pose == pytest.approx([0.0, 0.034, np.pi / 2 + 0.068])
    assert later.obstacles.position[0] == pytest.approx([1.0, 0.034])
    assert later.body == pytest.approx(s.body)


def test_walking_turns_to_the_motion(limits):
    s = scene([], limits)
    aside = np.array([0.0, 0.1])
    assert s.walk(aside) == pytest.approx([0.0, limits.vy, limits.wz])
    assert s.walk(np.zeros(2)) == pytest.approx(0.0)
