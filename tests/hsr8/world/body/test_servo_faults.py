import numpy as np

from hsr8.scenario.fault import ServoDelay, ServoStuck
from hsr8.world.body.servo_faults import ServoFaults
from walking.targets import JointTargets

KNEE = 3


def asked(tick):
    return JointTargets(np.full(26, float(tick)), np.full(26, 0.01 * tick))


def told(faults, ticks=12):
    """What the left knee and the right one are told in every tick."""
    servos = ServoFaults(faults)
    said = [servos.apply_fault(asked(tick), tick) for tick in range(ticks)]
    assert all(t.setpoint[k] == 0.01 * t.position[k] for t in said for k in range(26))
    return [int(t.position[KNEE]) for t in said], [int(t.position[KNEE + 6]) for t in said]


def test_without_a_fault_the_targets_pass_as_they_are():
    targets = asked(1)
    assert ServoFaults([]).apply_fault(targets, 1) is targets


def test_a_stuck_servo_keeps_what_it_was_told_last():
    stuck = ServoStuck(kind="servo-stuck", joint="l_knee", start=0.02, duration=0.02)
    left, right = told([stuck])
    assert left == [0, 1, 2, 3, 3, 3, 3, 3, 8, 9, 10, 11]
    assert right == [*range(12)]


def test_late_set_points_are_those_of_so_many_ticks_ago():
    late = ServoDelay(kind="servo-delay", magnitude=0.015, start=0.01, duration=0.03)
    left, right = told([late])
    assert left == right == [0, 1, 0, 0, 1, 2, 3, 4, 8, 9, 10, 11]


def test_a_servo_that_is_stuck_while_set_points_are_late_keeps_the_late_one():
    late = ServoDelay(kind="servo-delay", magnitude=0.01)
    stuck = ServoStuck(kind="servo-stuck", joint="l_knee", start=0.03)
    assert told([late, stuck])[0] == [0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3]
