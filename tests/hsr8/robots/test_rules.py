"""Rules for robots that are not built like HSR-VIII."""

from dataclasses import replace

import numpy as np
import pytest

from hsr8.robots.walk import rules
from walking.body.robot_model import MAX_COMPLIANCE, MAX_STIFFENING, RobotModel
from walking.constants import parameters_for
from walking.parameters import CONTROL_PERIOD, WalkingParameters

KNEES = [3, 9]
ANKLES = [4, 5, 10, 11]
DEFAULTS = WalkingParameters()


@pytest.fixture(scope="module")
def other(robot):
    """Builds HSR-VIII with another sole, or with factors on the numbers of some joints."""

    def build(half_width=None, joints=slice(0, 12), **factors):
        tree = robot.tree
        changes = {}
        for name, factor in factors.items():
            values = getattr(tree, name).copy()
            values[joints] *= factor
            changes[name] = values
        if half_width is not None:
            changes["sole"] = replace(tree.sole, half_width=half_width)
        model = RobotModel(replace(tree, **changes))
        model.stand(DEFAULTS.pattern.pelvis_height, DEFAULTS.gait.half_stance)
        return model

    return build


def test_the_rules_leave_stance_timing_and_landing_of_the_reference_alone(robot):
    fitted = rules.fit(robot, DEFAULTS)
    assert fitted.gait == DEFAULTS.gait
    assert fitted.pattern.pelvis_height == DEFAULTS.pattern.pelvis_height


@pytest.mark.parametrize("half_width", [0.012, 0.02, 0.03])
def test_narrow_soles_keep_a_support_area(other, half_width):
    made = rules.fit(other(half_width), DEFAULTS)
    assert made.stabilizer.sole_margin <= half_width / 3.0


def test_soft_ankles_are_not_damped_into_an_oscillation(other):
    soft = other(joints=ANKLES, stiffness=0.05)
    scaled = parameters_for(soft)
    assert scaled.stabilizer.gyro_gain > rules.MAX_GYRO_GAIN
    assert rules.fit(soft, scaled).stabilizer.gyro_gain == rules.MAX_GYRO_GAIN


@pytest.mark.parametrize("half_width", [0.03, 0.045, 0.06])
def test_soles_do_not_overlap_in_the_stance(other, half_width):
    gait = rules.with_clear_stance(other(half_width), DEFAULTS.gait)
    assert gait.half_stance >= half_width + gait.foot_clearance - 1e-12
    assert gait.half_stance >= min(DEFAULTS.gait.half_stance, 0.2 * 0.245)


def test_a_stance_is_no_wider_than_the_legs_can_shift(robot):
    wide = replace(DEFAULTS.gait, half_stance=0.15)
    assert rules.with_clear_stance(robot, wide).half_stance == 0.2 * robot.legs[0].length


def test_slow_servos_get_longer_footsteps_up_to_a_bound(other):
    times = []
    for factor in (1.0, 4.0, 6.0, 30.0):
        slow = other(servo_damping=factor, joint_damping=factor)
        time = rules.with_servo_time(slow, DEFAULTS.gait).footstep_time
        lag = (slow.damping / slow.stiffness)[:12].max()
        assert time >= min(rules.MIN_LAGS * lag, 1.4 * DEFAULTS.gait.footstep_time) - 1e-12
        times.append(time)
    assert times == sorted(times)
    assert times[0] == DEFAULTS.gait.footstep_time
    assert times[-1] == 1.4 * DEFAULTS.gait.footstep_time


def test_narrow_soles_get_calm_landings(other):
    speeds, freezes = [], []
    for half_width in (0.03, 0.02, 0.01):
        gait = rules.with_calm_landing(other(half_width), DEFAULTS.gait)
        speeds.append(gait.landing_speed)
        freezes.append(gait.landing_freeze)
    assert speeds == pytest.approx([4.0, 4.0 * 2 / 3, 4.0 / 3])
    assert freezes == sorted(freezes, reverse=True)
    assert 0.0 < freezes[-1] < freezes[0] == pytest.approx(0.8)


@pytest.mark.parametrize("strength", [1.0, 0.3, 0.1])
def test_hips_rise_until_weak_knees_carry_the_robot(other, robot, strength):
    weak = other(joints=KNEES, effort=strength)
    half_stance, low = DEFAULTS.gait.half_stance, 0.7 * robot.legs[0].length
    height = rules.hip_height(weak, DEFAULTS.gait, low)
    load = rules.one_leg_load(weak, half_stance, height)[KNEES].max()
    highest = rules.MAX_HEIGHT * robot.legs[0].length
    assert load <= rules.MAX_LOAD or height >= highest - 2.0 * rules.RAISE * robot.legs[0].length
    if rules.one_leg_load(weak, half_stance, low)[KNEES].max() > rules.MAX_LOAD:
        assert height > low


def test_hips_rise_until_the_ankles_leave_their_limits(robot):
    tree = robot.tree
    lower = tree.lower.copy()
    lower[[4, 10]] = -0.7
    stiff_ankles = RobotModel(replace(tree, lower=lower))
    low = 0.75 * robot.legs[0].length
    height = rules.hip_height(stiff_ankles, DEFAULTS.gait, low)
    assert rules.stride_room(stiff_ankles, DEFAULTS.gait.half_stance, low) < rules.JOINT_ROOM
    assert rules.stride_room(stiff_ankles, DEFAULTS.gait.half_stance, height) >= rules.JOINT_ROOM


def test_the_lateral_reach_ends_where_the_ankles_would_leave_their_limits(robot):
    wide, height = DEFAULTS.limits, DEFAULTS.pattern.pelvis_height
    reaches = []
    for roll in (0.8, 0.35, 0.25, 0.15):
        lower, upper = robot.tree.lower.copy(), robot.tree.upper.copy()
        lower[[5, 11]], upper[[5, 11]] = -roll, roll
        stiff_ankles = RobotModel(replace(robot.tree, lower=lower, upper=upper))
        limits = rules.with_side_reach(stiff_ankles, wide, DEFAULTS.gait.half_stance, height)
        assert replace(limits, reach_side=wide.reach_side) == wide
        reaches.append(limits.reach_side)
    assert reaches[0] == wide.reach_side
    assert reaches == sorted(reaches, reverse=True)
    assert reaches[-1] < 0.9 * wide.reach_side
    outward = DEFAULTS.gait.half_stance + 0.5 * reaches[-1] - robot.legs[0].hip[1]
    assert outward <= height * np.tan(0.15 - rules.JOINT_ROOM)


def test_the_load_on_one_leg_is_mirrored_and_relative_to_the_torque(other):
    strong = rules.one_leg_load(other(), 0.04, 0.2)
    weak = rules.one_leg_load(other(effort=0.7), 0.04, 0.2)
    np.testing.assert_allclose(weak, strong / 0.7)
    np.testing.assert_allclose(strong[:6], strong[6:], atol=0.02)


def test_soft_legs_are_stiffened_by_feedback_up_to_a_bound(other, robot):
    assert robot.stiffening == 1.0
    factors = [other(stiffness=s).stiffening for s in (0.5, 0.08, 0.05, 0.01)]
    assert factors[0] == 1.0
    assert factors == sorted(factors)
    assert factors[-1] == MAX_STIFFENING
    soft = other(stiffness=0.05)
    assert soft.measures().ankle == pytest.approx(MAX_COMPLIANCE, rel=1e-5)


def test_weak_ankles_press_a_part_of_the_sole(other, robot):
    assert robot.support is robot.sole
    weak = other(joints=ANKLES, effort=0.2)
    assert weak.support.half_length < weak.sole.half_length
    assert weak.support.half_width < weak.sole.half_width
    reach = abs(weak.support.centre) + weak.support.half_length
    assert reach * weak.mass * 9.81 < weak.tree.effort[4]


def test_footsteps_are_whole_ticks_after_all_rules(other):
    slow = other(servo_damping=5.0)
    time = rules.fit(slow, DEFAULTS).gait.footstep_time
    assert round(time / CONTROL_PERIOD) > 10
