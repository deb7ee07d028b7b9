from dataclasses import replace
from types import SimpleNamespace

import cv2
import mujoco
import numpy as np
import pytest

from hsr8.errors import RenderingUnavailable, ScenarioError
from hsr8.plugins.decisions import GazePlugin, PlannerPlugin
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.simulation.record import EventWatch
from hsr8.simulation.robot_builder import MARGINS, walking_parameters
from hsr8.world.model import assembly
from hsr8.world.truth.truth import Contact, Truth
from navigation.decision import GazeDecision, MotionDecision
from walking.dimension import HSR_VIII, scale_parameters

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def quick(duration=1.0):
    return load_scenario("quick", [*STAND_INS, f"duration={duration}"])


class Spin:
    """Motion planner that turns in place."""

    def plan(self, belief, task):
        return MotionDecision(velocity=np.array([0.0, 0.0, 0.8]))


class Stare:
    """Gaze planner that looks to the left."""

    def choose(self, belief, task, motion):
        return GazeDecision(pan=0.7, tilt=-0.2)


def test_tick_by_tick_is_the_same_run():
    at_once = Simulation(quick(), 4).run()
    with Simulation(quick(), 4) as simulation:
        ticks = list(simulation)
    assert simulation.outcome() == at_once
    assert [tick.number for tick in ticks] == list(range(201))
    records = [tick.record for tick in ticks if tick.record is not None]
    assert [record.tick for record in records] == list(range(0, 201, 4))
    assert [second.tick for tick in ticks for second in tick.seconds] == [0, 200, 201]
    assert all(np.isfinite(tick.setpoint).all() for tick in ticks)


def test_a_run_left_early_has_an_exit_reason(monkeypatch):
    with Simulation(quick(), 4) as simulation:
        simulation.step()
    assert simulation.exit_reason == "interrupted"
    simulation = Simulation(quick(), 4)
    with pytest.raises(ZeroDivisionError), simulation:
        raise ZeroDivisionError
    assert simulation.exit_reason == "error"

    def none(*_):
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.simulation.loop.HeadCamera.open", none)
    simulation = Simulation(load_scenario("quick"), 4)
    with pytest.raises(RenderingUnavailable):
        simulation.run()
    assert simulation.exit_reason == "error"


def test_the_threads_of_opencv_are_as_before():
    before = cv2.getNumThreads()
    cv2.setNumThreads(3)
    Simulation(quick(0.05), 4).run()
    assert cv2.getNumThreads() == 3
    cv2.setNumThreads(before)


@pytest.fixture
def handler():
    """Handler of MuJoCo's warnings that somebody else has set."""
    before = mujoco.get_mju_user_warning()

    def handle(message):
        """Take a warning."""

    mujoco.set_mju_user_warning(handle)
    yield handle
    mujoco.set_mju_user_warning(before)


def test_a_new_world_leaves_the_handler_of_warnings(handler, monkeypatch):
    Simulation(quick(), 0)
    assert mujoco.get_mju_user_warning() is handler

    for shapes in ("camera_spec", "visual_spec"):
        monkeypatch.setattr(assembly, shapes, lambda _robot: "not a model")
    with pytest.raises(TypeError):
        Simulation(quick(), 0)
    assert mujoco.get_mju_user_warning() is handler


def test_steps_outside_a_run_are_an_error():
    simulation = Simulation(quick(0.05), 4)
    with pytest.raises(RuntimeError, match="with simulation"):
        simulation.step()
    with pytest.raises(RuntimeError, match="has not ended"):
        simulation.outcome()
    simulation.run()
    with pytest.raises(RuntimeError, match="has ended"):
        simulation.step()


def test_a_given_planner_and_gaze_replace_those_of_the_scenario():
    spin: PlannerPlugin = Spin()
    stare: GazePlugin = Stare()
    record = None
    with Simulation(quick(4.0), 4, planner=spin, gaze=stare) as simulation:
        for tick in simulation:
            record = tick.record or record
    assert record.head.pan == 0.7
    assert record.command.velocity == (0.0, 0.0, 0.8)
    assert np.hypot(*(record.truth.robot[:2] - simulation.layout.start[:2])) < 0.15
    assert abs(record.truth.robot[2] - simulation.layout.start[2]) > 1.0


def truth_with(time, *obstacles):
    contacts = tuple(
        Contact(o, f"beacon {o}", False, "l_sole", 1.0, closing=False) for o in obstacles
    )
    empty = np.zeros(0)
    return Truth(
        time=time,
        qpos=empty,
        robot=empty,
        obstacle_positions=empty,
        obstacle_velocities=empty,
        mover_clocks=empty,
        contacts=contacts,
        clearance=1.0,
        joint_torque=empty,
        foot_force=empty,
        zmp=empty,
        fallen=False,
    )


def test_a_contact_is_told_with_the_name_of_what_is_touched():
    (event,) = EventWatch(()).look(truth_with(0.0, 3), None)
    assert event.text == "l_sole touches beacon 3"


def test_a_contact_that_goes_on_is_one_event_and_a_later_one_another():
    watch = EventWatch(())

    def events(time, obstacle):
        return [event.kind for event in watch.look(truth_with(time, obstacle), None)]

    assert events(0.0, 3) == ["collision"]
    for time in np.arange(0.02, 1.0, 0.02):
        assert events(time, 3) == []
    assert events(1.2, 3) == []
    assert events(1.9, 3) == events(1.9, 4) == ["collision"]


@pytest.mark.parametrize("key", [".".join(margin) for margin in MARGINS])
def test_a_margin_is_below_half_the_width_of_the_sole_of_the_robot_that_walks(key, monkeypatch):
    robot = load_robot("hsr8")
    half = robot.model.sole.half_width
    scenario = load_scenario("walk", [f"walking.{key}={half}"])
    with pytest.raises(ScenarioError, match=f"walking.{key}: .* less than half the width"):
        walking_parameters(robot, scenario)
    monkeypatch.setattr(robot.model, "sole", replace(robot.model.sole, half_width=1.1 * half))
    walking_parameters(robot, scenario)


def test_a_value_that_equals_the_default_of_another_robot_is_kept():
    robot, scenario = load_robot("hsr8"), load_scenario("walk", ["walking.gait.footstep_time=0.34"])
    giant = replace(HSR_VIII, leg=2.0 * HSR_VIII.leg, time=1.4 * HSR_VIII.time)
    scaled = scale_parameters(robot.parameters, HSR_VIII, giant)
    loaded = SimpleNamespace(model=robot.model, parameters=scaled)
    assert scaled.gait.footstep_time > 0.4
    assert walking_parameters(loaded, scenario).gait.footstep_time == 0.34
