"""Compensation of the swing leg's reaction by the pelvis."""

from dataclasses import replace

import numpy as np
import pytest

from compilation.record import record_type
from walking.body.swing_reaction import compensate
from walking.command import HeadTarget, VelocityCommand
from walking.data import Gait, Limbs, Plan
from walking.engine import WalkingEngine
from walking.model import FootholdRecord
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.plan.footsteps import Foothold, put
from walking.plan.reference import zmp_under

DOUBLE, SINGLE = 10, 50  # control ticks of a footstep
STEP = DOUBLE + SINGLE
FIRST, LAST = 2, 48  # of the swing in single support
TICKS = LAST - FIRST


def foothold(n, stride, *, side=1.0, angle=0.0):
    """The n-th foothold of a straight walk in a direction [rad]."""
    flank = side * (-1.0) ** n
    place = np.exp(1j * angle) * complex(n * stride, -0.042 * flank)
    return Foothold(flank < 0.0, place.real, place.imag, angle)


def plan_at(k, stride, *, steps=6, **walk):
    """Plan in tick `k` of a walk that goes on for ever."""
    plan = np.zeros(1, record_type(gait=Gait, steps=(FootholdRecord, steps), step_count=int))[0]
    gait, n = plan.gait, k // STEP
    clock, support = gait.clock, foothold(n, stride, **walk)
    gait.stepping, gait.support = True, 0 if support.left else 1
    put(gait.footholds[gait.support], support)
    put(gait.footholds[1 - gait.support], foothold(n - 1, stride, **walk))
    put(gait.landing, foothold(n + 1, stride, **walk))
    clock.timing.double, clock.timing.single = DOUBLE, SINGLE
    clock.timing.swing_height = gait.swing_height = 0.025
    clock.single.ticks, clock.single.first, clock.single.last = SINGLE, FIRST, LAST
    gait.tick, clock.shift.end = k % STEP, DOUBLE
    for number in range(steps):
        put(plan.steps[number], foothold(n + 1 + number, stride, **walk))
    plan.step_count = steps
    return plan


@pytest.fixture
def track(model):
    """Offset and its acceleration tick by tick (n, 4)."""

    def run(stride, count=600, **walk):
        limbs, rows = np.zeros(1, Limbs)[0], []
        for k in range(count):
            compensate(limbs, plan_at(k, stride, **walk), model.robot)
            rows.append((*limbs.offset.item(), *limbs.offset_acceleration.item()))
        return np.array(rows)

    return run


def reaction_of(model, k, stride):
    """Shift of the ZMP by the swing under way at tick `k`, by the formula."""
    n, robot = k // STEP, model.robot
    u = (k % STEP - DOUBLE - FIRST) / TICKS
    if not 0.0 <= u <= 1.0:
        return np.zeros(2)
    zmp = np.array(zmp_under(foothold(n, stride), robot))
    T = TICKS * CONTROL_PERIOD
    moved = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
    height = 0.025 * np.polynomial.Polynomial([0, 4, -4]) ** 3
    a, b = (np.array(foothold(m, stride)[1:3]) for m in (n - 1, n + 1))
    up = height.deriv(2)(u) / T**2
    return (
        -robot.thrust * (b - a) * moved.deriv(2)(u) / T**2
        + robot.lifted_weight * up * (a + (b - a) * moved(u) - zmp)
        - robot.knee * up * np.array([1.0, 0.0])
    )


@pytest.mark.parametrize("stride", [0.0, 0.07, -0.05])
def test_the_offset_cancels_the_reaction(model, track, stride):
    rows, w2 = track(stride), float(model.robot.omega) ** 2
    for k in range(300, 600):
        undone = rows[k, :2] - rows[k, 2:] / w2
        assert undone == pytest.approx(-reaction_of(model, k, stride), abs=1e-9)


def test_the_acceleration_is_that_of_the_offset(track):
    rows = track(0.07)
    result = np.diff(rows[:, :2], n=2, axis=0) / CONTROL_PERIOD**2
    error = (result - rows[1:-1, 2:])[300:]
    assert np.sqrt((error**2).mean()) < 0.05 * np.sqrt((rows[301:-1, 2:] ** 2).mean())


def test_standing_the_pelvis_comes_back(model):
    limbs, standing = np.zeros(1, Limbs)[0], np.zeros(1, Plan)[0]
    for k in range(200):
        compensate(limbs, plan_at(k, 0.07), model.robot)
    for _ in range(400):
        compensate(limbs, standing, model.robot)
    assert np.abs(limbs.offset.item()).max() < 1e-6


def test_the_multibody_zmp_is_near_the_planned_one(robot, ideal_body):
    """Forward at 0.2 m/s; without the compensation the errors are 10 mm and 6 mm."""
    usual = WalkingParameters()
    # The pads of a body without dynamics do not measure its centre of pressure.
    parameters = replace(usual, stabilizer=replace(usual.stabilizer, com_offset_gain=0.0))
    engine = WalkingEngine(robot, parameters)
    rows = []
    for _ in range(900):
        targets = engine.step(ideal_body.sense(), VelocityCommand(0.2), HeadTarget())
        ideal_body.apply(targets)
        walk = engine._walk
        pendulum = walk.pendulum
        x, y, _ = walk.limbs.pelvis.item()
        rows.append([*targets.position, x, y, pendulum.zmp_x, pendulum.zmp_y])
    table = np.array(rows)
    rate = np.diff(table[:, :28], axis=0) / CONTROL_PERIOD
    change = np.diff(rate, axis=0) / CONTROL_PERIOD
    height, errors = parameters.pattern.pelvis_height, []
    for k in range(500, 890):
        acceleration = change[k - 1]
        _, wrench = robot.inverse_dynamics(
            table[k, :26], rate[k, :26], acceleration[:26], tuple(acceleration[26:])
        )
        fx, fy, fz, nx, ny, _ = wrench
        zmp = table[k, 26:28] + [-(ny + height * fx) / fz, (nx - height * fy) / fz]
        errors.append(zmp - table[k, 28:])
    assert np.sqrt((np.array(errors) ** 2).mean(axis=0)) == pytest.approx([0.0, 0.0], abs=0.005)
