"""A walk that the scenario commands, through the whole loop."""

import numpy as np
import pytest

from hsr8 import api
from walking.command import CommandState, VelocityCommand


def measured(*overrides, body="full"):
    settings = ["camera.source=analytic", f"robot.body={body}", *overrides]
    return api.run("walk", seed=0, settings=settings).metrics


def test_the_velocity_asked_for_is_walked_and_measured():
    results = measured("command.vx=0.2", "command.wz=0.3", "duration=5.0")
    assert results["mean_velocity"]["vx"] == pytest.approx(0.2, abs=0.02)
    assert results["mean_velocity"]["wz"] == pytest.approx(0.3, abs=0.03)
    assert results["zmp_outside_sole_ticks"] == 0
    assert results["walk_ticks"] == 1001
    assert 0.0 < results["walk_tick_mean_ms"] <= results["walk_tick_p999_ms"]
    assert 0.0 < results["peak_torque_ratio"] < 1.0
    assert results["limited_by"]["settling"] == pytest.approx(100 / 1001, abs=0.002)


def test_wall_time_is_no_part_of_a_kinematic_result():
    results = measured("command.vx=0.2", "duration=1.0", body="kinematic")
    assert not [key for key in results if key.startswith(("walk_tick_", "torque", "peak"))]
    assert results["walk_ticks"] == 201


def test_commands_change_in_the_tick_they_are_scripted_for(simulate):
    stretches = "[{duration=0.515, vx=0.1}, {duration=0.5, footstep={forward=0.04}}]"
    _, recorded, _ = simulate(
        "walk", f"command.stretch={stretches}", "recorder.period_ms=5", duration=1.2
    )
    asked = [record.command for record in recorded.records]
    assert asked[:103] == [VelocityCommand(0.1)] * 103
    assert asked[103:203] == [CommandState(forward=0.04)] * 100
    assert asked[203:] == [VelocityCommand()] * (len(asked) - 203)


def test_a_push_moves_the_robot_is_told_and_leaves_the_rest_as_it_was(simulate):
    push = 'fault=[{kind="push",start=1.0,duration=0.05,magnitude=0.8,direction_deg=90}]'
    settings = ("command.vx=0.0", "recorder.period_ms=20")
    _, still, _ = simulate("walk", *settings, body="full", duration=1.6)
    _, pushed, _ = simulate("walk", *settings, push, body="full", duration=1.6)
    poses = [np.array([r.truth.qpos for r in run.records]) for run in (still, pushed)]
    assert np.array_equal(poses[0][:51], poses[1][:51])
    assert (poses[1] - poses[0])[51:, 1].max() > 0.003
    (event,) = [e for e in pushed.events if e[1] == "push"]
    assert event[0] == pytest.approx(1.0)
    assert "0.80 N s in 50 ms on torso_link" in event[2]
    acting = [r.time for r in pushed.records if r.truth.pushes]
    assert acting == pytest.approx([1.02, 1.04, 1.06])
    assert not any(e[1] == "push" for e in still.events)
