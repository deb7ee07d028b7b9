import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.scenario.loader import load_scenario
from hsr8.scenario.mission import Command, RandomCommands
from hsr8.simulation.command_schedule import (
    CommandSchedule,
    ScheduledMission,
    ScheduledPlanner,
    command_schedule,
)
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene
from walking.command import CommandState, VelocityCommand


@pytest.fixture
def scene_at(fake):
    """Builds the scene of a time."""

    def scene_at(time):
        belief = fake.frame(time, (0.3, -0.2, 0.5)).belief
        task = ScheduledMission().update(belief.pose)
        return Scene.of(belief, task, NavigationParameters(), body=np.zeros(3))

    return scene_at


def schedule_of(*overrides, duration=10.0, seed=0):
    command = load_scenario("walk", list(overrides)).command
    return command_schedule(command, duration, np.random.default_rng(seed))


STRETCHES = "command.stretch=[{duration = 2.0, vx = 0.1}, {duration = 1.0, vy = 0.05, wz = -0.4}]"


@pytest.mark.parametrize(
    ("time", "expected"),
    [
        (0.0, (0.1, 0.0, 0.0)),
        (1.99, (0.1, 0.0, 0.0)),
        (2.0, (0.0, 0.05, -0.4)),
        (2.99, (0.0, 0.05, -0.4)),
        (3.0, (0.0, 0.0, 0.0)),
    ],
)
def test_stretches_follow_each_other_and_then_the_robot_stands(time, expected, scene_at):
    schedule = schedule_of(STRETCHES)
    assert schedule.at(time) == VelocityCommand(*expected)
    planner = ScheduledPlanner(schedule)
    decision, memory = planner.plan(planner.begin(), scene_at(time))
    assert decision.velocity.tolist() == list(expected)
    assert memory is None


def test_a_change_is_in_its_tick_despite_rounding():
    schedule = CommandSchedule([(0.005, VelocityCommand(0.001 * k)) for k in range(1000)])
    for k in range(1000):
        assert schedule.at(k * 0.005) == VelocityCommand(0.001 * k)


@pytest.mark.parametrize("time", [0.0, 5.0, 1e4])
def test_one_velocity_takes_the_place_of_the_script(time):
    schedule = schedule_of("command.vx=0.3", "command.wz=0")
    assert schedule.at(time) == VelocityCommand(0.3, 0.0, 0.0)


def test_footsteps_are_explicit():
    state = CommandState(0.4, 0.1, 0.03, 0.09, 0.2, 0.03)
    table = (
        "{single_support=0.4, double_support=0.1, forward=0.03, side=0.09, direction=0.2, "
        "swing_height=0.03}"
    )
    assert schedule_of(f"command.footstep={table}").at(3.0) == state
    schedule = schedule_of(f"command.stretch=[{{duration=1, footstep={table}}}, {{duration=1}}]")
    assert [schedule.at(t) for t in (0.5, 1.5)] == [state, VelocityCommand()]
    assert state.velocity == pytest.approx((0.06, 0.0, 0.4))


@given(st.integers(0, 2**32 - 1))
def test_random_commands_stay_in_range_and_follow_the_seed(seed):
    section = Command(random=RandomCommands(vx=(-0.1, 0.3), wz=(-0.5, 0.0), stop_fraction=0.3))
    one, same = (command_schedule(section, 20.0, np.random.default_rng(seed)) for _ in range(2))
    velocities = np.array([one.at(t).velocity for t in np.arange(0.0, 20.0, 0.05)])
    again = np.array([same.at(t).velocity for t in np.arange(0.0, 20.0, 0.05)])
    assert np.array_equal(again, velocities)
    assert (velocities >= (-0.1, -0.15, -0.5)).all()
    assert (velocities <= (0.3, 0.15, 0.0)).all()
    changes = np.flatnonzero(np.any(np.diff(velocities, axis=0) != 0.0, axis=1))
    assert np.diff(changes).min(initial=100) >= 0.5 / 0.05 - 1


def test_the_fraction_of_stops_is_that_of_the_scenario():
    section = Command(random=RandomCommands(stop_fraction=0.25, interval=(0.5, 0.5)))
    schedule = command_schedule(section, 5000.0, np.random.default_rng(1))
    stops = np.mean([schedule.at(0.5 * k + 0.1) == VelocityCommand() for k in range(10000)])
    assert stops == pytest.approx(0.25, abs=0.02)


def test_the_mission_has_a_target_straight_ahead():
    task = ScheduledMission().update(np.array([1.0, 2.0, np.pi / 2]))
    assert np.allclose(task.target, (1.0, 3.0))
    assert not task.done
