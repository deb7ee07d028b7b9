"""Dimensions multiply, and scale values from robot to robot and back."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.dimension import (
    ACCELERATION,
    DECAY_PER_TICK,
    GAIN_PER_TICK,
    HSR_VIII,
    LENGTH,
    NUMBER,
    RATE,
    SPEED,
    STANCE,
    TIME,
    Dimension,
    RobotMeasures,
)

SIZE = st.floats(0.3, 4.0)
ROBOT = st.builds(RobotMeasures, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE)
POWER = st.integers(-2, 2).map(float)
DIMENSION = st.builds(Dimension, POWER, POWER, POWER, POWER, POWER, POWER)


def test_they_multiply():
    assert SPEED * TIME == LENGTH
    assert ACCELERATION == SPEED / TIME
    assert RATE * TIME == NUMBER
    assert LENGTH**2.0 == LENGTH * LENGTH
    assert STANCE != LENGTH


@given(DIMENSION, DIMENSION, ROBOT, ROBOT)
def test_a_product_scales_as_its_factors(one, other, old, new):
    whole = (one * other).scale(6.0, old, new)
    assert whole == pytest.approx(one.scale(2.0, old, new) * other.scale(3.0, old, new))


@pytest.mark.parametrize("rule", [LENGTH, RATE, DECAY_PER_TICK, GAIN_PER_TICK])
@given(ROBOT, ROBOT)
def test_scaling_is_invertible_and_composes_over_a_third_robot(rule, old, new):
    there = rule.scale(0.3, old, new)
    assert rule.scale(there, new, old) == pytest.approx(0.3)
    between = rule.scale(0.3, old, HSR_VIII)
    assert rule.scale(between, HSR_VIII, new) == pytest.approx(there)


@given(ROBOT)
def test_the_same_robot_keeps_every_bit(robot):
    for rule in (NUMBER, LENGTH, DECAY_PER_TICK, GAIN_PER_TICK):
        assert rule.scale(0.37, robot, robot) == 0.37


@pytest.mark.parametrize("slower", [0.5, 3.0])
def test_as_much_is_left_after_the_same_phase_of_the_gait(slower):
    other = replace(HSR_VIII, time=slower * HSR_VIII.time)
    left = DECAY_PER_TICK.scale(0.9, HSR_VIII, other)
    assert left ** (40 * slower) == pytest.approx(0.9**40)
    assert GAIN_PER_TICK.scale(0.1, HSR_VIII, other) == pytest.approx(1.0 - left, rel=1e-12)
