"""Steering: commands to wanted strides, and the limits that bind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.command import ACCELERATION, BALANCE, COMBINED_SPEED, STRIDE_LIMITS
from walking.constants import parameters_record
from walking.data import Data, Steering
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.plan.footsteps import STILL, mean_velocity
from walking.plan.steering import (
    follow_command,
    limited,
    moves,
    set_wanted_strides,
    twist_of,
)
from walking.plan.timing import cadence, duration, put_timing
from walking.published import Published, publish_limits

LIMITS = WalkingParameters().limits
LONG = 250  # control ticks in which any velocity is reached
velocities = st.tuples(st.floats(-0.7, 0.7), st.floats(-0.3, 0.3), st.floats(-2.5, 2.5))
walks = st.lists(st.tuples(velocities | st.just(STILL), st.integers(1, 30)), max_size=4)
generators = st.sampled_from(("preview", "mwpg"))
speeds = st.floats(-2.0, 2.0)
PARAMETERS = parameters_record(WalkingParameters())[0]


class Steered:
    """Steering record that follows commands."""

    def __init__(self, model):
        self.model = model
        self.record, self.bound = np.zeros(1, Steering)[0], 0
        put_timing(self.record.timing, cadence(STILL, model.robot))

    def follow(self, velocity, *, ticks=1, fraction=1.0, balanced=True):
        self.record.command.velocity = velocity
        model = self.model
        for _ in range(ticks):
            self.bound = follow_command(self.record, fraction, True, balanced, model.robot)

    @property
    def velocity(self):
        return twist_of(self.record.velocity)


@pytest.fixture(scope="module")
def steer(make_model):
    models = {name: make_model(name) for name in ("preview", "mwpg")}
    return lambda generator="preview": Steered(models[generator])


@given(speeds, speeds, speeds)
def test_limited_velocity_is_within_every_limit(vx, vy, wz):
    (f, s, t), bound = limited((vx, vy, wz), PARAMETERS)
    assert -LIMITS.vx_backward <= f <= LIMITS.vx
    assert abs(s) <= LIMITS.vy
    assert abs(t) <= LIMITS.wz
    ahead = LIMITS.vx if f >= 0.0 else LIMITS.vx_backward
    norm = (f / ahead) ** 2 + (s / LIMITS.vy) ** 2 + (t / LIMITS.wz) ** 2
    assert norm <= LIMITS.combined**2 + 1e-9
    if bound & COMBINED_SPEED:
        assert norm == pytest.approx(LIMITS.combined**2)


@given(speeds, speeds, speeds)
def test_limits_are_idempotent_and_mirror(vx, vy, wz):
    once, _ = limited((vx, vy, wz), PARAMETERS)
    assert limited(once, PARAMETERS)[0] == pytest.approx(once)
    mirrored, _ = limited((vx, -vy, -wz), PARAMETERS)
    assert mirrored == pytest.approx((once[0], -once[1], -once[2]))


@settings(max_examples=25)
@given(st.floats(-0.2, 0.2), st.floats(-0.05, 0.05), st.floats(-0.3, 0.3), generators)
def test_a_command_within_the_limits_is_followed_exactly(steer, vx, vy, wz, generator):
    steering = steer(generator)
    steering.follow((vx, vy, wz), ticks=LONG)
    assert steering.velocity == (vx, vy, wz)
    assert not steering.bound & ~STRIDE_LIMITS
    record, model = steering.record, steering.model
    set_wanted_strides(record, STILL, model.robot)
    if not steering.bound:
        made = mean_velocity(record.wanted, duration(record.timing), model.robot)
        assert made == pytest.approx((vx, vy, wz), abs=1e-9)


@settings(max_examples=25)
@given(walks, generators)
def test_a_command_is_reported_as_limited_if_and_only_if_it_is(steer, walk, generator):
    steering, state = steer(generator), np.zeros(1, Data)[0]
    published = np.zeros(1, Published)[0]
    record, model = steering.record, steering.model
    for command, ticks in walk:
        for _ in range(ticks):
            steering.follow(command)
            error = max(abs(a - b) for a, b in zip(steering.velocity, command, strict=True))
            at_rest = command != STILL or steering.velocity == STILL
            assert bool(steering.bound & ~STRIDE_LIMITS) is (error > 1e-9 or not at_rest)
            state.steering, state.placing.applied = record, steering.velocity
            state.plan.gait.clock.timing, state.limits = record.timing, steering.bound
            publish_limits(published, state, model.robot)
            if steering.bound and not steering.bound & STRIDE_LIMITS:
                assert tuple(published.applied[:3]) == pytest.approx(steering.velocity, abs=1e-9)


@settings(max_examples=25)
@given(walks)
def test_the_velocity_rises_no_faster_than_the_limits(steer, walk):
    steering = steer()
    most = (LIMITS.forward_acceleration, LIMITS.lateral_acceleration, LIMITS.turn_acceleration)
    for command, ticks in walk:
        for _ in range(ticks):
            before = steering.velocity
            steering.follow(command)
            within = limited(steering.velocity, PARAMETERS)[0] == pytest.approx(steering.velocity)
            assert within or steering.bound & ACCELERATION
            for old, new, rate in zip(before, steering.velocity, most, strict=True):
                assert abs(new) - abs(old) <= rate * CONTROL_PERIOD + 1e-12


@settings(max_examples=25)
@given(velocities, generators)
def test_a_stop_is_followed_at_once_if_the_generator_limits_it_and_in_the_braking_time_else(
    steer, velocity, generator
):
    steering = steer(generator)
    steering.follow(velocity, ticks=LONG)
    moving = moves(steering.record)
    steering.follow(STILL)
    if generator == "mwpg":
        assert not moves(steering.record)
        assert steering.bound == 0
    elif moving:
        assert moves(steering.record) is bool(steering.bound & ACCELERATION)
    steering.follow(STILL, ticks=round(LIMITS.braking_time / CONTROL_PERIOD))
    assert not moves(steering.record)


@pytest.mark.parametrize("wanted", [0.0, 0.1, -0.3])
def test_a_walk_is_braked_in_the_braking_time_and_reverses_through_rest(steer, wanted):
    steering = steer("preview")
    steering.follow((LIMITS.vx, 0.0, 0.0), ticks=LONG)
    path = [steering.velocity[0]]
    while steering.velocity[0] > max(wanted, 0.0):
        steering.follow((wanted, 0.0, 0.0))
        path.append(steering.velocity[0])
    assert path[-1] == max(wanted, 0.0)
    assert len(path) * CONTROL_PERIOD <= LIMITS.braking_time + 2.0 * CONTROL_PERIOD


def test_a_slowed_walk_keeps_the_direction_of_the_command(steer):
    steering = steer("preview")
    steering.follow((0.2, 0.05, 0.3), ticks=1000, fraction=0.4)
    assert steering.velocity == pytest.approx((0.08, 0.02, 0.12))
    assert steering.bound == BALANCE


def test_a_robot_off_balance_keeps_its_motion(steer):
    steering = steer()
    steering.follow((0.2, 0.0, 0.0), ticks=LONG)
    steering.follow((0.3, 0.0, 0.0), balanced=False)
    assert steering.velocity == (0.2, 0.0, 0.0)
    assert steering.bound == BALANCE
    steering.follow((0.2, 0.0, 0.0), balanced=False)
    assert steering.bound == 0
