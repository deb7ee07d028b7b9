"""Kernels: the warm-up compiles all of them, and compiled they equal plain Python."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest

from walking import published_state_kernel
from walking.body import estimation_kernel, head_kernel, leg_kernel
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.footsteps import foothold_kernel, stride_kernel
from walking.gait import swing_foot_kernel, swing_kernel
from walking.parameters import WalkingParameters
from walking.pattern import (
    pendulum_kernel,
    support_kernel,
    zmp_layout_kernel,
    zmp_solver_kernel,
)
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
    (leg_kernel, "pose"),
    (leg_kernel, "rates"),
    (leg_kernel, "offsets"),
    (head_kernel, "advance"),
    (head_kernel, "camera_pose"),
    (published_state_kernel, "show"),
    (published_state_kernel, "incline"),
    (stride_kernel, "strides"),
    (stride_kernel, "stance_after"),
    (stride_kernel, "clear"),
]
PUSHED = [(zmp_layout_kernel, "dcm")]  # called in a disturbed walk only
SAMPLES, EVERY = 20, 17  # arguments kept of a kernel, one in so many calls


def ids(pair):
    return f"{pair[0].__name__.split('.')[-1]}.{pair[1]}"


@pytest.mark.parametrize("kernel", KERNELS, ids=ids)
def test_the_warm_up_calls_every_kernel_of_a_tick(robot, monkeypatch, kernel):
    module, name = kernel
    recorder = Recorder(getattr(module, name))
    monkeypatch.setattr(module, name, recorder)
    warm_up(robot, WalkingParameters())
    assert recorder.kept


class Recorder:
    """A kernel that keeps some of its arguments."""

    def __init__(self, kernel):
        self._kernel, self._calls, self.kept = kernel, 0, []

    def __call__(self, *arguments):
        if self._calls % EVERY == 0 and len(self.kept) < SAMPLES:
            self.kept.append(deepcopy(arguments))
        self._calls += 1
        return self._kernel(*arguments)


@pytest.fixture(scope="module")
def recorders(robot, make_body):
    """Kernels after a walk with noise, pushes and all kinds of commands."""
    recorders = {(m, name): Recorder(getattr(m, name)) for m, name in [*KERNELS, *PUSHED]}
    with pytest.MonkeyPatch.context() as patch:
        for (module, name), recorder in recorders.items():
            patch.setattr(module, name, recorder)
        walk(WalkingEngine(robot, WalkingParameters()), make_body())
    return recorders


def walk(engine, body):
    rng = np.random.default_rng(7)
    for k in range(1200):
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
        body.apply(engine.step(sensors, command, HeadTarget(rng.uniform(-1.0, 1.0), -0.3)))
        engine.state()


def flat(values):
    """All numbers of a result and of the arrays that a kernel has changed."""
    if isinstance(values, np.ndarray):
        return values.ravel().tolist()
    return [v for part in values for v in flat(part)] if isinstance(values, tuple) else [values]


@pytest.mark.parametrize("kernel", [*KERNELS, *PUSHED], ids=ids)
def test_compiled_equals_plain(recorders, plainly, kernel):
    module, name = kernel
    assert recorders[kernel].kept
    for arguments in recorders[kernel].kept:
        one, other = deepcopy(arguments), deepcopy(arguments)
        compiled, plain = getattr(module, name)(*one), plainly(module, name, *other)
        results = [flat(() if result is None else result) for result in (compiled, plain)]
        np.testing.assert_allclose(*results, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(flat(one), flat(other), rtol=1e-9, atol=1e-11)
