"""User-defined walkers."""

import json
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import hsr8
from hsr8.cli.main import entry
from hsr8.errors import UsageError
from hsr8.plugins.file import digests
from hsr8.plugins.walker import PluginEngine, PluginWalker, RobotInfo
from hsr8.robots.loaded import load_robot
from hsr8.scenario.plugin import Plugin
from hsr8.simulation.robot_builder import build_walker
from navigation.decision import GazeDecision
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.constants import parameters_for
from walking.engine import WalkingEngine
from walking.estimate.odometry import LegOdometry
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.state import BodySensors

SOURCE = """
class Hold:
    def start(self, robot):
        self.robot = robot

    def step(self, sensors, command, head, estimate):
        setpoints = self.robot.ready.copy()
        setpoints[self.robot.head] = head
        return setpoints


class Trips(Hold):
    def step(self, sensors, command, head, estimate):
        raise ZeroDivisionError("lost a shoe")


class Short(Hold):
    def step(self, sensors, command, head, estimate):
        return [0.0]


class Empty:
    pass


class Unwilling(Hold):
    def start(self, robot):
        raise ValueError("not\\nthis robot")
"""


class Fixed:
    """Walker that returns the same each tick."""

    def __init__(self, setpoints):
        self.setpoints = setpoints

    def step(self, sensors, command, head, estimate):
        return self.setpoints


class InPlace:
    """Modifies its arguments, and remembers the calls."""

    def __init__(self):
        self.calls = []

    def start(self, robot):
        self.calls.append("start")
        self.ready = robot.ready.copy()
        robot.ready[:] = robot.lower[:] = robot.upper[:] = 9.0

    def reset(self):
        self.calls.append("reset")

    def step(self, sensors, command, head, estimate):
        self.calls.append(command)
        for values in (sensors.joint_position, sensors.gyro, head, estimate.pose):
            values[:] = 9.0
        return self.ready


class BuiltIn:
    """The walking engine of hsr8."""

    def reset(self):
        robot = load_robot("hsr8").model
        self.engine = WalkingEngine(robot, parameters_for(robot))

    def step(self, sensors, command, head, estimate):
        return self.engine.step(sensors, command, HeadTarget(*head)).setpoint


class Ahead:
    """Gaze straight ahead, so that no limit of the head acts."""

    def choose(self, belief, task, motion):
        return GazeDecision(0.0, 0.0)


@pytest.fixture(scope="module")
def robot():
    return load_robot("hsr8").model


def info_of(robot):
    return RobotInfo.of(robot, load_robot("hsr8").file)


def engine_of(robot, walker):
    parameters = WalkingParameters()
    plugin = PluginWalker(walker, info_of(robot))
    return PluginEngine(plugin, robot, parameters, LegOdometry(parameters.odometry))


def standing(robot):
    return BodySensors(
        joint_position=robot.ready.copy(),
        joint_velocity=np.zeros_like(robot.ready),
        gyro=np.zeros(3),
        accelerometer=np.array([0.0, 0.0, GRAVITY]),
        orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        foot_force=np.full((2, 4), robot.mass * GRAVITY / 8.0),
    )


def test_the_description_of_the_robot(robot):
    info = info_of(robot)
    assert len(info.joint_names) == len(info.ready) == len(info.lower) == len(info.upper)
    assert [info.joint_names[k] for k in info.head] == ["head_pan", "head_tilt"]
    assert (info.lower <= info.ready).all()
    assert (info.ready <= info.upper).all()
    assert info.period == CONTROL_PERIOD
    assert info.file.is_file()


@pytest.mark.parametrize("form", [list, tuple, np.float32, lambda q: q.astype(np.float16)])
def test_setpoints_of_any_sequence_type_are_accepted_and_clipped(robot, form):
    setpoints = robot.ready.copy()
    setpoints[0] = 100.0
    given = form(setpoints)
    targets = engine_of(robot, Fixed(given)).step(standing(robot), VelocityCommand(), HeadTarget())
    expected = np.clip(np.asarray(given, float), robot.lower, robot.upper)
    assert np.array_equal(targets.setpoint, expected)
    assert np.array_equal(targets.position, expected)


@pytest.mark.parametrize(
    ("setpoints", "expected"),
    [
        (None, "26 joint setpoints .* got NoneType"),
        (np.zeros(25), r"26 joint setpoints .* got ndarray of shape \(25,\)"),
        ("left leg first", "26 joint setpoints .* got str"),
        (np.full(26, np.nan), "finite joint setpoints"),
    ],
)
def test_invalid_setpoints_are_refused_with_the_expected_ones(robot, setpoints, expected):
    engine = engine_of(robot, Fixed(setpoints))
    with pytest.raises(UsageError, match=f"walker Fixed: step.* must return {expected}") as error:
        engine.step(standing(robot), VelocityCommand(), HeadTarget())
    assert "\n" not in str(error.value)


def test_a_walker_works_on_copies(robot):
    engine, sensors, ready = engine_of(robot, InPlace()), standing(robot), robot.ready.copy()
    for _ in range(3):
        engine.step(sensors, VelocityCommand(), HeadTarget())
    assert np.array_equal(robot.ready, ready)
    assert np.array_equal(sensors.joint_position, ready)
    assert not sensors.gyro.any()
    assert np.linalg.norm(engine.state().footsteps[0].x) < 0.2
    assert engine.state().odometry.x == pytest.approx(0.0, abs=1e-9)


def test_start_comes_first_and_reset_before_the_first_tick_of_every_engine(robot):
    walker, parameters = InPlace(), WalkingParameters()
    plugin, odometry = PluginWalker(walker, info_of(robot)), LegOdometry(parameters.odometry)
    command = VelocityCommand(0.1, 0.0, 0.2)
    for _ in range(2):
        engine = PluginEngine(plugin, robot, parameters, odometry)
        for _ in range(2):
            engine.step(standing(robot), command, HeadTarget())
    assert walker.calls == ["start", "reset", command, command, "reset", command, command]


def test_explicit_footsteps_arrive_as_their_velocity(robot):
    walker, command = InPlace(), CommandState(forward=0.05)
    engine = engine_of(robot, walker)
    engine.step(standing(robot), command, HeadTarget())
    assert walker.calls[-1] == VelocityCommand(*command.velocity)
    assert engine.state().command_limits.applied == walker.calls[-1]


def test_the_head_moves_to_its_target_within_its_limits(robot):
    class Looks(Fixed):
        def step(self, sensors, command, head, estimate):
            self.setpoints = [*getattr(self, "heads", []), head]
            self.heads = self.setpoints
            return robot.ready

    walker = Looks(None)
    engine = engine_of(robot, walker)
    for _ in range(200):
        engine.step(standing(robot), VelocityCommand(), HeadTarget(0.5, -0.3))
    heads = np.array(walker.heads)
    assert heads[-1] == pytest.approx([0.5, -0.3], abs=1e-3)
    rates = np.abs(np.diff(heads, axis=0)) / CONTROL_PERIOD
    assert rates.max() <= WalkingParameters().head.max_rate + 1e-9


def test_the_engine_of_hsr8_as_a_custom_walker_navigates_by_the_estimates_of_the_observer():
    settings = {"camera.source": "analytic", "duration": 4.0}
    usual = hsr8.run("quick", seed=4, settings=settings).metrics
    custom = hsr8.run("quick", seed=4, settings=settings, walker=BuiltIn()).metrics
    assert custom["falls"] == custom["collisions"] == 0
    assert custom["steps"] == pytest.approx(usual["steps"], rel=0.3)
    assert custom["path_length_m"] == pytest.approx(usual["path_length_m"], rel=0.3)
    assert custom["localization_rmse_m"] < 0.02
    assert custom["zmp_min_margin_m"] is None
    assert custom["limited_by"] == {}


def test_the_engine_of_hsr8_as_a_custom_walker_walks_the_same_bit_for_bit():
    """A walk with commands by time depends on no estimate of the observer."""
    scenario = hsr8.load_scenario("walk", {"camera.source": "analytic", "duration": 2.0})
    states, record = [], None
    for walker in (None, BuiltIn()):
        with hsr8.Simulation(scenario, 1, walker=walker, gaze=Ahead()) as simulation:
            for tick in simulation:
                record = tick.record or record
        states.append(record.truth.qpos)
    assert np.array_equal(*states)


def test_a_walker_that_falls_ends_the_run():
    result = hsr8.run("quick", settings={"camera.source": "analytic"}, walker=Fixed(np.zeros(26)))
    assert result.exit_reason == "fall"
    assert result.metrics["falls"] == 1


def test_a_robot_that_got_up_resets_its_walker(robot):
    settings = {"walking.get_up.enabled": True}
    scenario = hsr8.load_scenario("quick", settings)
    walker = InPlace()
    walking = build_walker(scenario, walker)
    sensors = standing(robot)
    walking.step(sensors, VelocityCommand(), HeadTarget())
    walking.get_up = SimpleNamespace(step=lambda _: None, outcome=None)
    walking._stand()
    walking.step(sensors, VelocityCommand(), HeadTarget())
    assert walker.calls.count("reset") == 2
    assert walker.calls.count("start") == 1


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Working directory with a file of walkers."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    tmp_path.joinpath("mine.py").write_text(SOURCE)
    return tmp_path


QUICK = ("--body", "kinematic", "--camera", "analytic", "--quiet")


def test_a_run_records_the_digest_and_can_be_verified_and_drawn(folder, capsys):
    walker = ("--set", "plugin.walker=mine.py:Hold", "duration=2.0")
    assert entry(["run", "quick", *QUICK, *walker, "--out", "runs"]) == 1
    (manifest,) = folder.glob("runs/quick/*/manifest.json")
    libraries = json.loads(manifest.read_text())["libraries"]
    assert digests(Plugin(walker="mine.py:Hold")).items() <= libraries.items()
    assert entry(["verify", "runs"]) == 0
    assert entry(["plot", "runs", "--out", "walk.png"]) == 0
    assert entry(["info", "runs"]) == 0
    metrics = json.loads((manifest.parent / "metrics.json").read_text())
    assert (metrics["steps"], metrics["path_length_m"]) == (0, pytest.approx(0.0, abs=1e-3))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Trips", "ZeroDivisionError: lost a shoe"),
        ("Short", "walker Short: step(sensors, command, head, estimate) must return 26"),
        ("Empty", "walker Empty has no method step(sensors, command, head, estimate)"),
    ],
)
def test_an_error_of_a_walker_is_one_message(folder, capsys, name, message):
    walker = ("--set", f"plugin.walker=mine.py:{name}")
    assert entry(["run", "quick", *QUICK, *walker, "--out", "runs"]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "internal" not in error
    if name in ("Trips", "Unwilling"):
        assert f"{folder / 'mine.py'}, line" in error
