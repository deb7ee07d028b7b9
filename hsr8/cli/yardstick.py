"""Speed of this machine: time of a physics step, and the speed of a run to expect from it."""

from time import perf_counter

import mujoco
import numpy as np

from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.robot_builder import build_model
from hsr8.world.body.physics import place_robot
from hsr8.world.field.generator import draw_layout

BLOCKS, STEPS = 10, 100
COURSE = 410.0  # `real_time_factor` of `hsr8 run course` times the time of a step [us]


def step_time() -> float:
    """Return the time of one MuJoCo step of the standing robot [us], least of several blocks."""
    scenario = load_scenario("quick")
    layout = draw_layout(scenario, scenario.seed)
    model = build_model(scenario, layout)
    data = mujoco.MjData(model)
    place_robot(model, data, load_robot(scenario.robot.model), np.array(layout.start))
    times = []
    for _ in range(BLOCKS):
        started = perf_counter()
        mujoco.mj_step(model, data, STEPS)
        times.append(perf_counter() - started)
    return 1e6 * min(times) / STEPS


def course_speed(step: float) -> float:
    """Return the expected speed of `course` with camera and log [1], over real time.

    Args:
        step: time of a physics step of the standing robot [us].
    """
    return COURSE / step
