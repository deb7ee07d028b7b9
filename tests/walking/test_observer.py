"""State estimation without a plan: contacts, rolling feet, comparison with the engine."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.estimate.odometry import LegOdometry
from walking.observer import BodyObserver, FootContacts, RollingFeet
from walking.parameters import CONTROL_PERIOD, GRAVITY, GaitParameters, WalkingParameters
from walking.state import Phase

PARAMETERS = WalkingParameters()
COMMAND = VelocityCommand(0.15, 0.03, 0.3)
TICKS = 1200


def observer_of(robot):
    return BodyObserver(robot, PARAMETERS, LegOdometry(PARAMETERS.odometry))


@pytest.fixture(scope="module")
def walk(robot, make_body):
    """Estimates and states of the observer, states of the engine, and true poses, per tick."""
    body, engine, observer = make_body(), WalkingEngine(robot, PARAMETERS), observer_of(robot)
    rows = []
    for _ in range(TICKS):
        sensors = body.sense()
        targets = engine.step(sensors, COMMAND, HeadTarget())
        estimate = observer.update(sensors)
        rows.append((estimate, observer.state(COMMAND), engine.state(), (body.x, body.y, body.yaw)))
        body.apply(targets)
    return rows


def test_odometry_and_camera_are_those_of_the_engine(walk):
    for estimate, measured, planned, _ in walk:
        odometry = planned.odometry
        pose = odometry.x, odometry.y, odometry.yaw
        assert estimate.pose == pytest.approx(pose, abs=2e-4)
        assert measured.camera.position == pytest.approx(planned.camera.position, abs=1e-4)
        assert measured.camera.rotation == pytest.approx(planned.camera.rotation, abs=1e-9)
        angles = measured.camera.pan, measured.camera.tilt
        assert angles == pytest.approx((planned.camera.pan, planned.camera.tilt), abs=1e-9)
        assert (measured.roll, measured.pitch) == (planned.roll, planned.pitch)
        assert measured.com == pytest.approx(planned.com, abs=2e-4)


def test_footsteps_and_phases_follow_the_loads(walk):
    _, measured, planned, _ = walk[-1]
    assert abs(measured.step_count - planned.step_count) <= 1
    assert planned.step_count > 10
    phases = [(measured.phase, planned.phase) for _, measured, planned, _ in walk]
    agree = sum(a == b for a, b in phases)
    assert agree > 0.7 * len(phases)  # an ideal body has both feet on the floor for longer
    assert {Phase.STANDING, Phase.LEFT_SUPPORT, Phase.RIGHT_SUPPORT} <= {a for a, _ in phases}


def test_the_velocity_is_that_of_the_body(walk):
    poses = np.array([pose for *_, pose in walk[600:]])
    yaw = poses[:-1, 2]
    vx, vy = np.diff(poses[:, :2], axis=0).T / 0.005
    true = np.array([np.cos(yaw) * vx + np.sin(yaw) * vy, np.cos(yaw) * vy - np.sin(yaw) * vx])
    estimated = np.array([estimate.velocity[:2] for estimate, *_ in walk[600:-1]]).T
    assert estimated.mean(axis=1) == pytest.approx(true.mean(axis=1), abs=0.01)
    assert np.corrcoef(estimated[1], true[1])[0, 1] > 0.6


def test_the_zmp_is_in_the_polygon_of_the_feet_on_the_floor(walk):
    for estimate, measured, *_ in walk:
        assert measured.balance.zmp_depth > -1e-9
        assert len(measured.footsteps) == 2
        assert {step.left for step in measured.footsteps} == {True, False}
        assert any(estimate.on_floor)
        lowest = measured.balance.feet[:, 2].min()
        assert lowest == pytest.approx(0.0, abs=2e-3)
        np.testing.assert_array_equal(measured.applied_velocity, COMMAND.velocity)
        assert not measured.command_limits.limited


def test_the_covariance_allows_for_feet_that_slip(walk):
    first, last = (measured.odometry for _, measured, *_ in (walk[0], walk[-1]))
    engine = walk[-1][2].odometry
    places = np.array([(m.odometry.x, m.odometry.y) for _, m, *_ in walk])
    walked = np.hypot(*np.diff(places[::70], axis=0).T).sum()
    steps = walk[-1][1].step_count
    variance = last.covariance[0, 0] - engine.covariance[0, 0]
    assert not first.covariance.any()
    assert variance == pytest.approx((0.1 * walked) ** 2 / steps, rel=0.3)


def test_a_robot_on_its_face_has_fallen(robot, ideal_body):
    observer, sensors = observer_of(robot), ideal_body.sense()
    observer.update(sensors)
    assert not observer.fallen
    face_down = np.array([cos(0.75), 0.0, sin(0.75), 0.0])
    for _ in range(200):
        observer.observe(replace(sensors, orientation=face_down))
    assert observer.fallen
    assert observer.state(COMMAND).fallen


def test_a_robot_in_the_air_has_a_state(robot, ideal_body):
    observer, sensors = observer_of(robot), ideal_body.sense()
    observer.update(sensors)
    for _ in range(20):
        estimate = observer.update(replace(sensors, foot_force=np.zeros((2, 4))))
    state = observer.state(COMMAND)
    assert estimate.on_floor == (False, False)
    assert np.isfinite([*state.zmp, *state.dcm, *state.com, *estimate.velocity]).all()


MASS = 5.0
WEIGHT = MASS * GRAVITY
GAIT = GaitParameters()
STEP = round(GAIT.footstep_time / CONTROL_PERIOD)
ON, OFF, BOTH = (WEIGHT, 0.0), (0.0, WEIGHT), (0.5 * WEIGHT, 0.5 * WEIGHT)


def after(*stretches):
    contacts = FootContacts(MASS, GAIT)
    for loads, ticks in stretches:
        for _ in range(ticks):
            contacts.update(*loads)
    return contacts


@given(st.lists(st.floats(0.2, 0.8), min_size=1, max_size=100))
def test_a_robot_that_shifts_its_weight_stands(fractions):
    contacts = after(*(((f * WEIGHT, (1.0 - f) * WEIGHT), 1) for f in fractions))
    assert contacts.phase is Phase.STANDING
    assert contacts.step_count == 0


def test_every_landing_is_one_footstep():
    stride = ((ON, STEP), (BOTH, 5), (OFF, STEP), (BOTH, 5))
    contacts = after(*stride, *stride)
    assert contacts.step_count == 4
    assert contacts.phase is Phase.DOUBLE_SUPPORT
    assert after(*stride, (BOTH, STEP + 1)).phase is Phase.STANDING


@given(st.integers(0, 2**32 - 1))
def test_noise_of_an_unloaded_foot_makes_no_footstep(seed):
    noise = np.random.default_rng(seed).normal(0.0, 0.02 * WEIGHT, 200)
    contacts = after((ON, STEP), *(((WEIGHT, abs(n)), 1) for n in noise))
    assert contacts.phase is Phase.LEFT_SUPPORT
    assert contacts.step_count == 0


angles = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
FLAT = np.stack([np.eye(3)] * 2)
DOWN = np.array([[0.0, 0.1, -0.5], [0.0, -0.1, -0.5]])
HEEL = np.array([[-0.05, 0.01], [-0.05, -0.01]])
LOADED = [True, True]


def rolled_over(pressure, rotation):
    """Positions of feet (2, 3) that turn about their contact points from `DOWN`."""
    arms = np.column_stack([pressure, np.zeros(2)])
    return DOWN + arms - arms @ rotation.T


@given(angles, st.floats(-3.0, 3.0))
def test_the_contact_point_of_a_foot_that_rolls_does_not_move(turn, yaw):
    rotation = Rotation.from_rotvec(turn).as_matrix()
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, yaw, LOADED)
    feet.update(rolled_over(HEEL, rotation), np.stack([rotation] * 2), HEEL, yaw, LOADED)
    assert feet.motion == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    assert feet.contact == pytest.approx(DOWN + np.column_stack([HEEL, np.zeros(2)]))
    moved = rolled_over(HEEL, rotation) - DOWN
    assert feet.rolled == pytest.approx(-moved[:, :2], abs=1e-12)


@given(angles, st.floats(-3.0, 3.0))
def test_a_flat_foot_moves_against_the_body(motion, yaw):
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, yaw, LOADED)
    feet.update(DOWN - motion, FLAT, HEEL, yaw, LOADED)
    expected = -Rotation.from_euler("z", yaw).apply(motion)
    assert feet.motion == pytest.approx(np.stack([expected] * 2))
    assert not feet.rolled.any()


def test_a_lifted_foot_forgets_how_it_rolled():
    tilted = np.stack([Rotation.from_euler("y", 0.3).as_matrix()] * 2)
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, 0.0, LOADED)
    feet.update(DOWN, tilted, HEEL, 0.0, [True, False])
    assert feet.rolled[0].any()
    assert not feet.rolled[1].any()
