"""Properties of all baselines in closed loop; those of every planner are in motion/test_planner."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest

from navigation.mission import Mission
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters
from navigation.parameters.navigation import MissionParameters
from navigation.parameters.planner import Method, PlannerParameters

BASELINES = [m for m in get_args(Method) if m not in {"univector", "paper"}]
EACH = pytest.mark.parametrize("method", BASELINES)
# The method of the paper, which does not pass every obstacle, has its own tests.
AVOIDING = pytest.mark.parametrize("method", ["univector", *BASELINES])
FOOTSTEP, REACH = 0.34, 0.12


@AVOIDING
def test_an_empty_world_is_crossed_and_the_goal_reached(method, walker):
    goal, heading = np.array([1.1, 0.4]), -1.0
    mission = Mission(np.array([[0.5, -0.3], goal]), heading, False, MissionParameters())
    walk = walker(method, (0.0, 0.0, 2.0))
    task = walk.arrive(mission, 110)
    assert task.done
    assert task.index == 1
    assert walk.distance(goal) < 0.08
    assert abs(np.angle(np.exp(1j * (walk.pose[2] - heading)))) < 0.1


@AVOIDING
def test_an_obstacle_on_the_path_is_passed(method, walker, task, track):
    walk = walker(method, (0.0, 0.02, 0.0))
    least = walk.pass_by((0.8, 0.0), task((1.6, 0.0)), tracks=[track((0.8, 0.0))])
    assert least > REACH + 0.08


@AVOIDING
def test_a_known_landmark_on_the_path_is_passed(method, walker, task):
    landmarks = LandmarkObstacles({"post": (1.5, 0.0)}, 0.05, LandmarkParameters())
    walk = walker(method, (0.0, -0.05, 0.0))
    assert walk.pass_by((1.5, 0.0), task((2.3, 0.0)), landmarks=landmarks) > REACH + 0.05


@AVOIDING
def test_a_crossing_mover_is_avoided(method, walker, task, track):
    walk = walker(method)
    mover, velocity = np.array([0.85, -0.5]), np.array([0.0, 0.11])
    straight, least = 9.0, 9.0
    for k in range(45):
        walk.step(task((1.8, 0.0)), [track(mover, velocity)])
        mover = mover + FOOTSTEP * velocity
        least = min(least, walk.distance(mover))
        straight = min(straight, float(np.hypot(0.2 * FOOTSTEP * (k + 1) - mover[0], mover[1])))
    assert straight < 0.1
    assert least > REACH + 0.08
    assert walk.pose[0] > 1.2


@EACH
def test_published_radii_contain_robot_obstacle_margin_and_uncertainty(
    method, plan, parameters, belief, task, track
):
    margin = getattr(PlannerParameters(), method.replace("-", "_")).margin
    tracks = [track((0.9, 0.9), id=1), track((0.9, -0.9), (0.05, 0.0), id=2, sigma=0.5)]
    radii = dict(plan(method, belief(tracks), task()).extended_radii)
    assert radii[1] == pytest.approx(0.12 + 0.08 + margin)
    most = parameters(method).planner.max_sigma
    assert radii[2] == pytest.approx(0.12 + 0.08 + margin + most)


@EACH
def test_no_baseline_is_vetoed_by_the_safety_filter(
    method, planner, parameters, scene, belief, task, track
):
    """The comparison is with the published methods."""
    b = belief([track((0.4, 0.05), (-0.1, 0.0))])
    velocities = []
    for enabled in (True, False):
        p = parameters(method)
        p = replace(p, safety_filter=replace(p.safety_filter, enabled=enabled))
        planned = planner(method, parameters=p)
        decision, _ = planned.plan(planned.begin(), scene(b, task(), p))
        velocities.append(decision.velocity.tolist())
    assert velocities[0] == velocities[1]
