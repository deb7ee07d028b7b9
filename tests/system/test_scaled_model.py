"""Robots of other sizes."""

from math import sqrt

import mujoco
import numpy as np
import pytest

from hsr8.robots.file.files import models_dir
from tests.system.scaled_model import scale_robot, scaled_robot
from walking.dimension import HSR_VIII

ROBOT = models_dir() / "hsr8" / "hsr8.xml"
LENGTHS = ("body_pos", "body_ipos", "geom_pos", "site_pos", "site_size", "cam_pos")


def spec_of(*sizes: float) -> mujoco.MjSpec:
    spec = mujoco.MjSpec.from_file(str(ROBOT))
    for size in sizes:
        scale_robot(spec, size)
    return spec


def arrays(model: mujoco.MjModel) -> dict[str, np.ndarray]:
    kinds = ("body_", "jnt_", "dof_", "geom_", "site_", "cam_", "actuator_", "key_")
    found = {name: getattr(model, name) for name in dir(model) if name.startswith(kinds)}
    return {
        name: value
        for name, value in found.items()
        if isinstance(value, np.ndarray) and value.dtype.kind == "f"
    }


@pytest.mark.parametrize("size", [0.8, 1.3])
def test_scaling_can_be_undone(size):
    same, before = arrays(spec_of(size, 1.0 / size).compile()), arrays(spec_of().compile())
    assert len(before) > 50
    for name, value in before.items():
        np.testing.assert_allclose(same[name], value, rtol=1e-9, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("size", [0.8, 1.3])
def test_lengths_masses_and_inertias_go_with_their_powers(size):
    small, model = spec_of().compile(), spec_of(size).compile()
    for name in LENGTHS:
        np.testing.assert_allclose(getattr(model, name), size * getattr(small, name), atol=1e-12)
    np.testing.assert_allclose(model.body_mass, size**3 * small.body_mass, rtol=1e-12)
    np.testing.assert_allclose(model.body_inertia, size**5 * small.body_inertia, rtol=1e-9)
    np.testing.assert_allclose(model.jnt_range, small.jnt_range)


def crouch(model: mujoco.MjModel, size: float) -> np.ndarray:
    """Joint angles and heights of a robot that bends its knees and falls on its face."""
    data = mujoco.MjData(model)
    model.opt.timestep *= sqrt(size)
    mujoco.mj_resetDataKeyframe(model, data, model.key("walk_ready").id)
    data.ctrl[model.actuator("l_knee_act").id] += 0.4
    data.ctrl[model.actuator("r_ankle_pitch_act").id] += 0.5
    rows = []
    for _ in range(250):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos[:3] / size, data.qpos[3:]]))
    return np.array(rows)


@pytest.mark.parametrize("size", [0.8, 1.3])
def test_a_scaled_robot_moves_as_the_original_does(size):
    motions = []
    for each in (1.0, size):
        spec = spec_of(each)
        floor = spec.worldbody.add_geom(
            name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], condim=4
        )
        floor.contype, floor.conaffinity = 3, 1
        floor.solref[0] = 0.01 * sqrt(each)
        floor.solimp[2] = 0.001 * each
        motions.append(crouch(spec.compile(), each))
    assert np.ptp(motions[0][:, 2]) > 0.02
    np.testing.assert_allclose(motions[1], motions[0], atol=1e-6)


@pytest.mark.parametrize("size", [0.8, 1.3])
def test_its_measures_scale(size, tmp_path):
    y = scaled_robot(size, tmp_path).model.measures()
    assert (y.leg, y.hip, y.sole) == pytest.approx(
        (size * HSR_VIII.leg, size * HSR_VIII.hip, size * HSR_VIII.sole), rel=1e-5
    )
    assert y.time == pytest.approx(sqrt(size) * HSR_VIII.time, rel=1e-5)
    assert y.weight == pytest.approx(size**3 * HSR_VIII.weight, rel=1e-5)
    assert y.ankle == pytest.approx(HSR_VIII.ankle, rel=1e-5)
