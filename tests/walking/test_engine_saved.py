"""An engine saved in the middle of a step goes on as if nothing had been."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import WalkingParameters

GENERATORS = ["dcm", "preview", "paper", "robust"]


def drive(engine, frames):
    rng, rows = np.random.default_rng(5), []
    for k, frame in enumerate(frames):
        command = VelocityCommand(*(rng.uniform(-1.0, 1.0, 3) * (0.3, 0.1, 0.8)).tolist())
        if k % 2:
            command = CommandState(forward=0.05 * rng.uniform(), direction=0.2 * rng.uniform())
        targets = engine.step(frame, command, HeadTarget(0.3, -0.2))
        rows.append(np.concatenate([targets.position, targets.setpoint]))
    return np.array(rows)


@pytest.mark.parametrize("save", [copy.deepcopy, lambda e: pickle.loads(pickle.dumps(e))])
@pytest.mark.parametrize("generator", GENERATORS)
def test_a_saved_engine_continues_bit_for_bit(robot, ideal_body, generator, save):
    pattern = replace(WalkingParameters().pattern, generator=generator)
    engine = WalkingEngine(robot, replace(WalkingParameters(), pattern=pattern))
    while not engine._gait.swing_phase < 1.0 or engine._gait.swing_phase < 0.4:
        frame = ideal_body.sense()
        ideal_body.apply(engine.step(frame, VelocityCommand(0.2, 0.05, 0.3), HeadTarget()))
    rng = np.random.default_rng(6)
    frames = [replace(frame, gyro=frame.gyro + 0.05 * rng.standard_normal(3)) for _ in range(80)]
    saved = save(engine)
    kept = save(saved)
    expected = drive(engine, frames)
    assert (drive(saved, frames) == expected).all()
    # What was saved shares nothing with what has walked on.
    assert (drive(kept, frames) == expected).all()
    one, other = saved.state(), kept.state()
    assert (one.zmp == other.zmp).all()
    assert one.footsteps == other.footsteps
    assert one.command_limits == other.command_limits
