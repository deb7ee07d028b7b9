"""Properties of prepared models: nothing of the file is lost, whatever its conventions."""

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import SubElement

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError
from hsr8.robots.file.read import compile_spec, read_spec
from hsr8.robots.loaded import read_robot
from hsr8.robots.model.prepare import hold, prepare
from hsr8.robots.parts.roles import find_roles
from hsr8.robots.parts.skeleton import Posed
from tests.hsr8.robots.robot_parts import described, part
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import SmallUrdf, built, describe, joint, link, raw, write

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


def random_angles(model, seed):
    rng = np.random.default_rng(seed)
    limited = model.jnt_limited.astype(bool)
    ranges = np.where(limited[:, None], model.jnt_range, [[-1.0, 1.0]])
    return {model.joint(j).name: float(rng.uniform(*ranges[j])) for j in range(1, model.njnt)}


def mechanism(file):
    """Text of the links and joints only; Pinocchio refuses some limits and shapes."""
    robot = ElementTree.fromstring(file.read_bytes())
    for element in list(robot):
        if element.tag not in ("link", "joint"):
            robot.remove(element)
        for child in list(element):
            if child.tag in ("visual", "collision", "mimic"):
                element.remove(child)
            elif child.tag == "limit":
                child.attrib.update(effort="1", velocity="1")
    return ElementTree.tostring(robot, encoding="unicode")


def assert_same_as_pinocchio(file, model, held=None, seed=1):
    """Compare places, CoM and mass matrix at random angles with the file as Pinocchio reads it."""
    other = pin.buildModelFromXML(mechanism(file), pin.JointModelFreeFlyer())
    data, angles = other.createData(), random_angles(model, seed)
    q = pin.neutral(other)
    for name, angle in {**(held or {}), **angles}.items():
        at = other.joints[other.getJointId(name)]
        turned = at.nq == 2  # a continuous joint
        q[at.idx_q : at.idx_q + at.nq] = (np.cos(angle), np.sin(angle)) if turned else angle
    matrix = pin.crba(other, data, q)
    matrix = np.triu(matrix) + np.triu(matrix, 1).T
    pin.forwardKinematics(other, data, q)
    posed = Posed.at(model, angles)
    own = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, posed.data, own)
    mass = pin.computeTotalMass(other)
    assert model.body_mass.sum() == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(
        posed.data.subtree_com[1], pin.centerOfMass(other, data, q), atol=1e-9
    )
    for name in angles:
        place = data.oMi[other.getJointId(name)].translation
        np.testing.assert_allclose(posed.data.joint(name).xanchor, place, atol=1e-9)
    ours = [model.joint(name).dofadr[0] for name in angles]
    theirs = [other.joints[other.getJointId(name)].idx_v for name in angles]
    np.testing.assert_allclose(
        own[np.ix_(ours, ours)], matrix[np.ix_(theirs, theirs)], atol=1e-9, rtol=3e-6
    )


@pytest.mark.parametrize("variant", VARIANTS)
def test_places_and_masses_are_those_of_the_file(variant, tmp_path):
    """At every load the robot is compared with this model."""
    file = write(variant.element(), tmp_path)
    source = read_spec(file, {})
    prepare(source, None, posture={})
    assert_same_as_pinocchio(file, compile_spec(source, source.spec)[0])


def held_robot(seed):
    robot = SmallUrdf(seed=seed).element()
    SubElement(joint(robot, "l_elbow"), "mimic", joint="l_shoulder", multiplier="2", offset="0.1")
    joint(robot, "r_elbow").set("type", "prismatic")
    joint(robot, "head_yaw").find("limit").set("effort", "0")
    joint(robot, "head_pitch").find("limit").attrib.update(lower="0.2", upper="0.2")
    return robot


def test_joints_without_a_servo_are_held_where_they_belong(tmp_path):
    robot = held_robot(4)
    read = raw(robot, tmp_path, rigid=["waist"], posture={"waist": 0.3, "l_shoulder": 0.2})
    names = {read.model.joint(j).name for j in range(read.model.njnt)}
    assert names & {"l_elbow", "r_elbow", "head_yaw", "head_pitch", "waist"} == set()
    assert {"l_shoulder", "r_shoulder"} <= names
    for reason in ("follows a joint", "prismatic", "zero effort", "range of zero", "stated rigid"):
        assert any(f"joints held ({reason})" in note for note in read.notes)
    held = {"waist": 0.3, "l_elbow": 0.5, "head_pitch": 0.2}
    assert_same_as_pinocchio(tmp_path / "small.urdf", read.model, held)


SITE = Path(np.__file__).parents[1]
FOLDERS = (SITE / "cmeel.prefix/share/example-robot-data/robots", SITE / "jvrc_description/urdf")
ICUBS = SITE.parents[2] / "share" / "iCub" / "robots"
PUBLIC = [  # humanoids with legs of six joints
    FOLDERS[0] / "alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf",
    FOLDERS[0] / "alex_description/urdf/alex_nub_hands.urdf",
    FOLDERS[0] / "g1_description/urdf/g1_29dof_rev_1_0.urdf",
    FOLDERS[0] / "talos_data/robots/talos_full_v2.urdf",
    FOLDERS[1] / "jvrc1.urdf",
    *sorted(ICUBS.glob("iCubGazebo*/model.urdf")),
]


@pytest.mark.parametrize("file", PUBLIC, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_public_robots_are_those_of_pinocchio(file):
    if not file.is_file():
        pytest.skip("the wheel is not installed")
    source = read_spec(file, {})
    for mesh in list(source.spec.meshes):  # shapes do not change the masses
        for element in (*(g for g in source.spec.geoms if g.meshname == mesh.name), mesh):
            source.spec.delete(element)
    prepared = prepare(source, None, posture={})
    model, _ = compile_spec(source, source.spec)
    assert_same_as_pinocchio(file, model, dict.fromkeys(prepared.held, 0.0))


def placed(read, description, angles):
    """Centres of mass, and directions of the links, in the base frame, by name."""
    find_roles(read.model, description, read.prepared)
    model = read.prepared.spec.copy().compile()
    posed = Posed.at(model, angles)
    names = [model.body(b).name for b in range(1, model.nbody)]
    return {name: (posed.data.body(name).xipos, posed.data.body(name).xmat) for name in names}


@pytest.mark.parametrize("turn", range(1, 24, 5))
def test_any_quarter_turn_of_the_root_gives_the_same_robot(turn, tmp_path):
    angles = {"l_knee": 0.5, "r_hip_pitch": -0.4, "waist": 0.3, "l_elbow": 0.2}
    plain, turned = (
        placed(raw(SmallUrdf(root=root).element(), tmp_path), describe(), angles)
        for root in (Rotation.identity(), QUARTER_TURNS[turn])
    )
    for name, (com, rotation) in plain.items():
        np.testing.assert_allclose(turned[name][0], com, atol=1e-9)
        np.testing.assert_allclose(turned[name][1], rotation, atol=1e-9)


def in_frame(quat):
    """Turn the robot in its base, so that the directions of the base are others."""

    def change(root):
        base, turn = part(root, "body", "base"), Rotation.from_quat(quat, scalar_first=True)
        for child in list(base):
            if child.tag == "freejoint":
                continue
            position = [float(v) for v in child.get("pos", "0 0 0").split()]
            child.set("pos", " ".join(map(str, turn.apply(position))))
            child.set("quat", " ".join(map(str, quat)))

    return change


@pytest.mark.parametrize("quat", [(0.0, 0.0, 0.0, 1.0), (0.5, 0.5, 0.5, 0.5), (0.6, 0.0, 0.0, 0.8)])
def test_an_mjcf_robot_may_face_any_axis_of_its_base(quat, tmp_path):
    keys, robots = described(SmallHumanoid()), []
    angles = {"l_knee": 0.5, "r_hip_pitch": -0.4, "head_yaw": 0.3}
    for change in (in_frame((1.0, 0.0, 0.0, 0.0)), in_frame(quat)):
        root = SmallHumanoid().element()
        change(root)
        (tmp_path / "robot.xml").write_text(ElementTree.tostring(root, "unicode"))
        read = read_robot(keys, tmp_path / "robot.toml")
        if quat[0] == 0.6 and robots:
            with pytest.raises(ModelError, match="from the axes of 'base'"):
                placed(read, keys, angles)
            return
        robots.append(placed(read, keys, angles))
    for name, (com, rotation) in robots[0].items():
        np.testing.assert_allclose(robots[1][name][0], com, atol=1e-9)
        if name != "base":
            np.testing.assert_allclose(robots[1][name][1], rotation, atol=1e-9)


def test_a_missing_free_joint_is_added(tmp_path):
    models = []
    for free in (True, False):
        (tmp_path / "robot.xml").write_text(SmallHumanoid(free=free).xml())
        read = read_robot(described(SmallHumanoid()), tmp_path / "robot.toml")
        models.append(read.model)
    assert "base: free joint added to body 'base'" in read.notes
    np.testing.assert_array_equal(models[0].jnt_type, models[1].jnt_type)
    np.testing.assert_array_equal(models[0].qpos0, models[1].qpos0)


CHAIN = """<mujoco><compiler angle="{unit}"/><worldbody><body name="a"><freejoint/><geom size=".1"/>
<frame pos="0 0 .1" euler="{frame}"><body name="b" pos=".1 .2 .3" {pose}>
<joint name="one" pos=".01 .02 .03" axis="1 2 3"/><joint name="two" pos=".03 .01 0" axis="0 2 1"/>
<joint name="three" type="{kind}" axis="3 1 0" pos="0 .1 0" ref="{ref}"/><geom size=".1"/>
<site name="end" pos=".3 .2 .1" quat="1 2 3 4"/></body></frame></body></worldbody></mujoco>"""


@pytest.mark.parametrize("unit", ["radian", "degree"])
@pytest.mark.parametrize("pose", ["", 'quat="1 .2 .3 .4"', 'euler=".1 .2 .3"', 'zaxis="1 2 3"'])
@pytest.mark.parametrize(
    ("name", "kind"), [("one", "hinge"), ("three", "hinge"), ("three", "slide")]
)
def test_a_held_joint_keeps_its_angle_in_any_body(unit, pose, name, kind):
    text = CHAIN.format(unit=unit, pose=pose, kind=kind, ref="0.2", frame="10 0 0")
    spec = mujoco.MjSpec.from_string(text)
    free = spec.copy().compile()
    hold(spec, name, 0.7)
    fixed = spec.compile()
    assert fixed.njnt == free.njnt - 1
    others = {n: 0.3 * k - 0.4 for k, n in enumerate(("one", "two", "three")) if n != name}
    before, after = Posed.at(free, {**others, name: 0.7}), Posed.at(fixed, others)
    np.testing.assert_allclose(
        after.data.site("end").xpos, before.data.site("end").xpos, atol=1e-12
    )
    np.testing.assert_allclose(
        after.data.site("end").xmat, before.data.site("end").xmat, atol=1e-12
    )


def test_what_refers_to_a_held_joint_is_removed(tmp_path):
    root = SmallHumanoid().element()
    for section in (
        '<equality><joint joint1="l_elbow2_pitch" joint2="r_elbow2_pitch"/></equality>',
        '<sensor><jointpos joint="l_elbow2_pitch"/></sensor>',
    ):
        root.append(ElementTree.fromstring(section))
    (tmp_path / "robot.xml").write_text(ElementTree.tostring(root, "unicode"))
    read = read_robot(described(SmallHumanoid()), tmp_path / "robot.toml")
    assert "1 joints held (follows a joint): l_elbow2_pitch" in read.notes
    assert (read.model.neq, read.model.nu) == (0, 19)


BALL = '<body name="ball" pos="1 0 1"><joint name="roll"/><geom size="0.1"/></body>'
FREE_BALL = '<body name="ball" pos="1 0 1"><freejoint/><geom size="0.1"/></body>'


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize("ball", [BALL, FREE_BALL])
def test_other_bodies_are_left_out_with_a_note(tmp_path, ball, first):
    root = SmallHumanoid(actuator="").element()
    root.find("worldbody").insert(0 if first else 1, ElementTree.fromstring(ball))
    if ball == BALL:
        SubElement(SubElement(root, "sensor"), "jointpos", joint="roll")
        SubElement(root.find("actuator"), "motor", joint="roll")
    (tmp_path / "robot.xml").write_text(ElementTree.tostring(root, "unicode"))
    read = read_robot(described(SmallHumanoid()), tmp_path / "robot.toml")
    assert "1 other bodies of the scene left out: 'ball'" in read.notes
    assert (read.model.nu, read.model.nsensor, read.model.nq) == (0, 0, 27)


def test_the_robot_is_that_of_the_foot(tmp_path):
    root = SmallHumanoid(actuator="").element()
    other = SmallHumanoid(actuator="", name=lambda side, name: f"b{side}_{name}").element()
    for body in other.iter("body"):
        body.set("name", "b_" + body.get("name"))
    part(other, "freejoint", "root").set("name", "b_root")
    for geom in other.iter("geom"):
        geom.attrib.pop("name", None)
    root.find("worldbody").append(other.find("worldbody").find("body"))
    (tmp_path / "robot.xml").write_text(ElementTree.tostring(root, "unicode"))
    for feet, base in (
        (SmallHumanoid().feet(), "base"),
        (("b_bl_ankle_roll_link", "b_br_ankle_roll_link"), "b_base"),
    ):
        read = read_robot(described(SmallHumanoid(), feet=feet), tmp_path / "robot.toml")
        assert read.prepared.root == base
        assert read.model.body(1).name == base


def test_a_world_link_with_a_floating_joint_is_left_out(tmp_path):
    robot = SmallUrdf(seed=8).element()
    plain = raw(robot, tmp_path).model
    SubElement(robot, "link", name="world")
    floating = SubElement(robot, "joint", name="floating", type="floating")
    SubElement(floating, "parent", link="world")
    SubElement(floating, "child", link="pelvis")
    model = raw(robot, tmp_path).model
    np.testing.assert_array_equal(model.body_pos, plain.body_pos)


def test_the_link_that_carries_the_legs_is_the_base(small_robot, tmp_path):
    robot = SmallUrdf().element()
    SubElement(robot, "link", name="footprint")
    fixed = SubElement(robot, "joint", name="footprint_fixed", type="fixed")
    SubElement(fixed, "origin", xyz="0 0 0.44", rpy="0 0 1")
    SubElement(fixed, "parent", link="footprint")
    SubElement(fixed, "child", link="pelvis")
    robot = built(robot, tmp_path)
    assert "base: 'pelvis', fixed to 'footprint'" in robot.notes
    assert robot.height == pytest.approx(small_robot.height, abs=1e-9)
    np.testing.assert_allclose(robot.model.ready, small_robot.model.ready, atol=1e-9)


def test_links_without_mass_are_kept(tmp_path):
    robot = SmallUrdf(seed=9).element()
    element = link(robot, "l_hip_roll_link")
    element.remove(element.find("inertial"))
    assert any(
        "without mass, given 1e-08 kg: l_hip_roll_link" in n for n in raw(robot, tmp_path).notes
    )


@pytest.mark.parametrize("kind", ["urdf", "mjcf"])
def test_impossible_inertias_are_listed_in_one_message_and_repaired(kind, tmp_path):
    parts, values = ("l_knee_link", "r_knee_link"), (("0", "0", "0"), ("1", "2", "3.5"))
    if kind == "urdf":
        root = SmallUrdf().element()
        for name, moments in zip(parts, values, strict=True):
            inertia = link(root, name).find("inertial/inertia")
            inertia.attrib.update(zip(("ixx", "iyy", "izz"), moments, strict=True))
        file, keys = write(root, tmp_path), describe
    else:
        root = SmallHumanoid().element()
        for name, moments in zip(parts, values, strict=True):
            part(root, "body", name).find("inertial").set("diaginertia", " ".join(moments))
        file = tmp_path / "robot.xml"
        file.write_text(ElementTree.tostring(root, "unicode"))

        def keys(**more):
            return described(SmallHumanoid(), **more)

    with pytest.raises(ModelError) as caught:
        read_robot(keys(), file.with_suffix(".toml"))
    message = str(caught.value)
    assert "impossible inertias, got 2 bodies" in message
    assert "'l_knee_link' (0 0 0), 'r_knee_link' (1 2 3.5); expected positive moments" in message
    assert message.endswith("state repair_inertia = true")
    read = read_robot(keys(repair_inertia=True), file.with_suffix(".toml"))
    assert (
        "2 impossible inertias replaced by that of a ball: l_knee_link, r_knee_link" in read.notes
    )
    moments = [read.model.body(name).inertia for name in parts]
    assert np.ptp(moments) < 1e-5 * np.max(moments)
    assert np.min(moments) > 0.0
