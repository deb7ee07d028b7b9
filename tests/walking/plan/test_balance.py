"""Ankles, capture step, and landing of the swing foot on a pendulum without a body."""

from itertools import pairwise
from math import cos, exp, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from compilation.record import records
from walking.command import BALANCE
from walking.data import Data
from walking.parameters import CONTROL_PERIOD, StabilizerParameters
from walking.plan.admission import remember
from walking.plan.balance import (
    ankle_gain,
    ankle_room,
    capture_step,
    capture_time,
    exceeds_support,
    follow_body,
    place_foot,
    zmp_shift,
)
from walking.plan.decision import detect_touchdown
from walking.plan.departure import end_capture
from walking.plan.footsteps import (
    STILL,
    Foothold,
    foothold,
    is_close,
    landing_of,
    put,
    reachable,
)
from walking.plan.gait import (
    advance,
    is_double,
    phase_of,
    retime,
    start,
    support_foot,
    swing_foot,
    swing_of,
    zmp_under,
)
from walking.plan.generator import advance_pendulum
from walking.plan.pendulum import hold_tick
from walking.plan.steering import follow_command, moves, set_wanted_strides, use_next_timing
from walking.plan.support import support_region

GENERATORS = ["preview", "mwpg"]
NONE = (0.0, 0.0)
LEFT = Foothold(True, 0.0, 0.042, 0.0)
AHEAD = (0.005, -0.02)  # of the planned DCM from the ZMP [m]
STABILIZER = StabilizerParameters()


@given(st.floats(4.0, 12.0), st.floats(1e-3, 0.05), st.floats(0.0, 60.0))
def test_the_closed_loop_has_the_wanted_pole_and_none_slower(omega, lag, rate):
    assume(lag * (2.0 * rate + omega) < 0.999)
    gain = ankle_gain(omega, lag, rate)
    poles = np.linalg.eigvals([[omega, -omega], [gain / lag, -1.0 / lag]])
    assert np.abs(poles.imag).max() < 1e-6 / lag
    assert poles.real.max() == pytest.approx(-rate, abs=1e-6 / lag)


def test_without_a_lag_the_gain_is_the_usual_one_and_a_slow_servo_gets_a_double_pole():
    assert ankle_gain(7.0, 0.0, 3.5) == pytest.approx(1.5)
    omega, lag = 7.0, 0.05
    gain = ankle_gain(omega, lag, 10.0)
    poles = np.linalg.eigvals([[omega, -omega], [gain / lag, -1.0 / lag]])
    assert poles == pytest.approx([-6.5, -6.5], abs=1e-5)


def landing_error(model, time, planned, off, ahead):
    """How far the DCM is from where it was due, the pendulum stepped tick by tick."""
    omega = float(model.robot.omega)
    x, v = 0.0, (ahead + off) * omega
    for _ in range(round(time / CONTROL_PERIOD)):
        x, v = hold_tick(model.robot, x, v, 0.0)
    return x + v / omega - ahead * exp(omega * planned)


@pytest.mark.parametrize("ahead", [-0.02, 0.0, 0.015])
@pytest.mark.parametrize(("off", "reach"), [(0.06, 0.15), (-0.05, -0.12), (0.07, 0.05)])
def test_the_capture_time_is_the_latest_sufficient_tick(model, off, ahead, reach):
    planned = 0.34
    ticks = [
        k
        for k in range(round(planned / CONTROL_PERIOD) + 1)
        if np.sign(off) * landing_error(model, k * CONTROL_PERIOD, planned, off, ahead)
        <= abs(reach)
    ]
    time = capture_time(float(model.robot.omega), planned, off, ahead, reach)
    assert int(time / CONTROL_PERIOD + 1e-6) == max(ticks, default=0)


def test_the_ankles_push_the_zmp_beyond_the_error_within_the_sole(model, robot):
    margin = STABILIZER.sole_margin
    region = support_region(model.robot.support, LEFT, LEFT, margin)
    middle = (float(model.robot.support.centre), 0.042)
    dx, dy = zmp_shift(middle, (0.01, 0.005), region, model.robot)
    lag = robot.damping[4] / robot.stiffness[4]
    gain = ankle_gain(float(model.robot.omega), lag, STABILIZER.dcm_rate)
    assert gain > 1.0
    assert (dx, dy) == pytest.approx((gain * 0.01, gain * 0.005))
    dx, _ = zmp_shift(middle, (0.5, 0.0), region, model.robot)
    assert dx == pytest.approx(model.robot.support.half_length - margin)


def captured(model, error, ticks_left=40, velocity=None, strides_of=None):
    landing = landing_of(LEFT, strides_of(velocity or STILL))
    x, y = zmp_under(LEFT, model.robot)
    dcm = (x + AHEAD[0], y + AHEAD[1])
    return capture_step(LEFT, landing, error, (x, y), dcm, ticks_left, model.robot), landing


def test_small_errors_need_no_step_and_larger_ones_grow_from_nothing(model, strides_of):
    for error, expected in (((0.005, 0.002), False), ((0.05, 0.0), True), ((0.0, -0.05), True)):
        assert captured(model, error, strides_of=strides_of)[0].needed is expected
    capture, landing = captured(model, (0.005, 0.002), strides_of=strides_of)
    assert capture.landing == pytest.approx(landing)
    assert capture.ticks == 40


def test_an_error_beyond_the_dead_zone_keeps_the_timing_where_the_ankles_have_no_room(
    model, strides_of
):
    """The planned ZMP is at the edge of the sole; the landing alone captures the error."""
    robot, landing = model.robot, landing_of(LEFT, strides_of(STILL))
    length = float(robot.support.half_length) - STABILIZER.sole_margin
    zone = STABILIZER.capture_dead_zone * length
    zmp = (LEFT.x + float(robot.support.centre) + length, zmp_under(LEFT, robot)[1])
    dcm = (zmp[0] + AHEAD[0], zmp[1] + AHEAD[1])
    for error in (zone + 0.002, zone + 0.005):
        capture = capture_step(LEFT, landing, (error, 0.0), zmp, dcm, 30, robot)
        assert capture.needed
        assert capture.landing.x > landing.x
        assert capture.ticks == 30


@pytest.mark.parametrize("yaw", [0.0, 0.6])
def test_the_room_of_the_ankles_is_from_the_planned_zmp_to_the_edge(model, yaw):
    robot, foot = model.robot, Foothold(True, 0.3, 0.1, yaw)
    length = float(robot.support.half_length) - STABILIZER.sole_margin
    width = float(robot.support.half_width) - STABILIZER.sole_margin
    u, v = robot.support.centre + 0.008, -0.012
    zmp = (0.3 + cos(yaw) * u - sin(yaw) * v, 0.1 + sin(yaw) * u + cos(yaw) * v)
    for sign in (1.0, -1.0):
        room = ankle_room(foot, zmp, (0.01 * sign, 0.01 * sign), robot)
        assert room == pytest.approx((length - sign * 0.008, width + sign * 0.012))
    assert ankle_room(foot, (9.0, 9.0), (1.0, 1.0), robot) == (0.0, 0.0)


def test_a_standing_robot_has_the_support_of_two_soles(model, make_walk):
    walk, robot = make_walk(), model.robot
    pendulum, error = walk.pendulum, walk.error
    pendulum.zmp_x = float(robot.support.centre)
    width = float(robot.support.half_width) - STABILIZER.sole_margin
    for aside, expected in ((width + 0.01, False), (0.042 + width + 0.001, True)):
        for sign in (1.0, -1.0):
            error.dcm_x, error.dcm_y = 0.0, sign * aside
            assert exceeds_support(walk, 1.0, robot) is expected
    length = float(robot.support.half_length) - STABILIZER.sole_margin
    error.dcm_x, error.dcm_y = length + 0.001, 0.0
    assert exceeds_support(walk, 1.0, robot)


def test_the_capture_step_lands_where_the_error_will_be(model, strides_of):
    zmp = zmp_under(LEFT, model.robot)
    length, _ = ankle_room(LEFT, zmp, (1.0, 0.0), model.robot)
    zone = STABILIZER.capture_dead_zone * length
    capture, landing = captured(
        model, (zone + 0.01, 0.0), 30, velocity=(0.1, 0.0, 0.0), strides_of=strides_of
    )
    growth = exp(float(model.robot.omega) * 30 * CONTROL_PERIOD)
    assert capture.landing.x - landing.x == pytest.approx(0.01 * growth)
    assert capture.landing.y == pytest.approx(landing.y)
    assert capture.ticks == 30


def test_a_hopeless_error_gives_a_reachable_landing_at_once(model, strides_of):
    capture, _ = captured(model, (1.0, -1.0), strides_of=strides_of)
    limits, half = model.robot.limits, model.robot.gait.half_stance
    assert abs(capture.landing.x - LEFT.x) <= limits.reach_forward + 1e-9
    assert LEFT.y - capture.landing.y <= 2 * half + limits.reach_side + 1e-9
    assert capture.ticks < 10


def test_a_footstep_is_shortened_only_when_its_landing_is_out_of_reach(model, strides_of):
    ticks = [captured(model, (0.001 * e, 0.0), strides_of=strides_of)[0].ticks for e in range(150)]
    assert ticks[0] == ticks[60] == 40
    assert ticks[-1] < 20
    assert all(later <= sooner for sooner, later in pairwise(ticks))


class Walk:
    """Steering, gait and pendulum with a DCM error chosen by the test."""

    def __init__(self, model, make_walk):
        self.model = model
        self.walk = make_walk()
        self.live, self.placing, self.bound = self.walk.plan, self.walk.placing, 0
        self.gait, pendulum = self.live.gait, self.walk.pendulum
        shift = self.gait.clock.shift
        pendulum.x = pendulum.zmp_x = shift.zmp_x
        pendulum.y = pendulum.zmp_y = shift.zmp_y

    def steer(self, velocity):
        walk, robot = self.walk, self.model.robot
        walk.steering.command.velocity = velocity
        follow_command(walk.steering, 1.0, True, True, robot)

    def tick(self, velocity, error=NONE):
        walk, gait, model = self.walk, self.gait, self.model
        robot, steering = model.robot, walk.steering
        remember(walk)
        self.steer(velocity)
        timing = walk.admission.between
        use_next_timing(timing, steering, gait.clock.timing, gait.stepping)
        retime(gait, timing, robot)
        if not gait.stepping and moves(steering):
            start(gait, 0, False, robot)
        set_wanted_strides(steering, STILL, robot)
        loading = support_foot(gait)
        unloading = swing_foot(gait) if is_double(gait) else loading
        margin = robot.pattern.sole_margin
        region = support_region(robot.support, unloading, loading, margin)
        walk.error.dcm_x, walk.error.dcm_y = error
        self.bound = place_foot(walk, region, robot)
        advance_pendulum(walk, region, robot)
        advance(self.live, walk.limbs.feet, robot)
        end_capture(walk)

    def to_swing(self, velocity, phase=0.3):
        """Walk until a foot swings, some footsteps on."""
        for _ in range(500):
            self.tick(velocity)
            if self.gait.completed == 4 and phase_of(self.gait).swing > phase:
                return self
        raise AssertionError("no footsteps")

    @property
    def moved(self):
        return float(self.placing.moved_x), float(self.placing.moved_y)


@pytest.fixture(scope="module")
def models(make_model):
    return {name: make_model(name) for name in GENERATORS}


@pytest.mark.parametrize("generator", GENERATORS)
def test_a_steady_undisturbed_walk_follows_the_wanted_strides(models, make_walk, generator):
    walk, velocity = Walk(models[generator], make_walk), (0.2, 0.03, 0.2)
    walk.to_swing(velocity)
    for _ in range(200):
        walk.tick(velocity)
        assert walk.bound == 0
        assert walk.moved == NONE
        assert walk.placing.applied.item() == velocity
        assert walk.walk.admission.fraction == 1.0


@pytest.mark.parametrize("generator", GENERATORS)
@pytest.mark.parametrize(
    ("error", "axis"), [((0.025, 0.0), 0), ((-0.025, 0.0), 0), ((0.0, 0.02), 1)]
)
def test_a_capture_step_follows_the_error_and_reports_balance(
    models, make_walk, generator, error, axis
):
    walk, velocity = Walk(models[generator], make_walk), (0.1, 0.0, 0.0)
    walk.to_swing(velocity)
    if swing_of(walk.gait) == 1:
        error = error[0], -error[1]  # to the side of the swing foot
    walk.tick(velocity, error)
    assert walk.moved[axis] * error[axis] > 0.0
    assert abs(walk.moved[axis]) > abs(error[axis])
    assert walk.bound & BALANCE
    robot = walk.model.robot
    landing = foothold(walk.gait.landing)
    within = reachable(support_foot(walk.gait), landing, 0.0, 0.0, robot)
    assert is_close(within, landing, robot)


@pytest.mark.parametrize(("ratio", "ends"), [(0.9, False), (1.1, True)])
def test_an_early_touchdown_ends_the_support_only_beyond_the_margin(models, make_walk, ratio, ends):
    walk, velocity = Walk(models["preview"], make_walk), (0.1, 0.0, 0.0)
    walk.to_swing(velocity, 0.7)
    state, robot = walk.walk, walk.model.robot
    margin = float(robot.support.half_length) - STABILIZER.sole_margin
    state.error.dcm_x, state.error.dcm_y = ratio * margin, 0.0
    state.body.feet[swing_of(walk.gait)].load = 10.0 * robot.estimator.contact_force
    for _ in range(int(robot.estimator.contact_ticks)):
        detect_touchdown(state, robot)
    assert walk.gait.landed_early
    assert (phase_of(walk.gait).ticks_left <= 1) is ends


def test_during_a_capture_step_the_plan_goes_on_without_the_body_until_touchdown(models, make_walk):
    walk, velocity = Walk(models["mwpg"], make_walk), (0.1, 0.0, 0.0)
    alone = Walk(models["mwpg"], make_walk)
    walk.to_swing(velocity)
    alone.to_swing(velocity)
    walk.tick(velocity, (0.02, 0.0))
    alone.tick(velocity)
    assert walk.walk.off_plan
    assert walk.walk.planned.item() == alone.walk.pendulum.item()
    assert walk.walk.pendulum.item() != alone.walk.pendulum.item()
    while not is_double(walk.gait):
        walk.tick(velocity)
    assert not walk.walk.off_plan


@pytest.fixture
def pushed():
    """State of a walk with the left foot at `LEFT`."""
    walk = records(Data)[0]
    put(walk.plan.gait.footholds[0], LEFT)
    return walk


@pytest.mark.parametrize("off", [(0.06, 0.01), (-0.02, 0.05), (0.01, -0.2)])
def test_a_plan_that_follows_the_body_keeps_body_and_dcm(model, pushed, off):
    robot, error, pendulum = model.robot, pushed.error, pushed.pendulum
    error.x, error.y = (0.4 * e for e in off)
    error.vx, error.vy = (0.6 * robot.omega * e for e in off)
    error.dcm_x, error.dcm_y = off
    follow_body(pushed, robot)
    dcm = (pendulum.x + pendulum.vx / robot.omega, pendulum.y + pendulum.vy / robot.omega)
    assert pendulum.x + error.x == pytest.approx(0.4 * off[0])
    assert pendulum.vy + error.vy == pytest.approx(0.6 * robot.omega * off[1])
    assert np.add(dcm, (error.dcm_x, error.dcm_y)) == pytest.approx(off)
    assert 0.0 < dcm[1] / off[1] < 1.0
