"""Models that earlier versions answered wrongly, each a kind of robot that users bring."""

import re
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from hsr8.errors import ModelError
from hsr8.robots.file.description import read_description
from hsr8.robots.inspection import description_text, inspect, load_inspected
from hsr8.robots.loaded import load_robot
from hsr8.trials.walk import Trial
from tests.hsr8.robots.robot_parts import adding, part, setting
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from walking.command import VelocityCommand

PLAIN = SmallHumanoid()


@pytest.fixture
def written(tmp_path):
    """Write a changed robot; return its file."""

    def write(*changes, robot=PLAIN, suffix=".xml"):
        root = robot.element()
        for change in changes:
            change(root)
        file = tmp_path / f"small{suffix}"
        file.write_text(ElementTree.tostring(root, encoding="unicode"))
        return file

    return write


@pytest.fixture
def inspected(written):
    """Load a changed robot with its guessed description."""
    return lambda *changes, **options: load_inspected(inspect(str(written(*changes, **options))))


def note(robot, text):
    return next(note for note in robot.notes if text in note)


def coupled(follower, leader, ratio="-0.8"):
    return adding(
        f'<equality><joint joint1="{follower}" joint2="{leader}" polycoef="0 {ratio} 0 0 0"/>'
        "</equality>"
    )


def test_a_repaired_robot_has_a_description_with_the_reason(inspected, tmp_path):
    """Also of keys whose values are not text."""
    broken = setting("body", "torso")

    def flat(root):
        broken(root)
        part(root, "body", "torso").find("inertial").set("diaginertia", "1 1e-3 1e-3")

    inspection, robot = inspected(flat)
    assert inspection.require_description().repair_inertia
    file = tmp_path / "written.toml"
    file.write_text(description_text(inspection, file, "inspect"))
    assert read_description(file).repair_inertia
    assert load_robot(str(file)).model.mass == robot.model.mass


def test_hips_may_pitch_about_canted_axes(inspected):
    def cant(root):
        angle = np.radians(30.0)
        for side, sign in (("l", 1.0), ("r", -1.0)):
            axis = f"0 {np.cos(angle)} {-sign * np.sin(angle)}"
            part(root, "joint", f"{side}_hip_pitch").set("axis", axis)

    _, robot = inspected(cant, robot=SmallHumanoid(hip="pry"))
    walk = Trial(robot).walk(VelocityCommand(vx=0.5 * robot.parameters.limits.vx), 3.0)
    assert not walk.falls
    assert walk.tilt.max() < 5.0


def test_the_origin_of_the_base_may_be_below_the_soles(inspected, plain):
    below = 0.4

    def shift(root):
        base = part(root, "body", "base")
        base.set("pos", f"0 0 {0.46 - below - 0.42}")
        for child in base:
            if child.tag in ("body", "inertial", "geom"):
                x, y, z = map(float, child.get("pos", "0 0 0").split())
                child.set("pos", f"{x} {y} {z + below + 0.42}")

    _, robot = inspected(shift)
    assert robot.height == pytest.approx(plain.height - below - 0.42)
    np.testing.assert_allclose(robot.model.ready, plain.model.ready, atol=1e-9)
    assert not Trial(robot).walk(VelocityCommand(), 1.0).falls


def test_a_keyframe_does_not_mind_a_joint_that_is_held(written, tmp_path):
    """The posture of the keyframe counts."""
    root = SmallHumanoid().element()
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    qpos = model.qpos0.copy()
    qpos[model.joint("r_shoulder_roll").qposadr[0]] = -0.3
    key = f'<keyframe><key name="home" qpos="{" ".join(map(str, qpos))}"/></keyframe>'
    written(adding(key))
    text = (
        'model = "small.xml"\nfeet = ["l_ankle_roll_link", "r_ankle_roll_link"]\nstate = "home"\n'
    )
    (tmp_path / "small.toml").write_text(text + 'rigid = ["head_yaw"]\n')
    robot = load_robot(str(tmp_path / "small.toml"))
    assert robot.description.posture["r_shoulder_roll"] == pytest.approx(-0.3)


def test_a_coupled_joint_of_a_leg_is_driven_by_itself(inspected):
    """It follows another one: a gear, or one motor for both hips."""
    gear = (
        '<body name="gear"><joint name="gear" axis="0 0 1"/>'
        '<inertial pos="0 0 0" mass="0.01" diaginertia="1e-5 1e-5 1e-5"/></body>'
    )

    def geared(root):
        part(root, "body", "base").append(ElementTree.fromstring(gear))
        coupled("l_hip_yaw", "gear")(root)

    for change in (geared, coupled("r_hip_yaw", "l_hip_yaw", "-1")):
        inspection, robot = inspected(change)
        assert inspection.require_description().linkage == "serial"
        assert len({*robot.model.names[:12]}) == 12
        assert not robot.spec.equalities
        (finding,) = (f for f in inspection.findings if f.role == "linkage")
        assert "couples joint" in finding.reason


@pytest.mark.parametrize("hip", ["pry", "yrp"])
def test_a_difference_of_angles_names_the_zero_that_removes_it(written, tmp_path, hip):
    """An axis that is turned, or a joint that is displaced by a turn above it."""

    def turned(root):
        angle = np.radians(3.0)
        thigh = part(root, "body", "r_hip_pitch_link")
        thigh.set("quat", f"{np.cos(angle / 2)} 0 {np.sin(angle / 2)} 0")

    file = written(turned, robot=SmallHumanoid(hip=hip))
    text = f'model = "{file.name}"\nfeet = ["l_ankle_roll_link", "r_ankle_roll_link"]\n'
    description = tmp_path / "turned.toml"
    description.write_text(text)
    with pytest.raises(ModelError, match="not the mirror image") as refusal:
        load_robot(str(description))
    (zero,) = re.findall(r"state zero\.(\w+) = (\S+)", str(refusal.value))
    description.write_text(f"{text}[zero]\n{zero[0]} = {zero[1]}\n")
    assert zero[0] == "r_hip_pitch"
    assert float(zero[1]) == pytest.approx(-np.radians(3.0), abs=1e-3)
    load_robot(str(description))


@pytest.mark.parametrize("actuator", ["position", "motor"])
def test_a_stated_effort_limits_the_physics_and_the_plan(written, tmp_path, actuator):
    written(robot=SmallHumanoid(actuator=actuator))
    text = 'model = "small.xml"\nfeet = ["l_ankle_roll_link", "r_ankle_roll_link"]\n'
    (tmp_path / "small.toml").write_text(text + "[effort]\nl_knee = 45.0\nr_knee = 75.0\n")
    robot = load_robot(str(tmp_path / "small.toml"))
    model = robot.spec.copy().compile()
    for joint, effort in (("l_knee", 45.0), ("r_knee", 75.0)):
        assert robot.model.tree.effort[robot.model.names.index(joint)] == effort
        assert model.jnt_actfrcrange[model.joint(joint).id] == pytest.approx((-effort, effort))
        (servo,) = (
            a for a in range(model.nu) if model.actuator_trnid[a, 0] == model.joint(joint).id
        )
        assert model.actuator_forcerange[servo] == pytest.approx((-effort, effort))


def test_features_that_walking_does_not_know_are_left_out_with_a_note(inspected, plain):
    _, robot = inspected(
        setting("body", "torso", gravcomp="1"),
        setting("joint", "l_knee", damping="0.1 2"),
        setting("joint", "l_elbow2_pitch", stiffness="0 2"),
    )
    for text in (
        "gravity compensation left out: torso",
        "grows with the speed left out: l_knee",
        "with the angle left out: l_elbow2",
    ):
        assert note(robot, text)
    plain_spec, spec = plain.spec.copy().compile(), robot.spec.copy().compile()
    for key in ("body_gravcomp", "dof_damping", "dof_dampingpoly", "jnt_stiffnesspoly"):
        np.testing.assert_array_equal(getattr(spec, key), getattr(plain_spec, key))


def test_rotors_of_actuators_count_as_those_of_their_joints(inspected):
    _, robot = inspected(setting("position", "l_knee", armature="0.02", damping="0.3"))
    knee = robot.model.names.index("l_knee")
    assert robot.model.tree.armature[knee] == pytest.approx(0.03)
    assert robot.model.tree.joint_damping[knee] == pytest.approx(0.4)


@pytest.mark.parametrize("drive", ["<motor tendon='t'/>", None])
def test_tendons_of_a_leg_are_refused(inspected, drive):
    """Also passive ones, and those that end on a part fixed to the foot."""

    def tendon(root):
        foot = part(root, "body", "l_ankle_roll_link")
        heel = ElementTree.fromstring(
            '<body name="heel" pos="-0.05 0 0"><site name="heel"/></body>'
        )
        foot.append(heel)
        part(root, "body", "l_knee_link").append(ElementTree.fromstring('<site name="calf"/>'))
        spring = "" if drive else 'stiffness="100"'
        adding(
            f'<tendon><spatial name="t" {spring}><site site="calf"/><site site="heel"/></spatial>'
            "</tendon>"
        )(root)
        if drive:
            root.find("actuator").append(ElementTree.fromstring(drive))

    with pytest.raises(ModelError, match=f"tendon 't': {'drives' if drive else 'pulls'} joint"):
        inspected(tendon)


def test_an_inertia_may_be_turned_by_any_kind_of_angles(written, tmp_path):
    """Also in a base that faces another direction."""

    def rotated(root):
        base = part(root, "body", "base")
        base.find("inertial").set("diaginertia", "0.02 0.03 0.04")
        base.find("inertial").set("euler", "0.4 0.2 0.1")
        for child in base.findall("body"):
            x, y, z = map(float, child.get("pos").split())
            child.set("pos", f"{-y} {x} {z}")
            child.set("euler", f"0 0 {np.pi / 2}")

    written(rotated)
    text = 'model = "small.xml"\nfeet = ["l_ankle_roll_link", "r_ankle_roll_link"]\n'
    (tmp_path / "small.toml").write_text(text)
    robot = load_robot(str(tmp_path / "small.toml"))
    raw = mujoco.MjModel.from_xml_path(str(tmp_path / "small.xml"))
    normal = robot.spec.copy().compile()
    moments = []
    for model, frame in ((raw, np.eye(3)), (normal, None)):
        body = model.body("base")
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, body.iquat)
        axes = rotation.reshape(3, 3)
        if frame is None:  # forward is y of the file
            axes = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) @ axes
        moments.append(axes @ np.diag(body.inertia) @ axes.T)
    np.testing.assert_allclose(moments[0], moments[1], atol=1e-12)
