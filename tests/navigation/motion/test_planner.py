"""Pipeline of the planner: properties of every method."""

import pickle
from dataclasses import replace
from math import pi
from typing import get_args

import numpy as np
import pytest

from navigation.parameters.planner import Method

METHODS = get_args(Method)
EACH = pytest.mark.parametrize("method", METHODS)
FIELDS = pytest.mark.parametrize("method", ["univector", "paper"])
SAMPLED = {"dwa", "mppi"}  # limited to velocities within reach of a footstep
MIRROR = np.array([1.0, -1.0, -1.0])


def world(rng):
    """Positions and velocities of seven obstacles around the origin, a half of them moving."""
    places = rng.uniform(-1.2, 1.2, (7, 2))
    places = places[np.hypot(places[:, 0], places[:, 1]) > 0.35]
    moving = np.arange(len(places))[:, None] % 2
    return places, np.where(moving, rng.normal(0, 0.08, places.shape), 0.0)


def same(one, other, tolerance=0.0):
    """Whether two decisions are equal in all that is recorded of them."""
    assert other.velocity == pytest.approx(one.velocity, abs=tolerance, rel=tolerance)
    assert (other.direction, other.speed) == pytest.approx(
        (one.direction, one.speed), abs=tolerance, rel=tolerance
    )
    assert other.situation == one.situation
    radii = [sorted(d.extended_radii) for d in (one, other)]
    assert [i for i, _ in radii[1]] == [i for i, _ in radii[0]]
    assert [r for _, r in radii[1]] == pytest.approx([r for _, r in radii[0]])


class Steps:
    """Decisions of a planner while the robot follows them through a world of movers."""

    def __init__(self, planner, scene, belief, tracks, advance, seed=0, parameters=None):
        self.planner, self.memory, self.pose = planner, planner.begin(), np.zeros(3)
        self.command = np.zeros(3)
        self._world, self._count = world(np.random.default_rng(seed)), 0
        self._make = scene, belief, tracks, advance
        self._parameters = parameters

    def scene(self, task):
        scene, belief, tracks, _ = self._make
        places, velocities = self._world
        moved = tracks(places + 0.34 * self._count * velocities, velocities)
        return scene(belief(moved, self.pose), task, self._parameters, self.command)

    def step(self, task):
        decision, self.memory = self.planner.plan(self.memory, self.scene(task))
        self.command = decision.velocity
        self.pose = self._make[3](self.pose, self.command)
        self._count += 1
        return decision


@pytest.fixture
def steps(planner, parameters, scene, belief, tracks, advance):
    """Builds a walk of a method through a world."""

    def steps(method, seed=0, planned=None):
        p = parameters(method)
        planned = planned or planner(method)
        return Steps(planned, scene, belief, tracks, advance, seed, p)

    return steps


@EACH
def test_a_free_path_is_walked_ahead(method, plan, walker, belief, task, limits):
    """The desired speed of the paper is 0.75 of the maximum, |u_T| of (10)."""
    walk = walker(method)
    for _ in range(15):
        decision = walk.step(task())
        assert decision.situation == "free"
    assert walk.pose[0] > 0.6
    assert abs(walk.pose[1]) < 0.1
    if method not in SAMPLED:
        speed = limits.vx * (0.75 if method == "paper" else 1.0)
        decision = plan(method, belief(), task())
        assert decision.velocity == pytest.approx([speed, 0.0, 0.0], abs=1e-9)
        assert decision.direction == pytest.approx(0.0)


@EACH
def test_done_stands_and_lost_turns_on_the_spot(method, plan, parameters, belief, task):
    for b in (belief(), belief(lost=True)):
        assert not plan(method, b, task(done=True)).velocity.any()
    lost = plan(method, belief(lost=True), task()).velocity
    rate = parameters(method).velocity_mapping.lost_turn_rate
    assert lost == pytest.approx([0.0, 0.0, rate])
    assert rate > 0.0


@EACH
def test_after_lost_or_done_the_memory_holds_no_course(method, steps, belief, task, scene):
    for b, t in ((belief(lost=True), task()), (belief(), task(done=True))):
        walk = steps(method)
        for _ in range(3):
            walk.step(task((2.0, 1.0)))
        assert walk.memory.course is not None
        _, memory = walk.planner.plan(walk.memory, scene(b, t))
        assert (memory.course, memory.plan, memory.side) == (None, None, 0)


@EACH
def test_the_same_memory_and_scene_give_the_same_decision_and_stay(method, steps, task):
    walk, t = steps(method, 3), task((1.5, 0.8), 0.4, is_goal=True)
    for _ in range(4):
        here = walk.scene(t)
        before = pickle.dumps((walk.memory, here.belief.pose, here.obstacles.rows, here.s_oe))
        (one, first), (two, second) = (walk.planner.plan(walk.memory, here) for _ in range(2))
        after = pickle.dumps((walk.memory, here.belief.pose, here.obstacles.rows, here.s_oe))
        assert after == before
        same(one, two)
        assert pickle.dumps(first) == pickle.dumps(second)
        walk.step(t)


@EACH
def test_interleaved_memories_do_not_influence_each_other(method, steps, planner, task):
    """Nothing lives in the planner; `mppi` draws the same samples at every call here."""
    t, shared = task((1.5, 0.8), 0.4), planner(method)
    together = [steps(method, seed, shared) for seed in (5, 6)]
    alone = [steps(method, seed) for seed in (5, 6)]
    for _ in range(5):
        for one, other in zip(together, alone, strict=True):
            same(one.step(t), other.step(t))


@EACH
def test_commands_obey_the_speed_limits(method, planner, scene, belief, task, tracks, limits):
    rng = np.random.default_rng(2)
    low = np.array([-limits.vx_backward, -limits.vy, -limits.wz])
    high = np.array([limits.vx, limits.vy, limits.wz])
    for _ in range(15):
        obstacles, planned = tracks(*world(rng)), planner(method)
        t = task(rng.uniform(-1.5, 1.5, 2), rng.uniform(-pi, pi), is_goal=True)
        memory, body = planned.begin(), np.zeros(3)
        for _ in range(2):
            b = belief(obstacles, (0, 0, rng.uniform(-pi, pi)))
            decision, memory = planned.plan(memory, scene(b, t, body=body))
            body = decision.velocity
            assert np.all(decision.velocity <= high + 1e-12)
            assert np.all(decision.velocity >= low - 1e-12)
            assert not decision.velocity.flags.writeable


@EACH
def test_decisions_do_not_depend_on_the_frame(
    method, planner, parameters, scene, belief, task, tracks, rotation
):
    rng, a, shift = np.random.default_rng(0), 1.2, np.array([0.7, -2.0])
    r, p = rotation(a), parameters(method)
    for _ in range(6):
        places, velocities = world(rng)
        decisions = []
        for matrix, origin, turn in ((np.eye(2), np.zeros(2), 0.0), (r, shift, a)):
            moved = tracks(places @ matrix.T + origin, velocities @ matrix.T)
            t = task(matrix @ [1.0, 0.5] + origin, 0.3 + turn)
            planned = planner(method)
            memory, body = planned.begin(), np.zeros(3)
            for _ in range(2):
                here = scene(belief(moved, (*origin, turn)), t, p, body)
                decision, memory = planned.plan(memory, here)
                body = decision.velocity
            decisions.append(decision)
        assert decisions[1].velocity == pytest.approx(decisions[0].velocity, abs=1e-6)
        assert decisions[1].situation == decisions[0].situation


@EACH
def test_a_mirrored_world_mirrors_the_command(
    method, planner, parameters, scene, belief, task, tracks
):
    rng, p = np.random.default_rng(3), parameters(method)
    for _ in range(6):
        places, velocities = world(rng)
        heading, target, arrival = rng.uniform(-1, 1), rng.uniform(0.6, 1.5, 2), rng.uniform(-1, 1)
        commands = []
        for sign in (1.0, -1.0):
            flip, planned = np.array([1.0, sign]), planner(method)
            b = belief(tracks(places * flip, velocities * flip), (0, 0, sign * heading))
            t, memory = task(target * flip, sign * arrival), planned.begin()
            body = np.zeros(3)
            for _ in range(2):
                decision, memory = planned.plan(memory, scene(b, t, p, body))
                body = decision.velocity
            commands.append(decision.velocity)
        assert commands[1] == pytest.approx(MIRROR * commands[0], abs=1e-6)
        assert np.abs(commands[0]).max() > 0.01


@EACH
def test_the_order_of_tracks_is_irrelevant(method, plan, belief, task, tracks):
    for seed in range(4):
        obstacles = tracks(*world(np.random.default_rng(seed)))
        one = plan(method, belief(obstacles), task())
        same(one, plan(method, belief(obstacles[::-1]), task()), 1e-9)


@EACH
def test_at_the_goal_it_turns_in_place(method, plan, walker, belief, task, limits):
    walk, t = walker(method), task((0.0, 0.0), 1.0, is_goal=True, aligning=True)
    for _ in range(40):
        walk.step(t)
    assert walk.pose[2] == pytest.approx(1.0, abs=0.3)
    assert walk.distance((0.0, 0.0)) < 0.1
    if method not in SAMPLED:
        assert plan(method, belief(), t).velocity == pytest.approx([0.0, 0.0, limits.wz])
        near = task((0.0, 0.0), 0.1, is_goal=True, aligning=True)
        assert plan(method, belief(), near).velocity == pytest.approx([0.0, 0.0, 0.15])


@FIELDS
def test_it_slows_down_at_the_goal_but_not_at_a_via_point(method, plan, belief, task, limits):
    goal, via, far = (
        plan(method, belief(), task((x, 0.0), is_goal=g)).velocity[0]
        for x, g in ((0.1, True), (0.1, False), (3.0, True))
    )
    assert goal < 0.5 * limits.vx
    assert via == pytest.approx(far)


def test_the_body_turns_for_a_fixed_camera_and_keeps_its_course(plan, belief, task):
    ahead = plan("univector", belief(), task())
    left = plan("univector", belief(), task(), look=0.8)
    assert left.velocity[2] > ahead.velocity[2] == pytest.approx(0.0, abs=1e-9)
    assert left.velocity[1] / left.velocity[0] == pytest.approx(0.0, abs=1e-9)
    goal = task((0.05, 0.0), is_goal=True)
    assert plan("univector", belief(), goal, look=0.8).velocity[2] == pytest.approx(0.0, abs=1e-9)


def test_the_side_of_an_arrival_is_kept_on_its_leg_only(planner, scene, belief, task):
    planned = planner()
    beyond, over = task((0.3, 0.0), 3.1), task((0.3, 0.0), -3.1)
    _, memory = planned.plan(planned.begin(), scene(belief(), beyond))
    assert (memory.leg, memory.side) == (0, 1)
    _, kept = planned.plan(memory, scene(belief(), over))
    assert kept.side == 1
    _, fresh = planned.plan(memory, scene(belief(), replace(over, index=1)))
    assert (fresh.leg, fresh.side) == (1, -1)


@EACH
def test_movers_lost_for_long_are_forgotten_by_the_method(
    method, plan, parameters, belief, task, track
):
    cloud = ([[3.0, 3.0]], [[0.0, 0.0]], [1.0])
    limit = parameters(method).univector.memory
    for age, known in ((0.5 * limit, 1), (1.5 * limit, 0)):
        lost = track((0.6, 0.0), (0.0, 0.05), age=age, particles=cloud)
        assert len(plan(method, belief([lost]), task()).extended_radii) == known
    static = track((0.6, 0.0), age=9.0)
    assert len(plan(method, belief([static]), task()).extended_radii) == 1


def test_movers_lost_for_long_are_left_to_the_safety_filter(plan, belief, task, track):
    """Particles on the path stop the body, not the field."""
    cloud = ([[0.5, 0.0]], [[-0.1, 0.0]], [1.0])
    lost = track((2.5, 0.0), (-0.1, 0.0), age=9.0, particles=cloud)
    free, decided = (plan("univector", belief(t), task()) for t in ([], [lost]))
    assert (decided.direction, decided.speed) == (free.direction, free.speed)
    assert np.hypot(*(decided.velocity - free.velocity)[:2]) > 0.02


def test_a_waiting_robot_steps_aside_for_a_mover(plan, belief, task, track):
    mover = track((0.6, 0.0), (-0.14, 0.0))
    t = task((0.0, 0.0), 0.0, is_goal=True, aligning=True)
    assert np.hypot(*plan("univector", belief([mover]), t).velocity[:2]) > 0.02


@FIELDS
def test_the_field_of_a_decision_has_its_direction(method, plan, belief, task, track):
    """At the robot, which stands: a footstep ahead it is at the same point."""
    decision = plan(method, belief([track((0.7, 0.15))]), task())
    u_x, u_y = decision.field.at(np.zeros(2))
    assert np.arctan2(u_y, u_x) == pytest.approx(decision.direction)


def test_the_speed_of_a_decision_is_that_before_the_safety_filter(plan, belief, task, track):
    """Records show the desired speed of the field; the velocity is that of the body."""
    decision = plan("univector", belief([track((0.35, 0.0), (-0.14, 0.0))]), task())
    assert decision.speed == pytest.approx(0.2)
    assert np.hypot(*decision.velocity[:2]) < 0.2
