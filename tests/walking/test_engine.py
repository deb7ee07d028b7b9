"""The engine on a body without dynamics: velocities, explicit footsteps, mirror images."""

from contextlib import nullcontext
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tests.walking.conftest import IdealBody
from walking.body.robot_model import RobotModel
from walking.command import CommandState, HeadTarget, Limit, VelocityCommand
from walking.engine import PlanDiverged, WalkingEngine
from walking.parameters import CONTROL_PERIOD, HeadParameters, WalkingParameters
from walking.state import Phase

AHEAD = HeadTarget()
GENERATORS = ["preview", "mwpg"]


def run(robot, body, script, seconds, parameters=None, watch=None):
    engine = WalkingEngine(robot, parameters or WalkingParameters())
    rows = []
    for k in range(round(seconds / CONTROL_PERIOD)):
        targets = engine.step(body.sense(), script(k * CONTROL_PERIOD), AHEAD)
        body.apply(targets)
        rows.append(np.concatenate([targets.position, targets.setpoint]))
        if watch is not None:
            watch(engine, k)
    return engine, np.array(rows)


def always(*velocity):
    return lambda _now: VelocityCommand(*velocity)


def twists(now):
    """A different command every 0.15 s, stops among them."""
    rng = np.random.default_rng([5, int(now / 0.15)])
    if rng.uniform() < 0.2:
        return VelocityCommand()
    vx, vy, wz = rng.uniform((-0.2, -0.1, -1.0), (0.3, 0.1, 1.0)).tolist()
    return VelocityCommand(vx, vy, wz)


@pytest.mark.parametrize("generator", GENERATORS)
@pytest.mark.parametrize(
    "velocity", [(0.2, 0.0, 0.0), (-0.1, 0.0, 0.0), (0.0, 0.08, 0.0), (0.0, 0.0, -0.5)]
)
def test_it_walks_at_the_commanded_velocity(robot, ideal_body, velocity, generator):
    parameters = WalkingParameters()
    pattern = replace(parameters.pattern, generator=generator)
    script, poses = always(*velocity), []

    def watch(_engine, _k):
        poses.append((ideal_body.x, ideal_body.y, ideal_body.yaw))

    run(robot, ideal_body, script, 6.0, replace(parameters, pattern=pattern), watch)
    period = round(2 * parameters.gait.footstep_time / CONTROL_PERIOD)
    first, last = np.array(poses[-1 - 5 * period]), np.array(poses[-1])
    mean = (last - first) / (5 * period * CONTROL_PERIOD)
    assert mean == pytest.approx(velocity, abs=0.012)


def test_a_lying_robot_knows_it_and_does_not_step(robot, ideal_body):
    engine = WalkingEngine(robot, WalkingParameters())
    lying = np.array([np.cos(0.7), np.sin(0.7), 0.0, 0.0])
    sensors = replace(ideal_body.sense(), orientation=lying)
    for _ in range(400):
        engine.step(sensors, VelocityCommand(0.2, 0.0, 0.0), AHEAD)
    assert engine.state().fallen
    assert engine.state().phase is Phase.STANDING


def test_the_first_tick_of_a_robot_in_its_ready_posture_moves_no_joint(robot):
    engine, tree = WalkingEngine(RobotModel(robot.tree), WalkingParameters()), robot.tree
    body = IdealBody(RobotModel(tree))
    targets = engine.step(body.sense(), VelocityCommand(), AHEAD)
    assert targets.position == pytest.approx(body.sense().joint_position, abs=1e-6)


def test_a_robot_that_falls_while_walking_takes_no_more_steps(robot, ideal_body):
    engine, sensors = WalkingEngine(robot, WalkingParameters()), ideal_body.sense()
    for _ in range(300):
        sensors = ideal_body.sense()
        ideal_body.apply(engine.step(sensors, VelocityCommand(0.2), AHEAD))
    steps = engine.state().step_count
    lying = replace(
        sensors,
        orientation=np.array([np.cos(0.7), 0.0, np.sin(0.7), 0.0]),
        foot_force=np.zeros((2, 4)),
    )
    while not engine.fallen:
        engine.step(lying, VelocityCommand(0.2), AHEAD)
    fallen = [engine.step(lying, VelocityCommand(0.2), AHEAD) for _ in range(400)]
    held = [targets.position for targets in fallen]
    assert steps > 0
    assert engine.state().step_count <= steps + 1
    assert np.ptp(held, axis=0).max() == 0.0
    assert all((targets.setpoint == lying.joint_position).all() for targets in fallen)
    assert engine.limits == (Limit.FALLEN,)


@pytest.mark.parametrize(("legs", "diverged"), [(5.0, False), (12.0, True)])
def test_a_plan_that_leaves_the_feet_far_behind_is_an_error(robot, ideal_body, legs, diverged):
    engine = WalkingEngine(robot, WalkingParameters())
    engine.step(ideal_body.sense(), VelocityCommand(), AHEAD)
    engine._walk.pendulum.x += legs * robot.legs[0].length
    with pytest.raises(PlanDiverged, match="m from the feet") if diverged else nullcontext():
        engine.step(ideal_body.sense(), VelocityCommand(), AHEAD)


def test_reading_the_state_changes_nothing(robot, ideal_body):
    engines = [WalkingEngine(robot, WalkingParameters()) for _ in range(2)]
    for k in range(200):
        command, sensors = VelocityCommand(0.6, 0.3, 2.0 * (k % 2)), ideal_body.sense()
        one, other = (engine.step(sensors, command, AHEAD) for engine in engines)
        before = bytes(engines[0]._walks)
        engines[0].state()
        assert bytes(engines[0]._walks) == before
        assert one.position.tolist() == other.position.tolist()
        ideal_body.apply(one)


def test_a_push_while_standing_is_answered_by_a_step(robot, ideal_body):
    engine = WalkingEngine(robot, WalkingParameters())
    for k in range(300):
        sensors = ideal_body.sense()
        if k >= 200:
            lean = 0.003 * (k - 200)
            tilt = np.array([np.cos(0.5 * lean), 0.0, np.sin(0.5 * lean), 0.0])
            gyro = np.array([0.0, 0.003 / CONTROL_PERIOD, 0.0])
            sensors = replace(sensors, orientation=tilt, gyro=gyro)
        ideal_body.apply(engine.step(sensors, VelocityCommand(), AHEAD))
        if k == 200:
            assert engine.state().phase is Phase.STANDING
    state = engine.state()
    assert state.phase is not Phase.STANDING
    assert state.footsteps[1].x > state.footsteps[0].x + 0.02


def test_setpoints_stay_within_the_range_of_the_joints(robot, ideal_body):
    """The head moves from stop to stop, where the feed-forward offset leads beyond the stop."""
    engine = WalkingEngine(robot, replace(WalkingParameters(), head=HeadParameters(max_rate=6.0)))
    at_stop = 0
    for k in range(800):
        side = 1.0 if k // 100 % 2 else -1.0
        head = HeadTarget(2.0 * side, -2.0 * side)
        targets = engine.step(ideal_body.sense(), twists(k * CONTROL_PERIOD), head)
        ideal_body.apply(targets)
        assert (targets.setpoint >= robot.lower).all()
        assert (targets.setpoint <= robot.upper).all()
        pan = robot.tree.head[0]
        at_stop += targets.setpoint[pan] in {robot.lower[pan], robot.upper[pan]}
    assert at_stop > 10


def test_there_is_no_state_before_the_first_tick(robot):
    with pytest.raises(RuntimeError, match="first tick"):
        WalkingEngine(robot, WalkingParameters()).state()


@pytest.mark.parametrize("generator", GENERATORS)
def test_the_planned_zmp_keeps_its_margin_in_the_support_polygon(robot, ideal_body, generator):
    """The published depth is that of the published ZMP in the published polygon."""
    parameters = WalkingParameters()
    pattern = replace(parameters.pattern, generator=generator)
    depths = []

    def watch(engine, k):
        depths.append(engine.zmp_depth)
        if k % 7 == 0:
            state = engine.state()
            hull = ConvexHull(state.balance.support)
            out = (hull.equations[:, :2] @ state.zmp + hull.equations[:, 2]).max()
            assert depths[-1] == state.balance.zmp_depth == pytest.approx(-out, abs=1e-9)

    run(robot, ideal_body, twists, 8.0, replace(parameters, pattern=pattern), watch)
    assert min(depths) > pattern.sole_margin - 1e-9


PARAMETERS = WalkingParameters()


def random_state(rng):
    low = (0.18, 0.03, -0.07, 0.07, -0.3, 0.015)
    high = (0.45, 0.15, 0.11, 0.13, 0.3, 0.035)
    return CommandState(*rng.uniform(low, high).tolist())


def step_through(engine, body, command_of, seconds):
    steps, positions, count = [], [], 0
    for k in range(round(seconds / CONTROL_PERIOD)):
        targets = engine.step(body.sense(), command_of(k), AHEAD)
        body.apply(targets)
        positions.append(targets.position)
        state = engine.state()
        if state.step_count > count:
            count, landing = state.step_count, state.footsteps[0]
            steps.append((k, state.balance.feet[1 if landing.left else 0], landing))
    return steps, np.array(positions)


def test_footsteps_are_those_of_the_command_state(robot, ideal_body):
    command = CommandState(0.3, 0.1, 0.07, 0.1, 0.0, 0.03)
    engine = WalkingEngine(robot, PARAMETERS)
    steps, _ = step_through(engine, ideal_body, lambda _k: command, 5.0)
    for (before, _, _), (now, support, landing) in pairwise(steps[2:]):
        assert now - before == round(0.4 / CONTROL_PERIOD)
        c, s = np.cos(support[3]), np.sin(support[3])
        dx, dy = landing.x - support[0], landing.y - support[1]
        assert c * dx + s * dy == pytest.approx(0.07, abs=5e-3)
        assert abs(c * dy - s * dx) == pytest.approx(0.1, abs=5e-3)


def test_a_new_command_state_at_every_tick_keeps_the_joints_smooth(robot, ideal_body):
    rng = np.random.default_rng(3)
    engine = WalkingEngine(robot, PARAMETERS)
    steps, positions = step_through(engine, ideal_body, lambda _k: random_state(rng), 12.0)
    assert len(steps) > 15
    assert (positions >= robot.lower - 1e-9).all()
    assert (positions <= robot.upper + 1e-9).all()
    assert np.abs(np.diff(positions, axis=0)).max() / CONTROL_PERIOD < 25.0
