"""Report of limits against the footsteps: limited if, and only if, they differ."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.command_limits import Limit
from walking.engine import WalkingEngine
from walking.footsteps.planner import FootstepPlanner
from walking.parameters import CONTROL_PERIOD, WalkingParameters

AHEAD, STAND = HeadTarget(), VelocityCommand()
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

    def __init__(self, engine, parameters, sole):
        self._engine = engine
        limits = replace(
            parameters.limits,
            **dict.fromkeys(
                ("step_forward", "step_side", "step_turn", "reach_forward", "reach_side"), WIDE
            ),
        )
        self._usual = FootstepPlanner(parameters.gait, parameters.limits, sole)
        self._free = FootstepPlanner(replace(parameters.gait, foot_clearance=-WIDE), limits, sole)
        self._phase, self._stepped = (0, True), False

    def obeys(self, command):
        """Whether the last tick obeyed; None if its support phase ended with it."""
        gait = self._engine._gait
        stepped, self._stepped = self._stepped, gait.stepping
        phase, self._phase = self._phase, (gait.completed, gait.double)
        if self._phase != phase:
            return None
        if not gait.stepping:
            return command == STAND
        if command == STAND and not stepped:
            return False
        goes_on = self._engine._placement._transition.moving == (command != STAND)
        return goes_on and self._as_asked(gait, command) and self._under_way(gait)

    def _as_asked(self, gait, command):
        """Whether the footsteps to come are those of the command."""
        timing = gait.timing
        if isinstance(command, CommandState):
            wanted, _ = self._free.explicit(command, 0.0)
            timely = (
                abs(timing.double * CONTROL_PERIOD - command.double_support) < HALF_TICK
                and abs(timing.single * CONTROL_PERIOD - command.single_support) < HALF_TICK
                and abs(timing.swing_height - command.swing_height) < ROUNDING
            )
        else:
            wanted = self._free.strides(command.velocity, timing.duration)
            usual = self._usual.cadence(command.velocity)
            # A stop may be faster than the usual cadence, not slower.
            timely = timing == usual or (command == STAND and timing.duration < usual.duration)
        made = self._engine._placement._transition.strides
        same = np.allclose(
            (*made.left, *made.right), (*wanted.left, *wanted.right), rtol=0.0, atol=ROUNDING
        )
        return timely and bool(same)

    def _under_way(self, gait):
        """Whether the footstep under way is one of them."""
        nominal = gait.nominal(self._engine._placement._transition.strides)
        return (
            (not gait.double or gait.clock.shift.end == gait.timing.double)
            and gait.clock.single.ticks == gait.timing.single
            and (gait.double or abs(gait.swing_height - gait.timing.swing_height) < ROUNDING)
            and self._usual.same(nominal, gait.landing)
        )


@pytest.mark.parametrize("generator", ["dcm", "robust"])
@pytest.mark.parametrize("every", [(0.005, 0.1), (0.2, 2.5)])
def test_limited_is_reported_if_and_only_if_the_footsteps_differ_from_the_command(
    robot, ideal_body, generator, every
):
    usual = WalkingParameters()
    parameters = replace(
        usual,
        pattern=replace(usual.pattern, generator=generator),
        stabilizer=replace(usual.stabilizer, heading_gain=0.0, speed_gain=0.0),
    )
    engine = WalkingEngine(robot, parameters)
    observer = Observer(engine, parameters, robot.sole)
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
        report, truth = engine.command_limits, observer.obeys(command)
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
