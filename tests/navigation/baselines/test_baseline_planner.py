"""Properties of all baselines."""

from dataclasses import replace
from math import pi
from typing import get_args

import numpy as np
import pytest

from navigation.baselines.choice import build_planner
from navigation.mission import Mission
from navigation.motion.landmark_obstacles import LandmarkObstacles
from navigation.parameters.motion import LandmarkParameters
from navigation.parameters.navigation import MissionParameters, NavigationParameters
from navigation.parameters.planner import Method, PlannerParameters

BASELINES = [m for m in get_args(Method) if m != "univector"]
EACH = pytest.mark.parametrize("method", BASELINES)
MIRROR = np.array([1.0, -1.0, -1.0])
FOOTSTEP, REACH = 0.34, 0.12


def planner(method, limits, seed=0):
    p = NavigationParameters(planner=PlannerParameters(method=method))
    return build_planner(p, limits, np.random.default_rng(seed))


class Walker:
    """Closed loop of a planner and a body with acceleration limits."""

    def __init__(self, planned, pose, limits, belief, advance):
        self.pose, self.body = np.array(pose, float), np.zeros(3)
        self._planner, self._belief, self._advance = planned, belief, advance
        self._change = FOOTSTEP * np.array([limits.acceleration] * 2 + [2.0])

    def step(self, task, tracks=(), landmarks=None):
        b = self._belief(tracks, self.pose)
        command = self._planner.plan(b if landmarks is None else landmarks.added_to(b), task)
        self.body += np.clip(command.velocity - self.body, -self._change, self._change)
        self.pose = self._advance(self.pose, self.body, FOOTSTEP)

    def distance(self, point):
        return float(np.hypot(*(self.pose[:2] - point)))

    def arrive(self, mission, footsteps=90, **scene):
        for _ in range(footsteps):
            task = mission.update(self.pose)
            if task.done:
                break
            self.step(task, **scene)
        return task

    def pass_by(self, obstacle, task, **scene):
        """Walk to the target of `task`; return the minimum distance to `obstacle`."""
        least = 9.0
        for _ in range(90):
            self.step(task, **scene)
            least = min(least, self.distance(obstacle))
            if self.distance(task.target) < 0.15:
                return least
        return 0.0


@pytest.fixture
def walker(limits, belief, advance):
    """Builds a closed loop of a method from a pose."""

    def walker(method, pose=(0.0, 0.0, 0.0)):
        return Walker(planner(method, limits), pose, limits, belief, advance)

    return walker


def scene(rng):
    places = rng.uniform(-1.2, 1.2, (7, 2))
    places = places[np.hypot(places[:, 0], places[:, 1]) > 0.35]
    speeds = np.where(np.arange(len(places))[:, None] % 2, rng.normal(0, 0.08, places.shape), 0.0)
    return places, speeds


@EACH
def test_done_stands_and_lost_turns_as_the_default_planner_does(method, belief, task, limits):
    for b, t in ((belief(), task(done=True)), (belief(lost=True), task())):
        default = planner("univector", limits).plan(b, t).velocity
        assert planner(method, limits).plan(b, t).velocity == pytest.approx(default)


@EACH
def test_an_empty_world_is_crossed_and_the_goal_reached(method, walker):
    goal, heading = np.array([1.1, 0.4]), -1.0
    mission = Mission(np.array([[0.5, -0.3], goal]), heading, False, MissionParameters())
    walk = walker(method, (0.0, 0.0, 2.0))
    task = walk.arrive(mission, 110)
    assert task.done
    assert task.index == 1
    assert walk.distance(goal) < 0.08
    assert abs(np.angle(np.exp(1j * (walk.pose[2] - heading)))) < 0.1


@EACH
def test_commands_obey_the_speed_limits(method, belief, task, tracks, limits):
    rng = np.random.default_rng(2)
    low = np.array([-limits.vx_backward, -limits.vy, -limits.wz])
    high = np.array([limits.vx, limits.vy, limits.wz])
    for _ in range(15):
        places, speeds = scene(rng)
        planned, obstacles = planner(method, limits), tracks(places, speeds)
        t = task(rng.uniform(-1.5, 1.5, 2), rng.uniform(-pi, pi), is_goal=True)
        for _ in range(2):
            decision = planned.plan(belief(obstacles, (0, 0, rng.uniform(-pi, pi))), t)
            assert np.all(decision.velocity <= high + 1e-12)
            assert np.all(decision.velocity >= low - 1e-12)
            assert decision.speed == pytest.approx(np.hypot(*decision.velocity[:2]))


@EACH
def test_a_mirrored_world_mirrors_the_command(method, belief, task, tracks, limits):
    rng = np.random.default_rng(3)
    for _ in range(6):
        places, speeds = scene(rng)
        heading, target, arrival = rng.uniform(-1, 1), rng.uniform(0.6, 1.5, 2), rng.uniform(-1, 1)
        commands = []
        for sign in (1.0, -1.0):
            flip = np.array([1.0, sign])
            planned, t = planner(method, limits), task(target * flip, sign * arrival)
            b = belief(tracks(places * flip, speeds * flip), (0, 0, sign * heading))
            planned.plan(b, t)
            commands.append(planned.plan(b, t).velocity)
        assert commands[1] == pytest.approx(MIRROR * commands[0], abs=1e-6)
        assert np.abs(commands[0]).max() > 0.01


@EACH
def test_the_order_of_tracks_is_irrelevant(method, belief, task, tracks, limits):
    obstacles = tracks(*scene(np.random.default_rng(4)))
    one = planner(method, limits).plan(belief(obstacles), task())
    other = planner(method, limits).plan(belief(obstacles[::-1]), task())
    assert other.velocity == pytest.approx(one.velocity, abs=1e-9)


@EACH
def test_an_obstacle_on_the_path_is_passed(method, walker, task, track):
    walk = walker(method, (0.0, 0.02, 0.0))
    least = walk.pass_by((0.8, 0.0), task((1.6, 0.0)), tracks=[track((0.8, 0.0))])
    assert least > REACH + 0.08


@pytest.mark.parametrize("method", get_args(Method))
@pytest.mark.parametrize("lateral", [-0.05, 0.02, 0.10])
def test_a_known_landmark_on_the_path_is_passed(method, lateral, walker, task):
    landmarks = LandmarkObstacles({"post": (1.5, 0.0)}, 0.05, LandmarkParameters())
    walk = walker(method, (0.0, lateral, 0.0))
    assert walk.pass_by((1.5, 0.0), task((2.3, 0.0)), landmarks=landmarks) > REACH + 0.05


@pytest.mark.parametrize("method", get_args(Method))
@pytest.mark.parametrize("distance", [0.6, 0.8, 1.05])
def test_a_goal_before_a_known_landmark_is_reached(method, distance, walker):
    landmarks = LandmarkObstacles({"post": (1.0 + distance, 0.0)}, 0.05, LandmarkParameters())
    mission = Mission(np.array([[1.0, 0.0]]), 0.0, False, MissionParameters())
    assert walker(method, (0.0, 0.2, 0.5)).arrive(mission, landmarks=landmarks).done


# The plain field has no prediction: a crossing mover is a disc that jumps.
@pytest.mark.parametrize("method", [m for m in BASELINES if m != "univector-plain"])
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
def test_movers_lost_for_long_are_forgotten(method, belief, task, track, limits):
    cloud = ([[3.0, 3.0]], [[0.0, 0.0]], [1.0])
    memory = PlannerParameters().memory
    for age, known in ((0.5 * memory, 1), (2.0 * memory, 0)):
        lost = track((0.6, 0.0), (0.0, 0.05), age=age, particles=cloud)
        decision = planner(method, limits).plan(belief([lost]), task())
        assert len(decision.extended_radii) == known


@EACH
def test_published_radii_contain_robot_obstacle_margin_and_uncertainty(
    method, belief, task, track, limits
):
    parameters = PlannerParameters()
    margin = getattr(parameters, method.replace("-", "_")).margin
    tracks = [track((0.9, 0.9), id=1), track((0.9, -0.9), (0.05, 0.0), id=2, sigma=0.5)]
    radii = dict(planner(method, limits).plan(belief(tracks), task()).extended_radii)
    assert radii[1] == pytest.approx(0.12 + 0.08 + margin)
    assert radii[2] == pytest.approx(0.12 + 0.08 + margin + parameters.max_sigma)


def test_samples_come_from_the_generator_alone(belief, task, track, limits):
    b, t = belief([track((0.6, 0.05))]), task()
    first, again, other = (planner("mppi", limits, s).plan(b, t).velocity for s in (0, 0, 1))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_each_baseline_has_its_own_parameters(belief, task, track, limits):
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
def test_a_goal_next_to_an_obstacle_is_reached(method, walker, track):
    mission = Mission(np.array([[0.9, 0.0]]), 0.0, False, MissionParameters())
    assert walker(method).arrive(mission, 60, tracks=[track((0.9, 0.45))]).done


@EACH
def test_near_the_goal_the_body_turns_to_the_goals_heading(method, walker, task):
    """A via point at the same position leaves the body on its course, straight ahead."""
    turned = []
    for is_goal in (True, False):
        walk = walker(method)
        for _ in range(5):
            walk.step(task((0.44, 0.0), 0.6 if is_goal else 0.0, is_goal=is_goal))
        turned.append(walk.pose[2])
    assert turned[0] > abs(turned[1]) + 0.02


def test_orca_has_a_longer_horizon_for_movers_than_for_static_obstacles(
    belief, task, track, limits
):
    p = PlannerParameters(method="orca").orca
    gap = 0.5 * (p.static_horizon + p.horizon) * limits.vx
    position = (gap + 0.2 + p.margin, 0.0)
    free, static, moving = (
        planner("orca", limits).plan(belief(tracks), task((4.0, 0.0))).velocity
        for tracks in ([], [track(position)], [track(position, (-0.1, 0.0))])
    )
    assert static == pytest.approx(free)
    assert not np.allclose(moving, free)


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
