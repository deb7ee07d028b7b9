"""Report of limited commands: limited if, and only if, the footsteps differ."""

from collections import Counter
from dataclasses import asdict, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walking.command import CommandState, HeadTarget, Limit, VelocityCommand
from walking.data import StepCommand
from walking.engine import WalkingEngine
from walking.model import Strides
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.plan.footsteps import (
    STILL,
    command_strides,
    foothold,
    is_close,
    landing_of,
    velocity_strides,
)
from walking.plan.gait import is_double, support_foot
from walking.plan.timing import cadence, duration

AHEAD = HeadTarget()
LIMITS = WalkingParameters().limits
HALF_STANCE = WalkingParameters().gait.half_stance


@pytest.fixture
def engine(robot):
    return WalkingEngine(robot, WalkingParameters())


def walk(engine, body, command, seconds):
    reports = []
    for _ in range(round(seconds / CONTROL_PERIOD)):
        body.apply(engine.step(body.sense(), command, AHEAD))
        reports.append(engine.state().command_limits)
    return reports


def test_before_settling_zero_is_applied(engine, ideal_body):
    report = walk(engine, ideal_body, VelocityCommand(0.2), 0.1)[-1]
    assert report.limits == (Limit.SETTLING,)
    assert report.applied == VelocityCommand()


@pytest.mark.parametrize(
    ("command", "limit"),
    [
        (VelocityCommand(1.0), Limit.SPEED),
        (VelocityCommand(0.5, 0.15, 1.5), Limit.COMBINED_SPEED),
        (CommandState(forward=0.3), Limit.STEP_LENGTH),
        (CommandState(side=0.4), Limit.STEP_SIDE),
        (CommandState(side=0.02), Limit.CLEARANCE),
        (CommandState(direction=1.5), Limit.STEP_TURN),
        (CommandState(single_support=0.05), Limit.TIMING),
        (CommandState(double_support=2.0), Limit.TIMING),
        (CommandState(swing_height=0.2), Limit.SWING_HEIGHT),
    ],
)
def test_the_binding_limit_is_reported(engine, ideal_body, command, limit):
    report = walk(engine, ideal_body, command, 3.0)[-1]
    assert report.commanded == command
    assert limit in report.limits
    assert report.applied != command


def test_the_applied_command_state_is_within_the_limits(engine, ideal_body):
    applied = walk(engine, ideal_body, CommandState(0.05, 2.0, 0.3, 0.1, 0.0, 0.2), 1.0)[-1].applied
    assert applied.forward == LIMITS.step_forward
    assert applied.single_support == pytest.approx(LIMITS.min_single)
    assert applied.double_support == pytest.approx(LIMITS.max_double)
    assert applied.swing_height == LIMITS.max_swing_height
    wide = walk(engine, ideal_body, CommandState(side=0.4), 1.0)[-1].applied
    assert wide.side == pytest.approx(2.0 * HALF_STANCE + LIMITS.step_side)


STAND = VelocityCommand()
HALF_TICK = 0.5 * CONTROL_PERIOD + 1e-9
ROUNDING = 1e-9
WIDE = 10.0  # a limit that never binds


def commands(rng, every):
    """Velocities, stops and footsteps, some beyond the limits; `every` bounds their time [s]."""
    while True:
        draw = rng.uniform()
        if draw < 0.15:
            command = STAND
        elif draw < 0.55:
            low, high = (-0.5, -0.15, -2.0), (0.6, 0.15, 2.0)
            fraction = 1.0 if draw < 0.35 else 0.4
            command = VelocityCommand(*(fraction * rng.uniform(low, high)).tolist())
        else:
            low = (0.16, 0.02, -0.1, 0.06, -0.4, 0.01)
            high = (0.45, 0.2, 0.16, 0.2, 0.4, 0.042)
            command = CommandState(*rng.uniform(low, high).tolist())
        for _ in range(round(rng.uniform(*every) / CONTROL_PERIOD)):
            yield command


def tilted(sensors, roll, pitch):
    attitude = Rotation.from_quat(sensors.orientation[[1, 2, 3, 0]])
    x, y, z, w = (attitude * Rotation.from_euler("yx", [pitch, roll])).as_quat()
    return replace(sensors, orientation=np.array([w, x, y, z]))


class Observer:
    """Compares the footsteps with the command, without the engine's account of it."""

    def __init__(self, engine, parameters, make_model):
        names = ("step_forward", "step_side", "step_turn", "reach_forward", "reach_side")
        limits = replace(parameters.limits, **dict.fromkeys(names, WIDE))
        gait = replace(parameters.gait, foot_clearance=-WIDE)
        self._plan, self._gait = engine._walk.plan, engine._walk.plan.gait
        self._usual = make_model(parameters=parameters).robot
        free = replace(parameters, limits=limits, gait=gait)
        self._free = make_model(parameters=free).robot
        self._phase, self._stepped = (0, True), False

    def obeys(self, command):
        """Whether the last tick obeyed; None if its support phase ended with it."""
        gait = self._gait
        stepped, self._stepped = self._stepped, bool(gait.stepping)
        phase, self._phase = self._phase, (int(gait.completed), is_double(gait))
        if self._phase != phase:
            return None
        if not gait.stepping:
            return command == STAND
        if command == STAND and not stepped:
            return False
        goes_on = bool(self._plan.moving) == (command != STAND)
        return goes_on and self._as_commanded(command) and self._under_way()

    def _as_commanded(self, command):
        """Whether the footsteps to come are those of the command."""
        timing, wanted = self._gait.clock.timing, np.zeros(1, Strides)[0]
        if isinstance(command, CommandState):
            step = np.zeros(1, StepCommand)[0]
            for name, value in asdict(command).items():
                step[name] = value
            command_strides(wanted, step, 0.0, self._free)
            timely = (
                abs(timing.double * CONTROL_PERIOD - command.double_support) < HALF_TICK
                and abs(timing.single * CONTROL_PERIOD - command.single_support) < HALF_TICK
                and abs(timing.swing_height - command.swing_height) < ROUNDING
            )
        else:
            time, velocity = duration(timing), command.velocity
            velocity_strides(wanted, velocity, time, self._free)
            usual = cadence(velocity, self._usual)
            # A stop may be faster than the usual cadence, not slower.
            faster = time < (usual[0] + usual[1]) * CONTROL_PERIOD
            timely = timing.item() == usual or (velocity == STILL and faster)
        made = self._plan.following
        same = all(
            np.allclose(made[foot].item(), wanted[foot].item(), rtol=0.0, atol=ROUNDING)
            for foot in ("left", "right")
        )
        return bool(timely) and same

    def _under_way(self):
        """Whether the footstep under way is one of them."""
        gait, timing = self._gait, self._gait.clock.timing
        nominal = landing_of(support_foot(gait), self._plan.following)
        return bool(
            (not is_double(gait) or gait.clock.shift.end == timing.double)
            and gait.clock.single.ticks == timing.single
            and (is_double(gait) or abs(gait.swing_height - timing.swing_height) < ROUNDING)
            and is_close(nominal, foothold(gait.landing), self._usual)
        )


@pytest.mark.parametrize(
    ("generator", "every"),
    [("preview", (0.005, 0.1)), ("preview", (0.2, 2.5)), ("mwpg", (0.2, 2.5))],
)
def test_limited_is_reported_if_and_only_if_the_footsteps_differ_from_the_command(
    robot, make_model, ideal_body, generator, every
):
    usual = WalkingParameters()
    parameters = replace(
        usual,
        pattern=replace(usual.pattern, generator=generator),
        stabilizer=replace(usual.stabilizer, heading_gain=0.0, speed_gain=0.0),
    )
    engine = WalkingEngine(robot, parameters)
    observer = Observer(engine, parameters, make_model)
    rng = np.random.default_rng(11)
    reported, wrong, obeyed = Counter(), [], 0
    script, tilt = commands(rng, every), (0.0, 0.0)
    for k in range(1600):
        command = next(script)
        if k % 100 == 0:
            shaken = rng.uniform() < 0.4
            tilt = rng.uniform(-0.25, 0.25, 2).tolist() if shaken else (0.0, 0.0)
        sensors = ideal_body.sense()
        if k % 100 < 15:
            sensors = tilted(sensors, *tilt)
        ideal_body.apply(engine.step(sensors, command, AHEAD))
        report, truth = engine.state().command_limits, observer.obeys(command)
        assert report.commanded == command
        reported.update(report.limits)
        if truth is None:
            continue
        obeyed += truth
        if report.limited is truth:
            wrong.append((k, command, report.limits))
    assert not wrong
    assert obeyed > 50
    assert {Limit.BALANCE, Limit.LANDING_FROZEN, Limit.TIMING, Limit.SWING_HEIGHT} <= set(reported)
