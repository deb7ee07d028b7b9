"""Each rule of the servos, by the failure that it prevents."""

from math import pi

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.robots.model import servos
from hsr8.robots.model.servos import (
    armature_floor,
    choose_servos,
    critical_damping,
    joint_damping,
    leg_damping,
    leg_stiffness,
    own_efforts,
    upper_stiffness,
)
from hsr8.robots.parts.roles import find_roles
from hsr8.robots.parts.skeleton import Posed
from tests.hsr8.robots import robot_parts, small_urdf
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import SmallUrdf, describe, link

POSITIVE = st.floats(1e-3, 1e3)
STEP = 0.0025


def with_servos(read, description, *, sole_height=-0.44, speed=None):
    """Model of a robot with servos, and their notes."""
    roles = find_roles(read.model, description, read.prepared)
    spec = read.prepared.spec.copy()
    notes = choose_servos(
        spec,
        Posed.at(read.model, {}),
        roles,
        description,
        posture={},
        speed=read.speed if speed is None else speed,
        sole_height=sole_height,
    )
    return spec, notes


def small(folder, element=None, *, timestep=STEP, speed=None, **keys):
    """Small URDF robot with servos and floor contacts, its soles at z = 0."""
    element = SmallUrdf().element() if element is None else element
    read = small_urdf.raw(element, folder, **keys)
    read.prepared.spec.option.timestep = timestep
    spec, notes = with_servos(read, describe(**keys), speed=speed)
    spec.body("pelvis").pos = (0.0, 0.0, 0.44)
    for geom in spec.geoms:
        solid = geom.conaffinity and "foot" in geom.name
        geom.contype = geom.conaffinity = int(bool(solid))
    return spec, notes


def swing(inertia, kp, kv, *, armature=0.0, timestep=STEP, steps=400):
    """Maximum angle of a free joint that starts 0.01 rad off its setpoint, in units of that."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{timestep}" integrator="implicitfast" gravity="0 0 0"/>
        <worldbody><body><joint name="j" axis="0 1 0" armature="{armature}"/>
        <inertial pos="0 0 0" mass="1" diaginertia="{inertia} {inertia} {inertia}"/></body>
        </worldbody><actuator><position joint="j" kp="{kp}" kv="{kv}"/></actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qpos[0] = 0.01
    angles = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        angles.append(float(data.qpos[0]) / 0.01)
        if not abs(angles[-1]) < 1e4:
            break
    return np.array(angles)


def test_without_the_armature_floor_a_light_ankle_diverges():
    # The stiffness carries the whole body of 33 kg, the joint moves only the foot.
    kp, inertia = leg_stiffness(33.0, 0.55, 0.1), 2e-4
    floor = armature_floor(kp, inertia, STEP)
    assert np.abs(swing(inertia, kp, leg_damping(kp, inertia, 0.05))).max() > 1e3
    damping = leg_damping(kp, inertia + floor, 0.05)
    assert np.abs(swing(inertia, kp, damping, armature=floor)).max() <= 1.0


@given(kp=POSITIVE, inertia=st.floats(1e-6, 1e2), timestep=st.floats(1e-4, 5e-3))
def test_floor_leaves_a_quarter_of_the_stability_limit_in_frequency(kp, inertia, timestep):
    total = inertia + armature_floor(kp, inertia, timestep)
    assert kp * timestep**2 <= 0.25 * total * (1.0 + 1e-9)


@given(kp=POSITIVE, timestep=st.floats(1e-4, 5e-3))
def test_heavy_joints_need_no_armature(kp, timestep):
    assert armature_floor(kp, 4.1 * kp * timestep**2, timestep) == 0.0


@given(mass=POSITIVE, height=POSITIVE, compliance=st.floats(0.01, 1.0))
def test_relative_compliance_is_the_same_for_all_robots(mass, height, compliance):
    stiffness = leg_stiffness(mass, height, compliance)
    assert mass * 9.81 * 0.85 * height / stiffness == pytest.approx(compliance)


@given(kp=POSITIVE, inertia=POSITIVE, lag=st.floats(0.001, 1.0))
def test_legs_neither_lag_nor_are_overdamped(kp, inertia, lag):
    kv = leg_damping(kp, inertia, lag)
    assert kv / kp <= lag * (1.0 + 1e-12)
    assert kv <= critical_damping(kp, inertia)


@pytest.mark.parametrize("inertia", [1e-4, 1e-2, 1.0])
def test_upper_joints_settle_without_overshoot_at_their_frequency(inertia):
    kp = upper_stiffness(inertia, 6.0)
    assert np.sqrt(kp / inertia) / (2.0 * pi) == pytest.approx(6.0)
    angles = swing(inertia, kp, critical_damping(kp, inertia))
    assert angles.min() > -0.02
    assert abs(angles[-1]) < 1e-3


@pytest.mark.parametrize("seed", range(3))
def test_a_joint_at_full_torque_does_not_exceed_its_speed(seed):
    rng = np.random.default_rng(seed)
    effort, speed, inertia = rng.uniform(1.0, 50.0), rng.uniform(1.0, 10.0), rng.uniform(0.01, 1.0)
    damping = joint_damping(0.0, effort, speed)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option integrator="implicitfast" gravity="0 0 0"/><worldbody><body>
        <joint name="j" axis="0 1 0" damping="{damping}"/>
        <inertial pos="0 0 0" mass="1" diaginertia="{inertia} {inertia} {inertia}"/></body>
        </worldbody><actuator><motor joint="j"/></actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.ctrl[0] = effort
    for _ in range(5000):
        mujoco.mj_step(model, data)
        assert data.qvel[0] <= speed * (1.0 + 1e-6)
    assert data.qvel[0] > 0.9 * speed


def test_damping_of_the_file_is_kept_where_it_is_larger_or_a_limit_is_unknown():
    assert joint_damping(10.0, 40.0, 8.0) == 10.0
    assert joint_damping(0.1, None, 8.0) == 0.1
    assert joint_damping(0.1, 40.0, None) == 0.1


def load(model):
    """Weight of a robot times the height of its CoM above the soles [N m]."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return float(model.body_subtreemass[1] * 9.81 * data.subtree_com[1, 2])


@pytest.mark.parametrize("effort", [10.0, 1000.0])
def test_an_effort_beyond_the_weight_is_a_placeholder_and_brakes_no_motion(effort, tmp_path):
    element = SmallUrdf().element()
    for limit in element.iter("limit"):
        limit.set("effort", str(effort))
    model = small(tmp_path, element)[0].compile()
    np.testing.assert_allclose(model.actuator_forcerange[:, 1], effort)
    np.testing.assert_allclose(model.dof_damping[6:], min(effort, load(model)) / 8.0)


def test_every_joint_has_a_servo_with_the_limits_of_the_file(tmp_path):
    spec, notes = small(tmp_path)
    model = spec.compile()
    assert model.nu == model.njnt - 1
    np.testing.assert_allclose(model.actuator_forcerange, [[-40.0, 40.0]] * model.nu)
    np.testing.assert_allclose(model.dof_damping[6:], min(40.0, load(model)) / 8.0)
    left, right = SmallUrdf().legs()
    gains = {model.actuator(a).name: float(model.actuator_gainprm[a, 0]) for a in range(model.nu)}
    stiffness = {gains[name] for name in (*left, *right)}
    assert len(stiffness) == 1
    assert any("servos by rule: 19" in note for note in notes)
    assert any("armature added" in note for note in notes)


def standing_tilt(spec, timestep=STEP, seconds=2.0):
    """Maximum tilt of the robot on its servos [rad], infinite where the physics diverges."""
    spec.option.timestep = timestep
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    floor = mujoco.mjtGeom.mjGEOM_PLANE
    spec.worldbody.add_geom(type=floor, size=[5, 5, 0.1], friction=[0.8, 0.01, 0.001])
    model = spec.compile()
    data = mujoco.MjData(model)
    tilt = 0.0
    for _ in range(int(seconds / timestep)):
        mujoco.mj_step(model, data)
        if not np.abs(data.qvel).max() < 1e6:
            return np.inf
        tilt = max(tilt, 2.0 * float(np.hypot(data.qpos[4], data.qpos[5])))
    return tilt


@pytest.mark.parametrize("timestep", [0.001, 0.0025])
def test_a_robot_stands_on_its_servos(timestep, tmp_path):
    spec, _ = small(tmp_path, timestep=timestep)
    assert standing_tilt(spec, timestep) < 0.01


@pytest.mark.parametrize("floor", [True, False])
def test_a_robot_with_light_feet_stands_only_with_the_armature_floor(floor, tmp_path, monkeypatch):
    # No joint states a speed, so that no damping of the joints hides the instability.
    element = SmallUrdf().element()
    for side in "lr":
        for name in (f"{side}_foot", f"{side}_ankle_roll_link"):
            inertial = link(element, name).find("inertial")
            inertial.find("mass").set("value", "0.02")
            inertial.find("inertia").attrib.update(ixx="1e-5", iyy="1e-5", izz="1e-5")
    monkeypatch.setattr(servos, "MIN_SUBSTEPS", 1)
    if not floor:
        monkeypatch.setattr(servos, "armature_floor", lambda *_: 0.0)
    spec, _ = small(tmp_path, element, timestep=0.005, speed={})
    assert (standing_tilt(spec, 0.005) < 0.01) is floor


def test_a_robot_with_soft_legs_falls(tmp_path):
    spec, _ = small(tmp_path, servo={"compliance": 10.0})
    assert standing_tilt(spec, seconds=4.0) > 1.0


@pytest.mark.parametrize("actuator", ["motor", "position"])
def test_actuators_of_a_file_are_replaced(actuator):
    robot = SmallHumanoid(actuator=actuator)
    description = robot_parts.described(robot, servo="rule")
    read = robot_parts.raw(robot, description)
    limits = own_efforts(read.model)
    assert len(limits) == read.model.nu
    spec, _ = with_servos(read, description)
    model = spec.compile()
    hinges = [j for j in range(model.njnt) if model.jnt_type[j] == 3]
    assert sorted(model.actuator_trnid[:, 0].tolist()) == hinges
    assert (model.actuator_biasprm[:, 1] == -model.actuator_gainprm[:, 0]).all()
    for name, limit in limits.items():
        assert float(model.actuator(name).forcerange[1]) == pytest.approx(limit)


def test_the_effort_of_a_joint_is_its_tightest_bound():
    """Actuators of one joint add up; of limits that differ by direction the smaller counts."""
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body><joint name="a" actuatorfrcrange="-9 9"/><geom size=".1"/>
        <body><joint name="b"/><geom size=".1"/><body><joint name="c"/><geom size=".1"/>
        <body><joint name="d"/><geom size=".1"/></body></body></body></body></worldbody>
        <actuator><motor joint="a" gear="50" ctrlrange="-1 1"/>
        <motor joint="b" gear="50" ctrlrange="-1 1"/><motor joint="c"/>
        <position joint="d" forcerange="-3 5"/><motor jointinparent="d" forcerange="-2 2"/>
        </actuator></mujoco>"""
    )
    assert own_efforts(model) == {"a": 9.0, "b": 50.0, "d": 5.0}
