"""Getting up in full physics, and runs with a fall that no balance can prevent."""

from math import cos, pi, sin

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.robot_builder import build_body, build_model
from hsr8.world.field.generator import draw_layout
from hsr8.world.model.index import ModelIndex
from walking.get_up import GetUp, Outcome
from walking.get_up_motions import STRAIGHT
from walking.parameters import CONTROL_PERIOD, GetUpParameters
from walking.state import Phase

PUSH = 'fault=[{kind="push",start=0.8,magnitude=4.0,direction_deg=0}]'
DROP = 0.08  # height from which the robot is laid down [m]


def lay(body, pitch):
    """Put the robot down stretched out, its trunk pitched by `pitch` [rad]."""
    model, data = body.model, body.data
    index = ModelIndex.of(model, load_robot("hsr8"), 0, 0)
    root, joints = index.root_qpos, index.joint_qpos
    data.qpos[joints] = STRAIGHT.angles()
    data.qpos[root + 2] = DROP
    data.qpos[root + 3 : root + 7] = cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0
    mujoco.mj_forward(model, data)


@pytest.mark.parametrize(("pitch", "most"), [(0.5 * pi, 2), (-0.5 * pi, 4)])
def test_it_rises_from_front_and_back(pitch, most):
    scenario = load_scenario("walk", ['camera.source="analytic"'])
    layout = draw_layout(scenario, 0)
    body = build_body(scenario, 0, layout, build_model(scenario, layout))
    lay(body, pitch)
    robot = load_robot("hsr8").model
    get_up = GetUp(robot, GetUpParameters(max_attempts=most), np.array(STRAIGHT.angles()))
    while get_up.outcome is Outcome.UNDER_WAY and body.time < 30.0:
        body.apply(get_up.step(body.sense()))
    assert get_up.outcome is Outcome.UP
    for _ in range(round(0.5 / CONTROL_PERIOD)):
        body.apply(get_up.step(body.sense()))
    truth = body.truth()
    assert not truth.fallen
    assert truth.foot_force.sum() == pytest.approx(5.5 * 9.81, rel=0.1)


def run(simulate, *overrides):
    settings = ("command.vx=0.2", PUSH, *overrides)
    outcome, recorded, _ = simulate("walk", *settings, body="full", duration=4.0)
    return outcome, recorded, [kind for _, kind, _ in recorded.events if kind in ("push", "fall")]


def test_a_fall_ends_the_run_of_a_robot_that_does_not_get_up(simulate):
    outcome, _, events = run(simulate)
    assert outcome.exit_reason == "fall"
    assert outcome.time < 3.0
    assert events == ["push", "fall"]


def test_the_run_of_one_that_does_goes_on_and_it_looks_at_nothing_meanwhile(simulate):
    outcome, recorded, events = run(simulate, "walking.get_up.enabled=true")
    assert outcome.exit_reason == "completed"
    assert events == ["push", "fall"]
    assert recorded.records[-1].walking.phase is Phase.GETTING_UP
    down = [r.time for r in recorded.records if r.walking.phase.down]
    assert not any(down[0] + 0.2 < frame.time < down[-1] for frame in recorded.frames)
