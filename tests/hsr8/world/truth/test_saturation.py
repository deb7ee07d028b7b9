from dataclasses import astuple

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.world.body.physics import place_robot
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, assemble
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.saturation import SaturationWatch
from walking.body.tree import JOINT_NAMES

EMPTY = Layout((4.0, 4.0), (), (), (0.0, 0.0, 0.0), np.zeros((0, 2)), None, endless=False)
KNEE = JOINT_NAMES.index("l_knee")


@pytest.fixture
def watched():
    model = assemble(load_robot("hsr8"), EMPTY, "vision", Optics())
    data = mujoco.MjData(model)
    place_robot(model, data, load_robot("hsr8"), np.zeros(3))
    mujoco.mj_forward(model, data)
    index = ModelIndex.of(model, load_robot("hsr8"), 0, 0)
    return model, data, index, SaturationWatch(model, index)


def test_the_ready_posture_saturates_nothing(watched):
    _, data, _, watch = watched
    data.actuator_force[:] = 0.0
    watch.watch(data)
    total = watch.so_far()
    assert (total.torque_any, total.stop_any) == (0, 0)
    assert total.peak_torque.max() == total.peak_speed.max() == 0.0


def test_full_torque_a_stop_and_the_fastest_turn_are_seen_and_kept(watched):
    model, data, index, watch = watched
    data.actuator_force[:] = 0.0
    data.actuator_force[index.actuators[KNEE]] = -model.actuator_forcerange[
        index.actuators[KNEE], 1
    ]
    data.qvel[index.joint_dof[KNEE]] = -7.0
    before = watch.so_far()
    watch.watch(data)
    data.actuator_force[:] = 0.0
    data.qpos[index.joint_qpos[KNEE]] = model.joint("l_knee").range[1] + 0.01
    watch.watch(data)
    total = watch.so_far()
    assert (total.torque_any, total.stop_any) == (1, 1)
    assert np.flatnonzero(total.torque_ticks).tolist() == [KNEE]
    assert np.flatnonzero(total.stop_ticks).tolist() == [KNEE]
    assert total.peak_torque[KNEE] == pytest.approx(1.0)
    assert total.peak_speed[KNEE] == 7.0
    assert before.torque_any == 0
    assert before.peak_speed[KNEE] == 0.0


def test_it_does_not_matter_when_one_asks(watched):
    model, data, index, often = watched
    seldom = SaturationWatch(model, index)
    rng = np.random.default_rng(0)
    for _ in range(150):
        data.actuator_force[:] = rng.normal(0.0, 3.0, model.nu)
        data.qpos[7:] = rng.normal(0.0, 1.0, model.nq - 7)
        data.qvel[:] = rng.normal(0.0, 1.0, model.nv)
        often.watch(data)
        seldom.watch(data)
        often.so_far()
    for one, other in zip(astuple(often.so_far()), astuple(seldom.so_far()), strict=True):
        assert np.array_equal(one, other)
        assert np.any(one)
