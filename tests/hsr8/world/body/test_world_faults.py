import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.robots.tree import max_torque
from hsr8.scenario.crowd import AWAY
from hsr8.scenario.fault import Bump, LowFriction, MoverAppears, ServoWeak
from hsr8.world.body.physics import place_robot
from hsr8.world.body.world_faults import WorldFaults
from hsr8.world.field.layout import Layout, Obstacle, with_faults
from hsr8.world.field.motion import Shuttle
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex

MOVERS = (
    Obstacle((1.0, 0.0), 0.08, 0.3, "blue", Shuttle((1.0, 0.0), (1.0, 1.0), 0.1)),
    Obstacle((-1.0, 0.0), 0.08, 0.3, "red", Shuttle((-1.0, 0.0), (-1.0, 1.0), 0.1)),
)
PLAIN = Layout((4.0, 4.0), MOVERS, (), (0.0, 0.0, 0.0), np.empty((0, 2)), None, False)


def world(*faults):
    """Model, data with the robot ready, and the faults in it."""
    model = assemble(load_robot("hsr8"), with_faults(PLAIN, faults), "vision", Optics(32, 24))
    data = mujoco.MjData(model)
    place_robot(model, data, load_robot("hsr8"), np.zeros(3))
    index = ModelIndex.of(model, load_robot("hsr8"), 0, 2)
    mujoco.mj_forward(model, data)
    return model, data, index, WorldFaults(model, index, faults)


def test_weak_servos_have_a_share_of_their_torque_left_and_get_it_back():
    weak = ServoWeak(kind="servo-weak", magnitude=0.25, joint="left_leg", start=0.01, duration=0.01)
    model, data, index, faults = world(weak)
    usual = model.actuator_forcerange.copy()
    for tick in range(6):
        faults.apply_fault(model, data, tick)
        faults.apply_fault(model, data, tick)  # it is the same however often it is asked
        ratio = model.actuator_forcerange[index.actuators] / usual[index.actuators]
        left = 0.25 if 2 <= tick < 4 else 1.0
        assert np.allclose(ratio[:6], left)
        assert np.allclose(ratio[6:], 1.0)


def test_a_patch_is_slippery_for_the_sole_on_it():
    (_, y), radius = (0.0, 0.045), 0.03
    model, data, index, faults = world(
        LowFriction(kind="low-friction", magnitude=0.1, position=(0.01, y), radius=radius)
    )
    faults.apply_fault(model, data, 0)
    assert model.geom_friction[list(index.foot_geoms), 0].tolist() == [0.1, 0.8]
    data.qpos[index.root_qpos] += 1.0
    faults.apply_fault(model, data, 1)
    assert model.geom_friction[list(index.foot_geoms), 0].tolist() == [0.8, 0.8]


def test_the_friction_of_a_slippery_floor_is_that_of_its_contacts():
    model, data, index, faults = world(LowFriction(kind="low-friction", magnitude=0.1, start=0.05))
    for tick, friction in ((0, 0.8), (10, 0.1)):
        faults.apply_fault(model, data, tick)
        mujoco.mj_step(model, data)
        feet = [
            c.friction[0] for c in data.contact[: data.ncon] if set(c.geom) & {*index.foot_geoms}
        ]
        assert len(feet) >= 4
        assert feet == pytest.approx([friction] * len(feet))


def test_a_bump_is_touched_while_it_acts_only():
    bump = Bump(
        kind="bump", magnitude=0.01, position=(0.0, 0.045), radius=0.1, start=0.05, duration=0.05
    )
    model, data, index, faults = world(bump)
    touched = []
    for tick in (0, 10, 20):
        faults.apply_fault(model, data, tick)
        mujoco.mj_forward(model, data)
        touched.append(bool(np.isin(data.contact.geom, index.bumps).any()))
    assert touched == [False, True, False]


def test_a_mover_appears_where_its_law_has_it_and_goes_again():
    layout = with_faults(
        PLAIN, [MoverAppears(kind="mover-appears", mover=1, start=2.0, duration=3.0)]
    )
    before, after = PLAIN.motion(), layout.motion()
    for time in (0.0, 1.9975, 2.0, 4.9975, 5.0, 9.0):
        there = 2.0 <= time < 5.0
        usual, faulty = before.positions(time), after.positions(time)
        assert np.array_equal(faulty[0], usual[0])
        assert np.allclose(faulty[1] - usual[1], (0.0 if there else AWAY, 0.0))
        assert np.array_equal(after.velocities(time)[1], before.velocities(time)[1] * there)
    assert layout.obstacles[1].position == (-1.0 + AWAY, 0.0)
    assert np.array_equal(after.top_speeds(), before.top_speeds())


def test_a_weak_servo_loses_torque_where_the_joint_states_the_limit():
    weak = ServoWeak(kind="servo-weak", joint="legs", magnitude=0.3)
    model, data, index, _ = world(weak)
    joints = model.dof_jntid[index.joint_dof]
    model.jnt_actfrclimited[joints] = 1
    model.jnt_actfrcrange[joints] = (-0.1, 0.1)
    before = max_torque(model, joints, index.actuators)
    WorldFaults(model, index, [weak]).apply_fault(model, data, 0)
    ratio = max_torque(model, joints, index.actuators) / before
    np.testing.assert_allclose(ratio, np.where(np.arange(len(joints)) < 12, 0.3, 1.0))
