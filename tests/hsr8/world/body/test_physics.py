import numpy as np
import pytest

from hsr8.errors import SimulationDiverged
from hsr8.robots.loaded import load_robot
from hsr8.world.body.physics import PhysicsBody
from hsr8.world.field.layout import Obstacle
from hsr8.world.field.motion import Line, Shuttle
from walking.parameters import CONTROL_PERIOD
from walking.state import JointTargets


def body_in(world, noise, *obstacles, seed=0, **details):
    layout, model = world(*obstacles, **details)
    return PhysicsBody(model, load_robot("hsr8"), layout, noise, np.random.default_rng(seed))


def hold(body):
    """Targets that keep the posture the body starts in."""
    position = body.sense().joint_position
    return JointTargets(position, position)


def test_it_stands_and_the_feet_carry_its_weight(world, silent):
    body = body_in(world, silent)
    targets = hold(body)
    for _ in range(200):
        body.apply(targets)
    truth = body.truth()
    assert not truth.fallen
    assert np.isclose(truth.foot_force.sum(), 5.5 * 9.81, rtol=0.05)
    assert np.isclose(body.sense().foot_force.sum(), 5.5 * 9.81, rtol=0.05)
    assert np.hypot(*truth.robot[:2]) < 0.02
    assert abs(truth.zmp[1]) < 0.02


@pytest.mark.parametrize("ticks", [1, 37])
def test_movers_follow_their_motion_law(world, silent, ticks):
    motion = Shuttle((1.5, -1.0), (1.5, 1.0), 0.13)
    body = body_in(world, silent, Obstacle(motion.start, 0.08, 0.3, "red", motion))
    targets = hold(body)
    for _ in range(ticks):
        body.apply(targets)
    mover = body.data.mocap_pos[0, :2]
    assert np.allclose(mover, body.truth().obstacle_positions[0], atol=1e-12)
    assert np.isclose(mover[1], -1.0 + 0.13 * ticks * CONTROL_PERIOD, atol=1e-12)


def test_a_mover_is_solid_and_its_contact_is_reported(world, silent):
    motion = Line((0.30, 0.0), (-0.5, 0.0))
    body = body_in(world, silent, Obstacle(motion.start, 0.08, 0.3, "red", motion))
    targets = hold(body)
    contacts = []
    for _ in range(160):
        body.apply(targets)
        contacts += body.truth().contacts
    assert contacts
    assert all(c.obstacle == 0 and c.moving for c in contacts)
    assert body.truth().robot[0] < -0.02  # it was pushed back


def test_divergence_names_tick_and_body_and_command(world, silent):
    body = body_in(world, silent)
    targets = hold(body)
    for _ in range(3):
        body.apply(targets)
    body.data.qvel[8] = np.nan
    with pytest.raises(SimulationDiverged, match=r"tick 4 .*body '\w+'.*last command: \w+"):
        body.apply(targets)
