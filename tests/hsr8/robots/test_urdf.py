"""Properties of a converted URDF robot: nothing of the file is lost, whatever its conventions."""

from importlib.util import find_spec
from pathlib import Path
from xml.etree.ElementTree import SubElement

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError
from hsr8.robots.description import checked
from hsr8.robots.roles import find_roles
from hsr8.robots.urdf import convert
from tests.hsr8.robots.small_urdf import SmallUrdf, describe, joint, link, write

QUARTER_TURNS = Rotation.create_group("O")
VARIANTS = [
    SmallUrdf(
        hip=hip, ankle=ankle, offset=offset, root=QUARTER_TURNS[5 * seed % 24], seed=seed, arms=arms
    )
    for seed, (hip, ankle, offset, arms) in enumerate(
        [
            ("yrp", "pr", 0.0, True),
            ("pry", "pr", 0.02, True),
            ("rpy", "rp", -0.01, False),
            ("ypr", "pr", 0.03, True),
            ("pyr", "rp", 0.01, False),
            ("ryp", "pr", 0.02, True),
        ]
    )
]


def converted(robot, folder, **keys):
    file = write(robot, folder)
    return convert(file, describe(**keys), folder), file


def at(model, angles):
    """State with the base at the origin and joints at angles."""
    data = mujoco.MjData(model)
    data.qpos[:3] = 0.0
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_forward(model, data)
    return data


def random_angles(model, seed):
    rng = np.random.default_rng(seed)
    return {model.joint(j).name: rng.uniform(*model.jnt_range[j]) for j in range(1, model.njnt)}


@pytest.mark.parametrize("variant", VARIANTS)
def test_mass_matrix_and_com_are_those_of_the_file(variant, tmp_path):
    robot, file = converted(variant.element(), tmp_path)
    model = robot.spec.compile()
    raw = pin.buildModelFromUrdf(str(file), pin.JointModelFreeFlyer())
    assert model.body_mass.sum() == pytest.approx(pin.computeTotalMass(raw), rel=1e-12)
    angles = random_angles(model, 1)
    data = at(model, angles)
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    q, raw_data = pin.neutral(raw), raw.createData()
    for name, angle in angles.items():
        q[raw.idx_qs[raw.getJointId(name)]] = angle
    expected = pin.crba(raw, raw_data, q)
    expected = np.triu(expected) + np.triu(expected, 1).T
    ours = [model.joint(name).dofadr[0] for name in angles]
    theirs = [raw.idx_vs[raw.getJointId(name)] for name in angles]
    np.testing.assert_allclose(
        matrix[np.ix_(ours, ours)], expected[np.ix_(theirs, theirs)], atol=1e-9
    )
    com = variant.root.apply(pin.centerOfMass(raw, raw_data, q))
    np.testing.assert_allclose(data.subtree_com[1], com, atol=1e-9)


@pytest.mark.parametrize("turn", range(24))
def test_any_quarter_turn_of_the_root_gives_the_same_robot(turn, tmp_path):
    models = [
        converted(SmallUrdf(root=root).element(), tmp_path)[0].spec.compile()
        for root in (Rotation.identity(), QUARTER_TURNS[turn])
    ]
    for seed in range(3):
        plain, turned = (at(model, random_angles(models[0], seed)) for model in models)
        np.testing.assert_allclose(turned.xpos, plain.xpos, atol=1e-12)
        np.testing.assert_allclose(turned.xmat[1:], plain.xmat[1:], atol=1e-12)
        np.testing.assert_allclose(turned.xipos, plain.xipos, atol=1e-12)


def test_the_turn_of_the_root_is_reported(tmp_path):
    robot, _ = converted(
        SmallUrdf(root=Rotation.from_euler("z", 180, degrees=True)).element(), tmp_path
    )
    assert "base turned: forward is -x of link 'pelvis', up its z" in robot.notes


@pytest.mark.parametrize("variant", VARIANTS)
def test_roles_are_those_of_the_file(variant, tmp_path):
    robot, _ = converted(variant.element(), tmp_path)
    roles = find_roles(robot.spec.compile(), robot.description, "small.urdf")
    assert roles.legs == variant.legs()
    assert roles.feet == robot.feet == tuple(f"{leg[-1]}_link" for leg in variant.legs())
    assert roles.base == "pelvis"


@pytest.mark.parametrize("variant", VARIANTS)
def test_the_robot_stands_on_mirrored_soles(variant, tmp_path):
    robot, _ = converted(variant.element(), tmp_path)
    model = robot.spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    left, right = robot.soles
    assert left == pytest.approx((0.10, -0.06, 0.045, -0.035, -0.04), abs=1e-9)
    assert right == pytest.approx(left.mirrored(), abs=1e-9)
    for foot in robot.feet:
        (box,) = (g for g in range(model.ngeom) if model.geom(g).name == f"{foot}_sole")
        np.testing.assert_allclose(data.geom_xmat[box].reshape(3, 3), np.eye(3), atol=1e-9)
        assert data.geom_xpos[box][2] - model.geom_size[box][2] == pytest.approx(0.0, abs=1e-9)


def test_contacts_only_of_soles_and_with_obstacles(tmp_path):
    model = converted(SmallUrdf().element(), tmp_path)[0].spec.compile()
    by_group = {}
    for g in range(model.ngeom):
        bits = (int(model.geom_contype[g]), int(model.geom_conaffinity[g]))
        by_group.setdefault(int(model.geom_group[g]), set()).add(bits)
    assert by_group == {2: {(0, 0)}, 3: {(0, 2), (1, 1)}}
    feet = [g for g in range(model.ngeom) if model.geom_contype[g]]
    assert all(model.geom_condim[g] == 4 and model.geom_friction[g][0] == 0.8 for g in feet)


def test_shapes_do_not_change_the_masses(tmp_path):
    robot = SmallUrdf(seed=3).element()
    full = converted(robot, tmp_path)[0].spec.compile()
    for element in robot.findall("link"):
        for shape in [*element.findall("visual"), *element.findall("collision")]:
            if not element.get("name").endswith("foot"):
                element.remove(shape)
    bare = converted(robot, tmp_path)[0].spec.compile()
    assert bare.ngeom < full.ngeom
    np.testing.assert_array_equal(bare.body_mass, full.body_mass)
    np.testing.assert_array_equal(bare.body_inertia, full.body_inertia)


def test_limits_come_from_the_file(tmp_path):
    robot, _ = converted(SmallUrdf().element(), tmp_path)
    model = robot.spec.compile()
    knee = model.joint("l_knee")
    np.testing.assert_allclose(knee.range, (-0.1, 2.2))
    assert robot.description.effort["l_knee"] == 40.0
    assert robot.description.speed["l_knee"] == 8.0
    np.testing.assert_allclose(model.jnt_actfrcrange[knee.id], (-40.0, 40.0))
    assert float(knee.damping[0]) == 0.1
    assert float(knee.frictionloss[0]) == 0.05


@pytest.mark.parametrize("placeholder", ["-1", "3e38", "10001"])
def test_a_placeholder_of_an_effort_is_no_limit(placeholder, tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "l_knee").find("limit").set("effort", placeholder)
    result, _ = converted(robot, tmp_path)
    assert "l_knee" not in result.description.effort
    assert any("effort of 1 joints is not stated" in note for note in result.notes)
    result, _ = converted(robot, tmp_path, effort={"l_knee": 50.0}, speed={"l_knee": 3.0})
    assert result.description.effort["l_knee"] == 50.0
    assert result.description.speed["l_knee"] == 3.0


def test_a_continuous_joint_gets_one_turn(tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "l_hip_yaw").set("type", "continuous")
    model = converted(robot, tmp_path)[0].spec.compile()
    np.testing.assert_allclose(model.joint("l_hip_yaw").range, (-np.pi, np.pi))


def test_a_stated_range_frees_a_joint_without_one(tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "l_knee").find("limit").attrib.update(lower="0", upper="0")
    model = converted(robot, tmp_path, range={"l_knee": (-0.1, 2.0)})[0].spec.compile()
    np.testing.assert_allclose(model.joint("l_knee").range, (-0.1, 2.0))


def test_joints_without_a_servo_are_held(tmp_path):
    robot = SmallUrdf(seed=4).element()
    SubElement(joint(robot, "l_elbow"), "mimic", joint="l_shoulder", multiplier="2", offset="0.1")
    joint(robot, "r_elbow").set("type", "prismatic")
    joint(robot, "head_yaw").find("limit").set("effort", "0")
    joint(robot, "head_pitch").find("limit").set("lower", "1.5")
    result, _ = converted(
        robot, tmp_path, rigid=["waist"], posture={"waist": 0.3, "l_shoulder": 0.2}
    )
    names = {j.name for j in result.spec.joints}
    assert names & {"l_elbow", "r_elbow", "head_yaw", "head_pitch", "waist"} == set()
    assert {"l_shoulder", "r_shoulder"} <= names
    for reason in ("mimics a joint", "prismatic", "zero effort", "range of zero", "stated rigid"):
        assert any(f"joints held ({reason})" in note for note in result.notes)
    # The comparison with the file held every joint at the angle that the conversion used.
    chest = next(b for b in result.spec.bodies if b.name == "l_shoulder_link")
    assert np.hypot(*chest.pos[:2]) == pytest.approx(0.12)
    assert np.arctan2(-chest.pos[0], chest.pos[1]) == pytest.approx(0.3)


def test_efforts_of_zero_everywhere_do_not_hold_the_legs(tmp_path):
    robot = SmallUrdf().element()
    for element in robot.findall("joint"):
        if element.find("limit") is not None:
            element.find("limit").set("effort", "0")
    result, _ = converted(robot, tmp_path, shoulders=["l_shoulder", "r_shoulder"])
    names = {j.name for j in result.spec.joints}
    left, right = SmallUrdf().legs()
    assert names == {"pelvis_free", *left, *right, "l_shoulder", "r_shoulder"}
    assert not result.description.effort


def test_posture_of_an_srdf_file(tmp_path):
    (tmp_path / "small.srdf").write_text(
        '<robot name="small"><group_state name="home" group="all"><joint name="l_elbow" value="1"/>'
        '<joint name="r_elbow" value="1"/><joint name="gripper" value="1"/>'
        '<joint name="root" value="0 0 1"/></group_state></robot>'
    )
    result, _ = converted(
        SmallUrdf().element(), tmp_path, srdf="small.srdf", state="home", posture={"r_elbow": 0.5}
    )
    assert result.description.posture == {"l_elbow": 1.0, "r_elbow": 0.5}
    assert result.description.srdf is None


def test_a_camera_on_a_fixed_link_moves_to_its_body(tmp_path):
    robot = SmallUrdf(seed=6).element()
    camera = {"body": "camera", "position": [0.01, 0.0, 0.0], "tilt_deg": -10.0}
    mount = converted(robot, tmp_path, camera=camera)[0].description.camera
    assert mount.body == "head"
    assert mount.position == pytest.approx((0.06, 0.0, 0.05), abs=1e-9)
    assert mount.tilt_deg == -10.0


def test_the_link_that_carries_the_legs_is_the_base(tmp_path):
    robot = SmallUrdf(seed=7).element()
    SubElement(robot, "link", name="footprint")
    fixed = SubElement(robot, "joint", name="footprint_fixed", type="fixed")
    SubElement(fixed, "origin", xyz="0 0 0.44", rpy="0 0 1")
    SubElement(fixed, "parent", link="footprint")
    SubElement(fixed, "child", link="pelvis")
    result, _ = converted(robot, tmp_path)
    assert result.description.base == "pelvis"
    assert "base: link 'pelvis', fixed to the root 'footprint'" in result.notes


def test_a_world_link_with_a_floating_joint_is_left_out(tmp_path):
    robot = SmallUrdf(seed=8).element()
    plain = converted(robot, tmp_path)[0].spec.compile()
    SubElement(robot, "link", name="world")
    floating = SubElement(robot, "joint", name="floating", type="floating")
    SubElement(floating, "parent", link="world")
    SubElement(floating, "child", link="pelvis")
    model = converted(robot, tmp_path)[0].spec.compile()
    np.testing.assert_array_equal(model.body_pos, plain.body_pos)


def test_a_link_without_mass_between_two_joints_is_kept(tmp_path):
    robot = SmallUrdf(seed=9).element()
    element = link(robot, "l_hip_roll_link")
    element.remove(element.find("inertial"))
    result, _ = converted(robot, tmp_path)
    assert any("'l_hip_roll_link' has no mass" in note for note in result.notes)


def test_zero_posture_of_a_file_with_bent_legs(tmp_path):
    robot = SmallUrdf(seed=10).element()
    zero = {
        f"{side}_{name}": v for side in "lr" for name, v in (("hip_pitch", 0.4), ("knee", -0.8))
    }
    for name, angle in zero.items():
        # The file's zero differs: straight legs need the angles of `zero`.
        origin = joint(robot, name).find("origin")
        axis = np.array([float(v) for v in joint(robot, name).find("axis").get("xyz").split()])
        turn = Rotation.from_euler("xyz", [float(v) for v in origin.get("rpy").split()])
        turn = turn * Rotation.from_rotvec(-angle * axis)
        origin.set("rpy", " ".join(map(str, turn.as_euler("xyz"))))
    result, _ = converted(robot, tmp_path, zero=zero)
    assert result.soles[0] == pytest.approx((0.10, -0.06, 0.045, -0.035, -0.04), abs=1e-9)
    data = at(result.spec.compile(), zero)
    assert data.body("l_ankle_roll_link").xpos[2] == pytest.approx(-0.4)


def test_nothing_is_written(tmp_path):
    file = write(SmallUrdf().element(), tmp_path)
    convert(file, describe(), tmp_path)
    assert list(tmp_path.iterdir()) == [file]


ICUB = find_spec("icub_models")
ICUB_FOLDER = (
    Path(str(ICUB.origin)).parents[1] / "share" / "iCub" / "robots" if ICUB else Path("missing")
)
ICUBS = sorted(p.parent.name for p in ICUB_FOLDER.glob("*/model.urdf")) or ["iCubGazeboV2_7"]


@pytest.mark.skipif(ICUB is None, reason="icub_models is not installed")
@pytest.mark.parametrize("name", [name for name in ICUBS if name.startswith("iCub")])
def test_icub(name):
    file = ICUB_FOLDER / name / "model.urdf"
    description = checked({"model": str(file), "feet": ("l_foot", "r_foot")}, "icub.toml")
    if name in ("iCubGenova03", "iCubLisboa01", "iCubNancy01"):
        with pytest.raises(ModelError, match=r"link 'root_link': inertia of no rigid body"):
            convert(file, description, file.parent)
        return
    robot = convert(file, description, file.parent)
    assert robot.feet == ("l_ankle_2", "r_ankle_2")
    assert "base turned: forward is -x of link 'root_link', up its z" in robot.notes
    length, width = robot.soles[0].size
    assert 0.15 < length < 0.20
    assert 0.07 < width < 0.10
    model = robot.spec.compile()
    assert model.nmesh > 30
    roles = find_roles(model, robot.description, name)
    assert roles.legs[0][3] == "l_knee"
