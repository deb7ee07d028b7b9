"""Joint targets that make the body follow pendulum and feet."""

import numpy as np
import pytest

from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.gait.gait import Gait
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.servos.feedforward import FeedForward
from walking.servos.whole_body import WholeBody

PARAMETERS = WalkingParameters()
LIPM = Lipm(PARAMETERS.pattern.lipm_height)
LEVEL, NONE, STILL = (0.0, 0.0), (0.0, 0.0), np.zeros(3)


@pytest.fixture
def body(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    h = PARAMETERS.gait.half_stance

    def make(x=0.01, y=0.0):
        stance = (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0))
        gait = Gait(PARAMETERS, planner, stance, robot.sole)
        return WholeBody(
            robot, PARAMETERS, lipm=LIPM, gait=gait, pendulum=PendulumState(x, y)
        ), gait

    return make


def follow(whole, zmp=(0.01, 0.0), shift=NONE, load=0.5, **changes):
    usual = {"tilt": LEVEL, "gyro": STILL, "head": NONE, "offset": NONE} | changes
    usual |= {"measured": np.zeros(26)}  # soft legs alone need it
    tilt, gyro = usual.pop("tilt"), usual.pop("gyro")
    return whole.follow(tilt, gyro, zmp, shift, load, **usual)


def test_the_mass_centre_of_a_standing_body_is_about_on_the_pendulum(robot, body):
    whole, _ = body()
    targets = follow(whole)
    x, y, _ = robot.com(targets.position)
    assert whole.com == pytest.approx((x, y), abs=1e-12)
    # The pelvis is at the nominal mass centre; the posture's own is a little elsewhere.
    assert (whole.pelvis[0] + x, whole.pelvis[1] + y) == pytest.approx((0.01, 0.0), abs=5e-3)
    assert whole.turn_rate == 0.0


@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_an_offset_is_forward_and_left_of_the_heading(body, yaw):
    moved = []
    for offset in (NONE, (0.004, -0.003)):
        whole, gait = body()
        gait.feet[:, 2] = yaw
        follow(whole)
        follow(whole, offset=offset)
        moved.append(np.array(whole.pelvis))
    c, s = np.cos(yaw), np.sin(yaw)
    assert moved[1] - moved[0] == pytest.approx([c * 0.004 + s * 0.003, s * 0.004 - c * 0.003, 0.0])


def test_the_trunk_turns_as_fast_as_the_feet_between_two_ticks(body):
    whole, gait = body()
    follow(whole)
    gait.feet[0, 2] += 0.002
    follow(whole)
    assert whole.turn_rate == pytest.approx(0.001 / CONTROL_PERIOD)
    follow(whole)
    assert whole.turn_rate == 0.0


def test_feedforward_includes_the_acceleration_of_the_pendulum(robot, body):
    whole, gait = body()
    targets = follow(whole, zmp=(-0.01, 0.005))
    height = PARAMETERS.pattern.pelvis_height - robot.legs[0].hip[2]
    w2 = GRAVITY / PARAMETERS.pattern.lipm_height
    parts = (LEFT_LEG, RIGHT_LEG)
    both = [leg.joints(targets.position[p]) for leg, p in zip(robot.legs, parts, strict=True)]
    expected = FeedForward(robot, PARAMETERS.stabilizer, height).offsets(
        targets.position,
        whole.pelvis,
        gait.foot_zmps,
        0.5,
        (w2 * 0.02, -w2 * 0.005),
        legs=tuple(np.array(part) for part in zip(*both, strict=True)),
        task=(NONE, STILL),
    )
    assert targets.setpoint - targets.position == pytest.approx(expected, abs=1e-12)
