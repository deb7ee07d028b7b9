"""What every baseline must do, whatever its method."""

from dataclasses import replace
from math import pi
from typing import get_args

import numpy as np
import pytest

from navigation.baselines.baseline_planner import BaselinePlanner
from navigation.baselines.choice import build_planner
from navigation.decision import Task
from navigation.mission import Mission
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.motion.planner import Planner
from navigation.parameters.motion import LandmarkParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.parameters.planner import Method, PlannerParameters

BASELINES = [m for m in get_args(Method) if m != "univector"]
EACH = pytest.mark.parametrize("method", BASELINES)
MIRROR = np.array([1.0, -1.0, -1.0])
FOOTSTEP, REACH = 0.34, 0.12


def planner(method, limits, seed=0):
    p = NavigationParameters(planner=PlannerParameters(method=method))
    return build_planner(p, limits, np.random.default_rng(seed))


class Body:
    """Walks as commanded once per footstep, with the acceleration it has."""

    def __init__(self, pose, limits):
        self.pose, self.body, self._limits = np.array(pose, float), np.zeros(3), limits

    def step(self, command):
        change = FOOTSTEP * np.array([self._limits.acceleration] * 2 + [2.0])
        self.body = self.body + np.clip(command - self.body, -change, change)
        forward, left, turn = self.body.tolist()
        h = self.pose[2] + 0.5 * FOOTSTEP * turn
        c, s = np.cos(h), np.sin(h)
        self.pose += FOOTSTEP * np.array([c * forward - s * left, s * forward + c * left, turn])


def scene(rng):
    places = rng.uniform(-1.2, 1.2, (7, 2))
    places = places[np.hypot(places[:, 0], places[:, 1]) > 0.35]
    speeds = np.where(np.arange(len(places))[:, None] % 2, rng.normal(0, 0.08, places.shape), 0.0)
    return places, speeds


def test_every_method_is_built(limits):
    assert isinstance(planner("univector", limits), Planner)
    assert all(isinstance(planner(m, limits), BaselinePlanner) for m in BASELINES)


@EACH
def test_done_stands_and_lost_turns_as_ours_does(method, belief, task, limits):
    for b, t in ((belief(), task(done=True)), (belief(lost=True), task())):
        ours = planner("univector", limits).plan(b, t).velocity
        assert planner(method, limits).plan(b, t).velocity == pytest.approx(ours)


@EACH
def test_an_empty_world_is_crossed_and_the_goal_arrived_at(method, belief, limits):
    start, goal, heading = (0.0, 0.0, 2.0), np.array([1.1, 0.4]), -1.0
    points = np.array([[0.5, -0.3], goal])
    mission = Mission(points, heading, False, NavigationParameters().mission)
    walker, planned = Body(start, limits), planner(method, limits)
    for _ in range(110):
        task = mission.update(walker.pose)
        if task.done:
            break
        walker.step(planned.plan(belief(pose=walker.pose), task).velocity)
    assert task.done
    assert task.index == 1
    assert np.hypot(*(walker.pose[:2] - goal)) < 0.08
    assert abs(np.angle(np.exp(1j * (walker.pose[2] - heading)))) < 0.1


@EACH
def test_commands_keep_to_the_envelope(method, belief, task, track, limits):
    rng = np.random.default_rng(2)
    low = np.array([-limits.vx_backward, -limits.vy, -limits.wz])
    high = np.array([limits.vx, limits.vy, limits.wz])
    for _ in range(15):
        places, speeds = scene(rng)
        tracks = [track(x, v, id=i) for i, (x, v) in enumerate(zip(places, speeds, strict=True))]
        planned = planner(method, limits)
        t = task(rng.uniform(-1.5, 1.5, 2), rng.uniform(-pi, pi), is_goal=True)
        for _ in range(2):
            decision = planned.plan(belief(tracks, (0, 0, rng.uniform(-pi, pi))), t)
            assert np.all(decision.velocity <= high + 1e-12)
            assert np.all(decision.velocity >= low - 1e-12)
            assert decision.speed == pytest.approx(np.hypot(*decision.velocity[:2]))


@EACH
def test_a_mirrored_world_mirrors_the_command(method, belief, task, track, limits):
    rng = np.random.default_rng(3)
    for _ in range(6):
        places, speeds = scene(rng)
        heading, target, arrival = rng.uniform(-1, 1), rng.uniform(0.6, 1.5, 2), rng.uniform(-1, 1)
        commands = []
        for sign in (1.0, -1.0):
            flip = np.array([1.0, sign])
            tracks = [
                track(x * flip, v * flip, id=i)
                for i, (x, v) in enumerate(zip(places, speeds, strict=True))
            ]
            planned = planner(method, limits)
            b, t = belief(tracks, (0, 0, sign * heading)), task(target * flip, sign * arrival)
            planned.plan(b, t)
            commands.append(planned.plan(b, t).velocity)
        assert commands[1] == pytest.approx(MIRROR * commands[0], abs=1e-6)
        assert np.abs(commands[0]).max() > 0.01


@EACH
def test_the_order_of_tracks_is_irrelevant(method, belief, task, track, limits):
    places, speeds = scene(np.random.default_rng(4))
    tracks = [track(x, v, id=i) for i, (x, v) in enumerate(zip(places, speeds, strict=True))]
    one = planner(method, limits).plan(belief(tracks), task())
    other = planner(method, limits).plan(belief(tracks[::-1]), task())
    assert other.velocity == pytest.approx(one.velocity, abs=1e-9)


@EACH
def test_it_walks_around_what_stands_in_the_way(method, belief, task, track, limits):
    walker, planned = Body((0.0, 0.02, 0.0), limits), planner(method, limits)
    least = 9.0
    for _ in range(60):
        b = belief([track((0.8, 0.0))], walker.pose)
        walker.step(planned.plan(b, task((1.6, 0.0))).velocity)
        least = min(least, float(np.hypot(*(walker.pose[:2] - [0.8, 0.0]))))
        if np.hypot(*(walker.pose[:2] - [1.6, 0.0])) < 0.15:
            break
    assert np.hypot(*(walker.pose[:2] - [1.6, 0.0])) < 0.15
    assert least > REACH + 0.08


@pytest.mark.parametrize("method", get_args(Method))
@pytest.mark.parametrize("aside", [-0.05, 0.02, 0.10])
def test_a_known_landmark_in_the_way_is_walked_round(method, aside, belief, task, limits):
    landmarks = LandmarkObstacles({"post": (1.5, 0.0)}, 0.05, LandmarkParameters())
    walker, planned = Body((0.0, aside, 0.0), limits), planner(method, limits)
    least = 9.0
    for _ in range(90):
        b = landmarks.added_to(belief(pose=walker.pose))
        walker.step(planned.plan(b, task((2.3, 0.0))).velocity)
        least = min(least, float(np.hypot(*(walker.pose[:2] - [1.5, 0.0]))))
        if np.hypot(*(walker.pose[:2] - [2.3, 0.0])) < 0.15:
            break
    assert np.hypot(*(walker.pose[:2] - [2.3, 0.0])) < 0.15
    assert least > REACH + 0.05


@pytest.mark.parametrize("method", get_args(Method))
@pytest.mark.parametrize("away", [0.6, 0.8, 1.05])
def test_a_goal_before_a_known_landmark_is_arrived_at(method, away, belief, limits):
    goal, heading = np.array([1.0, 0.0]), 0.0
    landmarks = LandmarkObstacles({"post": (1.0 + away, 0.0)}, 0.05, LandmarkParameters())
    mission = Mission(goal[None], heading, False, NavigationParameters().mission)
    walker, planned = Body((0.0, 0.2, 0.5), limits), planner(method, limits)
    for _ in range(90):
        task = mission.update(walker.pose)
        if task.done:
            break
        b = landmarks.added_to(belief(pose=walker.pose))
        walker.step(planned.plan(b, task).velocity)
    assert task.done


# The plain field knows no future: a mover that crosses is a disc that jumps.
@pytest.mark.parametrize("method", [m for m in BASELINES if m != "univector-plain"])
def test_it_does_not_touch_a_mover_that_crosses(method, belief, task, track, limits):
    walker, planned = Body((0.0, 0.0, 0.0), limits), planner(method, limits)
    mover, velocity = np.array([0.85, -0.5]), np.array([0.0, 0.11])
    straight, least = 9.0, 9.0
    for k in range(45):
        b = belief([track(mover, velocity)], walker.pose)
        walker.step(planned.plan(b, task((1.8, 0.0))).velocity)
        mover = mover + FOOTSTEP * velocity
        least = min(least, float(np.hypot(*(walker.pose[:2] - mover))))
        straight = min(straight, float(np.hypot(0.2 * FOOTSTEP * (k + 1) - mover[0], mover[1])))
    assert straight < 0.1
    assert least > REACH + 0.08
    assert walker.pose[0] > 1.2


@EACH
def test_long_lost_movers_are_forgotten(method, belief, task, track, limits):
    cloud = ([[3.0, 3.0]], [[0.0, 0.0]], [1.0])
    memory = PlannerParameters().memory
    for age, known in ((0.5 * memory, 1), (2.0 * memory, 0)):
        lost = track((0.6, 0.0), (0.0, 0.05), age=age, particles=cloud)
        decision = planner(method, limits).plan(belief([lost]), task())
        assert len(decision.extended_radii) == known


@EACH
def test_radii_shown_contain_robot_obstacle_margin_and_uncertainty(
    method, belief, task, track, limits
):
    parameters = PlannerParameters()
    margin = getattr(parameters, method.replace("-", "_")).margin
    tracks = [track((0.9, 0.9), id=1), track((0.9, -0.9), (0.05, 0.0), id=2, sigma=0.5)]
    radii = dict(planner(method, limits).plan(belief(tracks), task()).extended_radii)
    assert radii[1] == pytest.approx(0.12 + 0.08 + margin)
    assert radii[2] == pytest.approx(0.12 + 0.08 + margin + parameters.max_sigma)


@EACH
def test_at_the_goal_it_turns_in_place(method, belief, limits):
    t = Task(np.zeros(2), 0.6, True, 0, True, False)
    walker, planned = Body((0.0, 0.0, 0.0), limits), planner(method, limits)
    for _ in range(25):
        walker.step(planned.plan(belief(pose=walker.pose), t).velocity)
    assert walker.pose[2] == pytest.approx(0.6, abs=0.1)
    assert np.hypot(*walker.pose[:2]) < 0.05


def test_samples_come_from_the_generator_alone(belief, task, track, limits):
    b, t = belief([track((0.6, 0.05))]), task()
    first, again, other = (planner("mppi", limits, s).plan(b, t).velocity for s in (0, 0, 1))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_each_baseline_obeys_its_own_section(belief, task, track, limits):
    b, t = belief([track((0.5, 0.1))]), task()
    for method in BASELINES:
        name = method.replace("-", "_")
        near = PlannerParameters(method=method)
        far = replace(near, **{name: replace(getattr(near, name), margin=0.25)})
        commands = [
            build_planner(NavigationParameters(planner=p), limits, np.random.default_rng(0))
            .plan(b, t)
            .velocity
            for p in (near, far)
        ]
        assert not np.allclose(*commands), method


@EACH
def test_a_goal_beside_an_obstacle_is_reached(method, belief, track, limits):
    goal = np.array([0.9, 0.0])
    mission = Mission(goal[None], 0.0, False, NavigationParameters().mission)
    walker, planned = Body((0.0, 0.0, 0.0), limits), planner(method, limits)
    for _ in range(60):
        task = mission.update(walker.pose)
        if task.done:
            break
        b = belief([track((0.9, 0.45))], walker.pose)
        walker.step(planned.plan(b, task).velocity)
    assert task.done


@EACH
def test_near_the_goal_the_body_turns_to_the_goals_heading(method, belief, task, limits):
    """A via point at the same place leaves it on its way, which leads straight ahead."""
    turned = []
    for is_goal in (True, False):
        walker, planned = Body((0.0, 0.0, 0.0), limits), planner(method, limits)
        for _ in range(5):
            aim = task((0.44, 0.0), 0.6 if is_goal else 0.0, is_goal=is_goal)
            walker.step(planned.plan(belief(pose=walker.pose), aim).velocity)
        turned.append(walker.pose[2])
    assert turned[0] > abs(turned[1]) + 0.02


def test_orca_looks_farther_ahead_for_movers_than_for_what_stands(belief, task, track, limits):
    p = PlannerParameters(method="orca").orca
    gap = 0.5 * (p.static_horizon + p.horizon) * limits.vx
    place = (gap + 0.2 + p.margin, 0.0)
    free, standing, coming = (
        planner("orca", limits).plan(belief(tracks), task((4.0, 0.0))).velocity
        for tracks in ([], [track(place)], [track(place, (-0.1, 0.0))])
    )
    assert standing == pytest.approx(free)
    assert not np.allclose(coming, free)


def test_the_plain_field_gives_a_fast_mover_more_room(belief, task, track, limits):
    p = PlannerParameters().univector_plain
    edge = 0.2 + p.margin + p.d_e + p.d_b + p.eta_vo * 0.1
    slow, fast = (
        planner("univector-plain", limits)
        .plan(belief([track((edge, 0.02 - FOOTSTEP * v), (0.0, v))]), task((2.0, 0.0)))
        .velocity
        for v in (0.0, 0.2)
    )
    assert slow == pytest.approx([limits.vx, 0.0, 0.0])
    assert abs(fast[2]) > 1e-3
