"""URDF of a robot: places, masses and forces agree with Pinocchio; meshes are closed."""

from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from hsr8.errors import ModelError
from hsr8.export.links import links_of, model_of
from hsr8.export.urdf import urdf_of
from hsr8.robots.loaded import load_robot


def loaded(name):
    try:
        return load_robot(name)
    except ModelError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize("name", ["hsr8", "op3", "g1", "berkeley"])
def test_urdf_agrees_with_pinocchio(name):
    robot = loaded(name)
    model, urdf = model_of(robot), urdf_of(robot)
    data, links = mujoco.MjData(model), links_of(model)
    other = pin.buildModelFromXML(urdf.text, pin.JointModelFreeFlyer())
    other.gravity.linear = model.opt.gravity
    work, rng = other.createData(), np.random.default_rng(0)
    assert sum(i.mass for i in other.inertias) == pytest.approx(
        model.body_subtreemass[1], abs=1e-12
    )
    for _ in range(20):
        data.qpos[:], q = 0.0, pin.neutral(other)
        base = pin.Quaternion(*(rng.normal(size=4))).normalized()
        q[:3] = rng.normal(size=3)
        q[3:7] = base.coeffs()
        root = model.jnt_qposadr[0]
        data.qpos[root : root + 7] = [*q[:3], base.w, base.x, base.y, base.z]
        dofs = []
        for joint in (model.joint(j) for j in range(1, model.njnt)):
            angle = rng.uniform(-1.0, 1.0)
            data.qpos[joint.qposadr[0]] = angle
            there = other.joints[other.getJointId(joint.name)]
            q[there.idx_q : there.idx_q + there.nq] = (
                angle if there.nq == 1 else [np.cos(angle), np.sin(angle)]
            )
            dofs.append((joint.dofadr[0], there.idx_v))
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_fwdVelocity(model, data)
        pin.framesForwardKinematics(other, work, q)
        for link in links:
            if link.body >= 0:
                pose = work.oMf[other.getFrameId(link.name)]
                assert np.allclose(pose.translation, data.xpos[link.body], atol=1e-12)
                rotation = data.xmat[link.body].reshape(3, 3)
                assert np.allclose(pose.rotation, rotation, atol=1e-12)
        com = pin.centerOfMass(other, work, q, False)
        assert np.allclose(com, data.subtree_com[1], atol=1e-12)
        gravity = pin.computeGeneralizedGravity(other, work, q)
        here, there = np.array(dofs).T
        assert np.allclose(gravity[there], data.qfrc_bias[here], rtol=1e-12, atol=1e-12)


def test_mesh_files_are_closed_and_have_the_size_of_the_geom(tmp_path):
    urdf = urdf_of(load_robot("hsr8"))
    urdf.write(tmp_path / "robot.urdf", tmp_path / "meshes")
    names = {m.get("filename") for m in ElementTree.fromstring(urdf.text).iter("mesh")}
    assert names == {f"meshes/{name}" for name in urdf.meshes}
    for name in names:
        content = (tmp_path / name).read_bytes()
        corners = np.frombuffer(
            content[84:], np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
        )["c"].astype(float)
        volume = np.linalg.det(corners).sum() / 6.0  # of tetrahedra from the origin
        assert 0.9 * 4.0 / 3.0 * np.pi < volume < 4.0 / 3.0 * np.pi
        edges = np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]).round(6)
        ways = [tuple(map(tuple, edge)) for edge in (edges + 0.0).tolist()]
        assert {(b, a) for a, b in ways} == set(ways)


def test_joints_have_the_limits_of_the_model():
    robot = load_robot("hsr8")
    tree = robot.model.tree
    joints = {j.get("name"): j for j in ElementTree.fromstring(urdf_of(robot).text).iter("joint")}
    for k, name in enumerate(tree.names):
        limit = joints[name].find("limit")
        values = [float(limit.get(key)) for key in ("lower", "upper", "effort", "velocity")]
        assert values == [tree.lower[k], tree.upper[k], tree.effort[k], tree.speed[k]]
