"""Landing of the swing foot, on a pendulum without a body."""

import pytest

from walking.balance.capture_step import CapturePendulum
from walking.balance.foot_placement import FootPlacement
from walking.balance.stabilizer import Stabilizer
from walking.command import VelocityCommand
from walking.command_limits import Limit
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.steering import Steering
from walking.footsteps.stride import STILL
from walking.gait.gait import Gait
from walking.parameters import CONTROL_PERIOD, PatternParameters, WalkingParameters
from walking.pattern.generator import make_generator
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import support_region

GENERATORS = ["dcm", "robust"]
NONE = (0.0, 0.0)


class Pendulum:
    """Steering, gait and pendulum with a DCM error chosen by the test."""

    def __init__(self, robot, generator):
        self.parameters = parameters = WalkingParameters(
            pattern=PatternParameters(generator=generator)
        )
        pattern = parameters.pattern
        self.sole, lipm = robot.sole, Lipm(pattern.lipm_height)
        self.generator = made = make_generator(lipm, pattern, robot.sole)
        self.planner = FootstepPlanner(parameters.gait, parameters.limits, robot.sole)
        h = parameters.gait.half_stance
        stance = Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0)
        self.gait = Gait(parameters, self.planner, stance, robot.sole)
        start = self.gait.plan(stance[1], self.planner.still, moving=False)[-1]
        state = PendulumState(start.bx, start.by, zmp_x=start.bx, zmp_y=start.by)
        self.steering = Steering(self.planner, parameters.limits, selective=made.selective)
        self.capture = CapturePendulum(lipm, made, self.gait, pattern.dcm_gain, state)
        stabilizer = Stabilizer(robot, parameters.stabilizer, lipm.omega)
        self.placement = FootPlacement(
            lipm, made, self.planner, self.gait, stabilizer=stabilizer, pendulum=self.capture
        )

    def tick(self, command, error=NONE):
        gait, steering, placement = self.gait, self.steering, self.placement
        placement.remember()
        steering.follow(command, 1.0, settled=True, balanced=True)
        gait.retime(steering.next_timing(gait.timing, stepping=gait.stepping))
        if not gait.stepping and steering.moving:
            gait.start(0)
        region = support_region(self.sole, *gait.support_feet, self.parameters.pattern.sole_margin)
        ramps = placement.decide(
            steering.strides(STILL), steering.velocity, error, region, moving=steering.moving
        )
        self.capture.advance(ramps, placement.landing, region)
        gait.advance(moving=placement.moving)
        self.capture.touchdown()

    def to_swing(self, command, phase=0.3):
        """Walk until a foot swings, some footsteps on."""
        for _ in range(500):
            self.tick(command)
            if self.gait.completed == 4 and self.gait.swing_phase > phase:
                return self
        raise AssertionError("no footsteps")


@pytest.mark.parametrize("generator", GENERATORS)
def test_a_steady_undisturbed_walk_follows_the_wanted_strides(robot, generator):
    walk, command = Pendulum(robot, generator), VelocityCommand(0.2, 0.03, 0.2)
    walk.to_swing(command)
    for _ in range(200):
        walk.tick(command)
        placement = walk.placement
        assert placement.bound == []
        assert placement.moved == NONE
        assert placement.applied == command.velocity
        assert placement.admitted is None


@pytest.mark.parametrize("generator", GENERATORS)
@pytest.mark.parametrize(
    ("error", "axis"), [((0.025, 0.0), 0), ((-0.025, 0.0), 0), ((0.0, 0.02), 1)]
)
def test_a_capture_step_follows_the_error_and_reports_balance(robot, generator, error, axis):
    walk, command = Pendulum(robot, generator), VelocityCommand(0.1)
    walk.to_swing(command)
    if walk.gait.swing == 1:
        error = error[0], -error[1]  # to the side of the swing foot
    walk.tick(command, error)
    placement = walk.placement
    assert placement.moved[axis] * error[axis] > 0.0
    assert abs(placement.moved[axis]) > abs(error[axis])
    assert Limit.BALANCE in placement.bound
    support, landing = walk.gait.footholds[walk.gait.support], walk.gait.landing
    assert walk.planner.same(walk.planner.reachable(support, landing, 0.0, 0.0), landing)


@pytest.mark.parametrize("generator", GENERATORS)
def test_errors_within_the_dead_zone_move_no_landing(robot, generator):
    walk, command = Pendulum(robot, generator), VelocityCommand(0.1)
    walk.to_swing(command)
    walk.tick(command, (0.005, 0.003))
    assert walk.placement.moved == NONE
    assert Limit.BALANCE not in walk.placement.bound


def test_an_infeasible_change_is_made_in_part_and_reported(robot, monkeypatch):
    walk = Pendulum(robot, "robust").to_swing(VelocityCommand(0.1))
    slow, before = walk.gait.landing.x, walk.placement.applied
    arguments = []

    def admits(*_):
        arguments.append(None)
        return len(arguments) == 2  # half of the change, no more

    monkeypatch.setattr(walk.generator, "admits", admits)
    fast = VelocityCommand(0.1 + 5 * walk.parameters.limits.forward_acceleration * CONTROL_PERIOD)
    for _ in range(5):
        walk.steering.follow(fast, 1.0, settled=True, balanced=True)
    walk.tick(fast)
    half = [0.5 * (a + b) for a, b in zip(before, walk.steering.velocity, strict=True)]
    assert walk.placement.applied == pytest.approx(half)
    assert Limit.ZMP_REGION in walk.placement.bound
    assert walk.placement.admitted is not None
    assert slow < walk.placement.landing.x < walk.gait.nominal(walk.steering.strides(STILL)).x


@pytest.mark.parametrize("generator", GENERATORS)
def test_a_late_change_is_reported_as_frozen_landing(robot, generator):
    walk, command = Pendulum(robot, generator), VelocityCommand(0.2)
    walk.to_swing(command, phase=0.9)
    landing = walk.gait.landing
    for _ in range(3):
        walk.tick(VelocityCommand(0.4))
    assert walk.gait.landing == landing
    assert Limit.LANDING_FROZEN in walk.placement.bound
