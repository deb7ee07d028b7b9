"""Kernels: warm-up, and an uncompiled walk."""

from dataclasses import replace

import numpy as np
import pytest

from walking import published_state_kernel
from walking.body import (
    estimation_kernel,
    feedforward_kernel,
    head_kernel,
    kinematics,
)
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.footsteps import foothold_kernel, stride_kernel
from walking.gait import swing_foot_kernel, swing_kernel
from walking.parameters import WalkingParameters
from walking.pattern import pendulum_kernel, support_kernel, zmp_layout_kernel, zmp_solver_kernel
from walking.warm_up import warm_up

KERNELS = [
    (zmp_layout_kernel, "lay_out"),
    (zmp_solver_kernel, "solve"),
    (pendulum_kernel, "follow"),
    (foothold_kernel, "plan_walk"),
    (swing_kernel, "profile"),
    (swing_kernel, "react"),
    (swing_foot_kernel, "advance"),
    (support_kernel, "clip"),
    (support_kernel, "load_fraction"),
    (support_kernel, "depth"),
    (estimation_kernel, "estimate"),
    (kinematics, "pose"),
    (kinematics, "feet_poses"),
    (kinematics, "chain_end"),
    (feedforward_kernel, "rates"),
    (feedforward_kernel, "offsets"),
    (head_kernel, "advance"),
    (published_state_kernel, "show"),
    (published_state_kernel, "incline"),
    (stride_kernel, "strides"),
    (stride_kernel, "stance_after"),
    (stride_kernel, "clear"),
]


@pytest.mark.parametrize(
    ("module", "name"), KERNELS, ids=lambda part: getattr(part, "__name__", part).split(".")[-1]
)
def test_warm_up_calls_every_kernel_of_a_tick(robot, monkeypatch, module, name):
    kernel, calls = getattr(module, name), []
    monkeypatch.setattr(module, name, lambda *args: calls.append(None) or kernel(*args))
    warm_up(robot, WalkingParameters())
    assert calls


def walk(engine, body):
    """Setpoints of a walk with noise, pushes and all kinds of commands."""
    rng, rows = np.random.default_rng(7), []
    for k in range(500):
        if k % 40 == 0:
            command = VelocityCommand(*rng.uniform((-0.2, -0.1, -1.0), (0.4, 0.1, 1.0)).tolist())
            if k % 120 == 0:
                command = CommandState(forward=rng.uniform(-0.05, 0.1), direction=rng.uniform(0.3))
        sensors = body.sense()
        lean = rng.normal(0.0, 0.12 if k % 150 < 20 else 0.003, 2)
        sensors = replace(
            sensors,
            gyro=sensors.gyro + rng.normal(0.0, 0.05, 3),
            orientation=sensors.orientation + np.array([0.0, *lean, 0.0]),
        )
        targets = engine.step(sensors, command, HeadTarget(rng.uniform(-1.0, 1.0), -0.3))
        body.apply(targets)
        balance = engine.state().balance
        rows.append([*targets.setpoint, *balance.dcm, *balance.capture, balance.zmp_depth])
    return np.array(rows)


def test_an_uncompiled_walk_equals_a_compiled_one(robot, make_body, monkeypatch):
    compiled = walk(WalkingEngine(robot, WalkingParameters()), make_body())
    for module in {module for module, _ in KERNELS}:
        for name, kernel in list(vars(module).items()):
            if hasattr(kernel, "py_func"):
                monkeypatch.setattr(module, name, kernel.py_func)
    plain = walk(WalkingEngine(robot, WalkingParameters()), make_body())
    assert np.abs(compiled[:, 28:30]).max() > 0.01  # capture steps
    np.testing.assert_allclose(plain, compiled, rtol=1e-9, atol=1e-9)
