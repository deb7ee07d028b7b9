import numpy as np

from hsr8.scenario.fault import ServoDelay, ServoStuck
from hsr8.world.body.servo_faults import ServoFaults
from walking.body.joints import JOINT_NAMES
from walking.targets import JointTargets

KNEE = 3


def commanded(tick):
    return JointTargets(np.full(26, float(tick)), np.full(26, 0.01 * tick))


def knees(faults, ticks=12):
    """Return the targets of the left and the right knee in every tick."""
    servos = ServoFaults(faults, JOINT_NAMES)
    applied = [servos.apply_fault(commanded(tick), tick) for tick in range(ticks)]
    assert all(t.setpoint[k] == 0.01 * t.position[k] for t in applied for k in range(26))
    return [int(t.position[KNEE]) for t in applied], [int(t.position[KNEE + 6]) for t in applied]


def test_without_a_fault_the_targets_pass_as_they_are():
    targets = commanded(1)
    assert ServoFaults([], JOINT_NAMES).apply_fault(targets, 1) is targets


def test_a_stuck_servo_keeps_its_last_setpoint():
    stuck = ServoStuck(kind="servo-stuck", joint="l_knee", start=0.02, duration=0.02)
    left, right = knees([stuck])
    assert left == [0, 1, 2, 3, 3, 3, 3, 3, 8, 9, 10, 11]
    assert right == [*range(12)]


def test_delayed_setpoints_are_those_of_earlier_ticks():
    late = ServoDelay(kind="servo-delay", magnitude=0.015, start=0.01, duration=0.03)
    left, right = knees([late])
    assert left == right == [0, 1, 0, 0, 1, 2, 3, 4, 8, 9, 10, 11]


def test_a_stuck_servo_keeps_a_delayed_setpoint():
    late = ServoDelay(kind="servo-delay", magnitude=0.01)
    stuck = ServoStuck(kind="servo-stuck", joint="l_knee", start=0.03)
    assert knees([late, stuck])[0] == [0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3]
