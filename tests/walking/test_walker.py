"""Walking, falling and getting up."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from walking.command import CommandLimits, HeadTarget, Limit, VelocityCommand
from walking.engine import PlanDiverged, WalkingEngine
from walking.get_up import Outcome
from walking.parameters import GetUpParameters, WalkingParameters
from walking.state import Phase
from walking.walker import Walker

AHEAD, FORWARD = HeadTarget(), VelocityCommand(0.2, 0.0, 0.0)
RISING = WalkingParameters(get_up=GetUpParameters(enabled=True, max_attempts=1))


def tilted(sensors, pitch):
    return replace(sensors, orientation=np.array([cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0]))


def walk(walking, body, ticks):
    rows = []
    for _ in range(ticks):
        targets = walking.step(body.sense(), FORWARD, AHEAD)
        rows.append(np.concatenate([targets.position, targets.setpoint]))
        body.apply(targets)
    return np.array(rows)


def fall(walker, body, ticks=400):
    """The trunk tips onto its face and stays there."""
    for k in range(ticks):
        walker.step(tilted(body.sense(), min(0.5 * pi, 0.02 * k)), FORWARD, AHEAD)


def test_a_robot_on_its_feet_walks_as_the_engine_does(robot, ideal_body):
    twin = type(ideal_body)(robot)
    walked = walk(Walker(robot, RISING), ideal_body, 300)
    assert np.array_equal(walked, walk(WalkingEngine(robot, RISING), twin, 300))


def test_a_fallen_robot_gets_up_or_gives_up(robot, ideal_body):
    walker = Walker(robot, RISING)
    walk(walker, ideal_body, 10)
    assert not walker.state().phase.down
    fall(walker, ideal_body)
    assert walker.down
    assert walker.state().phase is Phase.GETTING_UP
    assert walker.state().fallen
    assert walker.limits == (Limit.FALLEN,)
    limits = CommandLimits(FORWARD, VelocityCommand(), walker.limits)
    assert walker.state().command_limits == limits
    assert not walker.state().applied_velocity.any()
    fall(walker, ideal_body, 1600)
    assert walker.state().phase is Phase.FALLEN


def test_once_up_it_goes_on_with_the_odometry_and_the_count_of_steps(robot, ideal_body):
    walker = Walker(robot, RISING)
    walk(walker, ideal_body, 500)
    before = walker.state()
    fall(walker, ideal_body, 100)
    walker.get_up.outcome = Outcome.UP
    standing = type(ideal_body)(robot)
    walker.step(standing.sense(), FORWARD, AHEAD)
    after = walker.state()
    assert walker.get_up is None
    assert after.phase is Phase.STANDING
    assert not after.fallen
    assert after.step_count >= before.step_count > 0
    moved = np.hypot(after.odometry.x - before.odometry.x, after.odometry.y - before.odometry.y)
    assert moved < 0.2  # by the legs of the tipping trunk
    hidden = after.odometry.covariance - before.odometry.covariance
    assert hidden[0, 0] == pytest.approx(RISING.get_up.displacement_sigma**2, rel=0.1)
    walk(walker, standing, 400)
    assert walker.state().step_count > after.step_count


def test_a_plan_that_diverges_starts_again_from_standing(robot, ideal_body):
    class Diverging(WalkingEngine):
        def step(self, *inputs):
            targets = super().step(*inputs)
            if self.state().step_count == 3 and not engines[1:]:
                raise PlanDiverged("far from the feet")
            return targets

    def make(odometry):
        engines.append(Diverging(robot, WalkingParameters(), odometry))
        return engines[-1]

    engines = []
    walker = Walker(robot, WalkingParameters(), make)
    walk(walker, ideal_body, 1000)
    after = walker.state()
    assert len(engines) == 2
    assert after.step_count == 3 + engines[1].state().step_count > 5
    assert after.odometry.covariance[0, 0] > RISING.get_up.displacement_sigma**2
