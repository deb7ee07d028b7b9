"""Attitude, complementary filter, loads, and the error of the body against the plan."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking.data import Body, Data, PlanError
from walking.estimate.body import (
    filter_error,
    follow_tilt,
    load_of,
    roll_pitch_yaw,
    set_body,
    steady_gains,
    update_error,
)
from walking.parameters import CONTROL_PERIOD, EstimatorParameters
from walking.plan.pendulum import hold_tick

PARAMETERS = EstimatorParameters()


def quaternion(roll, pitch, yaw):
    cr, sr = cos(0.5 * roll), sin(0.5 * roll)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    cy, sy = cos(0.5 * yaw), sin(0.5 * yaw)
    return (
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )


@given(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
def test_an_attitude_there_and_back_with_either_sign(roll, pitch, yaw):
    q = quaternion(roll, pitch, yaw)
    for sign in (1.0, -1.0):
        result = roll_pitch_yaw(sign * np.array(q))
        assert result == pytest.approx((roll, pitch, yaw), abs=1e-6)


class Tilt:
    """Roll and pitch of a trunk."""

    def __init__(self, gain=PARAMETERS.tilt_gain):
        self.gain, self.body = gain, np.zeros(1, Body)[0]

    def update(self, roll, pitch, gyro):
        follow_tilt(self.body, roll, pitch, np.array(gyro), self.gain)
        return [self.body.roll, self.body.pitch]


def test_the_tilt_of_a_trunk_that_yaws_under_a_constant_lean():
    # A lean fixed in the world becomes roll, then pitch, as the body turns under it.
    rate, lean, ticks = 3.0, 0.1, 300
    tilt = Tilt(1e-9)
    for _ in range(ticks):
        result = tilt.update(lean, 0.0, [0.0, 0.0, rate])
    angle = rate * (ticks - 1) * CONTROL_PERIOD
    assert result == pytest.approx((lean * np.cos(angle), -lean * np.sin(angle)), abs=0.01)


@pytest.mark.parametrize(("pad", "x", "y"), [(0, 1, 1), (1, 1, -1), (2, -1, 1), (3, -1, -1)])
def test_the_centre_of_pressure_is_at_the_loaded_corner(model, pad, x, y):
    sole = model.robot.sole
    corner = (9.0, sole.centre + sole.half_length * x, sole.half_width * y)
    assert load_of(9.0 * np.eye(4)[pad], sole) == pytest.approx(corner)


def test_the_steady_gains_are_where_the_filter_settles(model):
    dt, p, robot = CONTROL_PERIOD, PARAMETERS, model.robot
    A = np.array([hold_tick(robot, 1.0, 0.0, 0.0), hold_tick(robot, 0.0, 1.0, 0.0)]).T
    noise = np.array([0.5 * dt * dt, dt]) * p.acceleration_noise
    P, K = np.eye(2), np.zeros(2)
    for _ in range(5000):
        P = A @ P @ A.T + np.outer(noise, noise)
        K = P[:, 0] / (P[0, 0] + p.position_noise**2)
        P = P - np.outer(K, P[0])
    assert steady_gains(float(robot.omega), p) == pytest.approx(K.tolist(), rel=0.01)


class Error:
    """Error of the CoM, filtered."""

    def __init__(self, model, x=0.0, y=0.0, vx=0.0):
        self.robot, self.state = model.robot, np.zeros(1, PlanError)[0]
        self.state.x, self.state.y, self.state.vx = x, y, vx

    def follow(self, measured, zmp_shift=(0.0, 0.0), slip=(0.0, 0.0)):
        filter_error(self.state, measured, zmp_shift, slip, self.robot)
        return self.state


def test_the_filter_finds_a_diverging_body(model):
    error, rng, omega = Error(model), np.random.default_rng(1), float(model.robot.omega)
    for k in range(60):
        truth = 0.002 * np.exp(omega * k * CONTROL_PERIOD)
        state = error.follow((float(truth + rng.normal(0.0, PARAMETERS.position_noise)), 0.0))
    assert state.vx == pytest.approx(omega * truth, rel=0.2)
    assert (state.y, state.vy) == (0.0, 0.0)


def test_an_error_held_by_the_ankles_is_not_a_velocity_and_a_slip_is(model):
    state = Error(model, 0.02, -0.01).follow((0.02, -0.01), (0.02, -0.01))
    assert (state.x, state.y) == pytest.approx((0.02, -0.01))
    assert abs(state.vx) < 1e-9
    error = Error(model)
    for _ in range(400):
        state = error.follow((0.0, 0.0), slip=(0.05, 0.0))
    assert state.vx == pytest.approx(0.05, rel=0.05)


def test_the_filter_predicts_with_the_pendulum(model):
    """Over one tick, to the third order of time."""
    x, v = hold_tick(model.robot, 0.01, -0.05, 0.004)
    state = Error(model, 0.01, 0.0, -0.05).follow((x, 0.0), (0.004, 0.0))
    assert state.x == pytest.approx(x, abs=1e-7)
    assert state.vx == pytest.approx(v, abs=1e-4)


class StillBody:
    """Walk whose plan is compared with one reading of the sensors."""

    def __init__(self, robot, model, sensors):
        self.model, self.sensors = model, sensors
        self.walk = np.zeros(1, Data)[0]
        self.body, self.limbs = self.walk.body, self.walk.limbs
        self.com = tuple(robot.com(sensors.joint_position).tolist())
        for side, foot in enumerate(robot.tree.feet):
            rotation, position = robot.frame_pose(foot, sensors.joint_position)
            self.body.frames[side] = [*rotation.ravel(), *position]
        self.measure()
        for side, foot in enumerate(self.limbs.feet):
            seen = self.body.feet[side]
            foot.x, foot.y, foot.yaw = seen.x, seen.y, seen.yaw
        self.limbs.com_x, self.limbs.com_y = self.body.com_x, self.body.com_y

    def measure(self, orientation=None, pads=None):
        s, model = self.sensors, self.model
        orientation = s.orientation if orientation is None else orientation
        pads = s.foot_force if pads is None else pads
        self.body.started = False
        rest = (s.gyro, pads, model.robot)
        set_body(self.body, self.com, orientation, *rest)
        return self.body

    def compare(self, right=0.5):
        shift = self.walk.plan.gait.clock.shift
        shift.right_weight, shift.end, self.walk.plan.gait.support = right, 1, 1
        update_error(self.walk, self.model.robot)
        return self.walk.error


@pytest.fixture
def body(robot, model, ideal_body):
    return StillBody(robot, model, ideal_body.sense())


def test_a_tilted_body_over_flat_feet_is_measured_level(body):
    before = body.body.copy()
    foot = before.feet[0]
    sensing = body.measure(orientation=np.array(quaternion(0.0, 0.1, 0.0)))
    assert (sensing.roll, sensing.pitch) == pytest.approx((0.0, 0.1))
    # Pitching forward carries the mass centre ahead of the feet.
    ahead = sensing.com_x - sensing.feet[0].x
    assert ahead > before.com_x - foot.x + 0.01
    arm = np.hypot(before.com_x - foot.x, before.com_z - foot.z)
    assert np.hypot(ahead, sensing.com_z - sensing.feet[0].z) == pytest.approx(arm)


@pytest.mark.parametrize("tilt", [(0.3, 0.0), (0.0, -0.4), (0.3, -0.4)])
def test_heading_rate_and_foot_yaw_are_those_of_the_level_frame(body, tilt):
    attitude = Rotation.from_euler("ZYX", (0.0, *tilt[::-1])).as_matrix()
    for side, yaw in enumerate((0.25, -0.1)):
        flat = attitude.T @ Rotation.from_euler("z", yaw).as_matrix()
        body.body.frames[side, :9] = flat.ravel()
    rate = attitude.T @ [0.0, 0.0, 0.7]
    body.sensors = replace(body.sensors, gyro=rate)
    measured = body.measure(orientation=np.array(quaternion(*tilt, 0.0)))
    assert measured.turn_rate == pytest.approx(0.7)
    assert [foot.yaw for foot in measured.feet] == pytest.approx([0.25, -0.1])


def test_light_pad_noise_is_not_a_load(body):
    force = np.zeros((2, 4))
    force[1] = 12.0
    force[0, 0] = 0.8
    sensing = body.measure(pads=force)
    assert sensing.right_load == 1.0
    assert sensing.feet["load"] == pytest.approx([0.8, 48.0])
    assert body.measure(pads=np.zeros((2, 4))).right_load == 0.5


def test_the_centre_of_pressure_is_under_the_loaded_corner_and_between_loaded_feet(robot, body):
    sole, force = robot.sole, np.zeros((2, 4))
    body.limbs.feet["x"], body.limbs.feet["y"], body.limbs.feet["yaw"] = (0.0, 0.1), 0.0, 0.3
    force[0, 1] = 10.0
    corner = np.array([sole.centre + sole.half_length, -sole.half_width])
    R = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    for both in (False, True):
        force[1, 1] = 10.0 if both else 0.0
        body.measure(pads=force)
        sensing = body.compare()
        expected = R @ corner + ([0.05, 0.0] if both else 0.0)
        assert [sensing.pressure_x, sensing.pressure_y] == pytest.approx(expected)
    body.measure(pads=np.zeros((2, 4)))
    assert body.compare().pressure_x == 0.0


def test_weight_shifted_to_a_foot_is_not_a_motion_of_the_body(body):
    """Seen from a foot half a centimetre off its position, the body is off by as much, at once."""
    body.limbs.feet[1].x += 0.005
    sensing = body.compare(0.0)
    assert [sensing.x, sensing.y, sensing.vx, sensing.vy] == pytest.approx(4 * [0.0], abs=1e-12)
    sensing = body.compare(1.0)
    assert (sensing.x, sensing.y) == pytest.approx((0.005, 0.0), abs=1e-5)
    assert abs(sensing.vx) < 0.01


@pytest.mark.parametrize("right", [0.0, 0.3, 1.0])
@pytest.mark.parametrize(("off", "ticks"), [((0.0, 0.0), 1), ((0.004, -0.003), 300)])
def test_the_error_is_that_against_the_plan_in_any_frame(body, right, off, ticks):
    place, turn, yaw = np.array([0.3, -0.2]), 0.7, -0.4  # of the level frame; yaw of the plan

    def turned(angle, point):
        c, s = np.cos(angle), np.sin(angle)
        return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])

    limbs, sensing, origin = body.limbs, body.body, np.array([0.11, 0.07])
    for side, foot in enumerate(limbs.feet):
        seen = sensing.feet[side]
        seen.yaw = 0.2 - 0.3 * side
        foot.x, foot.y = place + turned(turn, (seen.x, seen.y))
        foot.yaw = turn + seen.yaw
    planned = turned(-yaw, place + turned(turn, (sensing.com_x, sensing.com_y)) - origin)
    limbs.pelvis = (*origin, yaw)
    limbs.com_x, limbs.com_y = planned - off
    for _ in range(ticks):
        error = body.compare(right)
    # A steady error: nothing holds the body against it, so it shows as a rate, too.
    assert [error.x, error.y] == pytest.approx(turned(yaw, off), abs=3e-4 if any(off) else 1e-12)
