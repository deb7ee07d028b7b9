"""Dimensions, and parameters scaled to other robots by dynamic similarity."""

from dataclasses import fields, replace
from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.command import CommandState, VelocityCommand
from walking.constants import parameters_for
from walking.dimension import (
    DECAY_PER_TICK,
    GAIN_PER_TICK,
    HSR_VIII,
    LENGTH,
    RATE,
    Dimension,
    RobotMeasures,
    rules_of,
    scale_parameters,
)
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters

SECTIONS = [type(getattr(WalkingParameters(), f.name)) for f in fields(WalkingParameters)]


def scaled(y: RobotMeasures, size: float) -> RobotMeasures:
    return RobotMeasures(
        y.leg * size, y.hip * size, y.sole * size, y.time * sqrt(size), y.weight * size**3, y.ankle
    )


def numbers(parameters: WalkingParameters) -> dict[str, float]:
    return {
        f"{group.name}.{f.name}": getattr(getattr(parameters, group.name), f.name)
        for group in fields(parameters)
        for f in fields(getattr(parameters, group.name))
        if isinstance(getattr(getattr(parameters, group.name), f.name), float)
    }


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.__name__)
def test_every_parameter_has_a_scaling_rule(section):
    floats = {f.name for f in fields(section) if isinstance(f.default, float)}
    unmarked = floats - set(rules_of(section))
    assert not unmarked, f"mark them as in walking/dimension.py: {sorted(unmarked)}"


def test_the_parameters_of_the_reference_are_the_defaults(robot):
    # After a change of the model: choose the defaults for it, then give HSR_VIII its measures.
    assert robot.measures() == HSR_VIII
    assert parameters_for(robot) == WalkingParameters()


@pytest.mark.parametrize("size", [0.3, 0.8, 1.3, 4.0])
def test_dimensionless_numbers_stay_what_they_are(size):
    old, new = HSR_VIII, scaled(HSR_VIII, size)
    made = scale_parameters(WalkingParameters(), old, new)

    def groups(p, y):
        w = sqrt(GRAVITY / p.pattern.lipm_height)
        step = p.limits.vx * p.gait.footstep_time
        return (
            w * p.gait.footstep_time,
            p.limits.vx**2 / (GRAVITY * y.leg),
            step / p.limits.step_forward,
            p.pattern.pelvis_height / y.leg,
            p.gait.half_stance / y.hip,
            p.limits.wz * p.gait.footstep_time,
            p.limits.forward_acceleration / GRAVITY,
            p.estimator.contact_force / y.weight,
            p.arms.swing_gain * step,
            p.stabilizer.gyro_gain * w,
            p.stabilizer.tilt_decay ** (p.gait.footstep_time / CONTROL_PERIOD),
            (1.0 - p.estimator.tilt_gain) ** (p.gait.footstep_time / CONTROL_PERIOD),
        )

    assert groups(made, new) == pytest.approx(groups(WalkingParameters(), old), rel=1e-12)


def test_a_softer_ankle_is_moved_further():
    soft = replace(HSR_VIII, ankle=2.0 * HSR_VIII.ankle)
    made = scale_parameters(WalkingParameters(), HSR_VIII, soft)
    before = numbers(WalkingParameters())
    changed = {name for name, value in numbers(made).items() if value != before[name]}
    assert changed == {"stabilizer.gyro_gain"}
    assert made.stabilizer.gyro_gain == 2.0 * before["stabilizer.gyro_gain"]


def test_a_command_is_carried_over_whole():
    double = replace(HSR_VIII, leg=2.0 * HSR_VIII.leg, hip=2.0 * HSR_VIII.hip)
    made = scale_parameters(CommandState(forward=0.1), HSR_VIII, double)
    assert (made.forward, made.side, made.swing_height) == (0.2, 0.168, 0.05)
    assert made.single_support == CommandState().single_support
    assert scale_parameters(VelocityCommand(0.2, 0.1, 0.5), HSR_VIII, scaled(HSR_VIII, 4.0)) == (
        VelocityCommand(0.4, 0.2, 0.25)
    )


SIZE = st.floats(0.3, 4.0)
ROBOT = st.builds(RobotMeasures, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE)
POWER = st.integers(-2, 2).map(float)
DIMENSION = st.builds(Dimension, POWER, POWER, POWER, POWER, POWER, POWER)


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


@pytest.mark.parametrize("slower", [0.5, 3.0])
def test_as_much_is_left_after_the_same_phase_of_the_gait(slower):
    other = replace(HSR_VIII, time=slower * HSR_VIII.time)
    left = DECAY_PER_TICK.scale(0.9, HSR_VIII, other)
    assert left ** (40 * slower) == pytest.approx(0.9**40)
    assert GAIN_PER_TICK.scale(0.1, HSR_VIII, other) == pytest.approx(1.0 - left, rel=1e-12)
