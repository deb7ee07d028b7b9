"""Legs with rods, couplings, gears and double motors walk as their serial equivalent."""

from xml.etree import ElementTree
from xml.etree.ElementTree import SubElement

import mujoco
import numpy as np
import pytest

from hsr8.errors import ModelError
from hsr8.robots.file.description import checked, read_description
from hsr8.robots.inspection import description_text, inspect, load_inspected
from hsr8.robots.loaded import build_robot, load_robot, read_robot
from hsr8.robots.model.linkage import close_loops
from hsr8.robots.model.servos import own_efforts
from hsr8.robots.parts.skeleton import Posed
from hsr8.trials.walk import Trial
from tests.hsr8.robots import rod_legs
from tests.hsr8.robots.robot_parts import checked_roles, described, part, raw
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from walking.command import VelocityCommand

ANKLES = [f"{side}_ankle_{name}" for side in "lr" for name in ("pitch", "roll")]
LEGS = [
    f"{side}_{name}"
    for side in "lr"
    for name in ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
]
SERIAL = {"linkage": "serial"}


def described_rods(**keys):
    return checked({"model": "rods.xml", "feet": rod_legs.FEET, **keys}, "rods.toml")


def read_rods(folder, actuator="position", **keys):
    rod_legs.write(folder, actuator)
    return read_robot(described_rods(**keys), folder / "rods.toml")


@pytest.mark.parametrize("width", [0.02, 0.03])
@pytest.mark.parametrize("actuator", ["position", "motor"])
def test_limits_and_gains_are_carried_through_the_rods(width, actuator, tmp_path, monkeypatch):
    """Pitch turns both cranks alike; roll turns them against each other, by width over arm."""
    monkeypatch.setattr(rod_legs, "WIDTH", width)
    read = read_rods(tmp_path, actuator, speed={"l_crank_0": 5.0, "l_crank_1": 5.0}, **SERIAL)
    efforts = own_efforts(read.model)
    closed = mujoco.MjModel.from_xml_path(str(tmp_path / "rods.xml"))
    assert read.model.neq == 0
    assert read.model.body_mass.sum() == pytest.approx(closed.body_mass.sum(), rel=1e-12)
    for name in ANKLES:
        ratio = width / rod_legs.ARM if name.endswith("roll") else 1.0
        assert efforts[name] == pytest.approx(min(6.0, 2.0 * ratio * rod_legs.TORQUE), rel=1e-6)
        dof = read.model.joint(name).dofadr[0]
        reflected = 2.0 * ratio**2 * 0.001
        assert read.model.dof_armature[dof] == pytest.approx(0.005 + reflected, rel=1e-6)
        if name.startswith("l_"):
            assert read.speed[name] == pytest.approx(5.0 / ratio, rel=1e-6)
        if actuator == "position":
            gain = read.model.actuator(name).gainprm[0]
            assert gain == pytest.approx(2.0 * ratio**2 * rod_legs.STIFFNESS, rel=1e-6)


def test_the_transmission_is_the_derivative_of_the_closed_loops(tmp_path):
    model = mujoco.MjModel.from_xml_path(str(rod_legs.write(tmp_path)))
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    angles, step = dict(zip(ANKLES, (-0.5, 0.2, -0.3, -0.1), strict=True)), 1e-6

    def closed(at):
        posed = Posed.at(model, at)
        return close_loops(posed, LEGS), posed.data

    loops, data = closed(angles)
    assert len(loops.loop) == 4 * (1 + 2)  # a rod may spin about itself
    rows = data.efc_type == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)
    assert np.abs(data.efc_pos[rows]).max() < 1e-9
    cranks = [f"{side}_crank_{k}" for side in "lr" for k in range(2)]
    dofs = model.dof_jntid[loops.loop].tolist()
    for name in ANKLES:
        k = LEGS.index(name)
        ends = [closed({**angles, name: angles[name] + sign * step})[1] for sign in (1, -1)]
        for crank in cranks:
            moved = [end.joint(crank).qpos[0] for end in ends]
            row = dofs.index(model.joint(crank).id)
            rate = (moved[0] - moved[1]) / (2.0 * step)
            assert loops.transmission[row, k] == pytest.approx(rate, abs=1e-5)


def test_the_refusal_offers_the_key_and_inspect_writes_it(tmp_path):
    file = rod_legs.write(tmp_path)
    with pytest.raises(ModelError, match=r"closed chain, a connect ties 'l_rod_0'.* linkage = \"s"):
        build_robot(described_rods(), tmp_path / "rods.toml")
    inspection, robot = load_inspected(inspect(str(file)))
    (finding,) = (f for f in inspection.findings if f.role == "linkage")
    assert finding.reason.startswith("equality 'l_rod_0': closed chain")
    assert any("neglected: the motion of the rods" in note for note in robot.notes)
    written = tmp_path / "rods.toml"
    written.write_text(description_text(inspection, written, "inspect"))
    assert read_description(written).linkage == "serial"
    reference = load_robot("hsr8").model.tree
    assert robot.model.tree.names == reference.names
    walk = Trial(robot).walk(VelocityCommand(0.5 * robot.parameters.limits.vx), 4.0)
    assert walk.falls == 0


def motors(*servos):
    """Replace the actuator of the left knee by others."""

    def change(root):
        actuators = root.find("actuator")
        actuators.remove(part(actuators, "position", "l_knee"))
        for tag, keys in servos:
            SubElement(actuators, tag, joint="l_knee", **keys)

    return change


@pytest.mark.parametrize(
    ("servos", "stiffness", "torque"),
    [
        ([("position", {"kp": "3", "kv": "0.1", "gear": "10", "forcerange": "-6 6"})], 300.0, 60.0),
        (
            [
                ("position", {"kp": "100", "kv": "1", "forcerange": "-40 40"}),
                ("position", {"kp": "200", "kv": "1", "forcerange": "-20 20"}),
            ],
            300.0,
            60.0,
        ),
        ([("motor", {"gear": "60", "ctrlrange": "-1 1"})], None, 60.0),
    ],
)
def test_gears_and_double_motors_become_one_actuator(servos, stiffness, torque):
    robot = SmallHumanoid()
    own = described(robot, servo="own")
    unchanged = raw(robot, own, motors(*servos))
    with pytest.raises(ModelError):
        checked_roles(unchanged, own)
    read = raw(robot, described(robot, **SERIAL), motors(*servos))
    (servo,) = (a for a in range(read.model.nu) if read.model.actuator(a).name == "l_knee")
    assert read.model.actuator_gear[servo, 0] == 1.0
    assert own_efforts(read.model)["l_knee"] == pytest.approx(torque)
    if stiffness is not None:
        assert read.model.actuator_gainprm[servo, 0] == pytest.approx(stiffness)


def test_a_motor_coupled_to_its_joint_drives_it():
    """A belt of ratio 2 between a pulley on the thigh and the knee."""
    robot = SmallHumanoid()

    def belt(root):
        motors()(root)
        thigh = part(root, "body", "l_hip_pitch_link")
        pulley = SubElement(thigh, "body", name="pulley")
        SubElement(pulley, "joint", name="pulley", axis="0 1 0", armature="0.001")
        SubElement(pulley, "inertial", pos="0 0 0", mass="0.1", diaginertia="1e-4 1e-4 1e-4")
        tie = '<equality><joint joint1="pulley" joint2="l_knee" polycoef="0 2 0 0 0"/></equality>'
        root.append(ElementTree.fromstring(tie))
        keys = {"kp": "75", "kv": "1", "forcerange": "-30 30"}
        SubElement(root.find("actuator"), "position", joint="pulley", name="l_knee", **keys)

    description = described(robot, **SERIAL)
    read = raw(robot, description, belt)
    names = {read.model.joint(j).name for j in range(read.model.njnt)}
    assert "pulley" not in names
    assert own_efforts(read.model)["l_knee"] == pytest.approx(60.0)
    assert read.model.actuator("l_knee").gainprm[0] == pytest.approx(300.0)
    knee = read.model.joint("l_knee").dofadr[0]
    assert read.model.dof_armature[knee] == pytest.approx(0.01 + 4 * 0.001)


def test_a_leg_without_linkage_needs_no_key():
    robot = SmallHumanoid()
    with pytest.raises(ModelError, match="linkage: every joint of the legs has one actuator"):
        raw(robot, described(robot, **SERIAL))
