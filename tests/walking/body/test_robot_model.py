"""Robot model read from MJCF."""

import re
from math import pi
from pathlib import Path

import numpy as np
import pytest

from walking.body.joints import HEAD, JOINT_NAMES
from walking.body.robot_model import R_HC, RobotModel

MODEL = Path(__file__).resolve().parents[3] / "models" / "hsr8" / "hsr8.xml"
BROKEN = """<mujoco><worldbody><body name="base_link"><freejoint name="root"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>"""


def test_ready_posture_is_inside_the_limits(robot):
    assert robot.ready.shape == (len(JOINT_NAMES),)
    assert (robot.ready >= robot.lower).all()
    assert (robot.ready <= robot.upper).all()


def test_feet_stand_level_under_the_hips_in_the_ready_posture(robot):
    for side, frame in ((0, "l_foot"), (1, "r_foot")):
        R, p = robot.frame_pose(frame, robot.ready)
        np.testing.assert_allclose(R[:, 2], [0.0, 0.0, 1.0], atol=1e-4)
        assert p[0] == pytest.approx(robot.legs[side].hip_x, abs=1e-3)


def test_sole_is_tiled_by_its_pads(robot):
    corners = [robot.frame_pose(f"l_sole_{pad}", robot.ready)[1] for pad in ("fl", "br")]
    foot = robot.frame_pose("l_foot", robot.ready)[1]
    centre = 0.5 * (corners[0] + corners[1]) - foot
    assert robot.sole.centre == pytest.approx(centre[0], abs=1e-5)
    assert robot.sole.half_length == pytest.approx(corners[0][0] - corners[1][0], abs=1e-5)


def test_servo_gains_come_from_the_file(robot):
    assert (robot.stiffness > 0.0).all()
    assert robot.stiffness[0] > robot.stiffness[HEAD].max()
    assert (robot.damping > 0.0).all()


def test_torque_at_rest_is_the_gradient_of_the_potential_energy(robot):
    q, rest = robot.ready, np.zeros(len(JOINT_NAMES))
    torque, wrench = robot.inverse_dynamics(q, rest, rest, (0.0, 0.0))
    assert wrench[2] == pytest.approx(robot.mass * 9.81)
    for joint in range(len(JOINT_NAMES)):
        step = np.zeros_like(q)
        step[joint] = 1e-6
        rise = robot.com(q + step)[2] - robot.com(q - step)[2]
        assert torque[joint] == pytest.approx(robot.mass * 9.81 * rise / 2e-6, abs=1e-5)


def test_an_accelerating_joint_asks_for_more_than_its_armature(robot):
    rest = np.zeros(len(JOINT_NAMES))
    push = rest.copy()
    push[2] = 10.0
    still, _ = robot.inverse_dynamics(robot.ready, rest, rest, (0.0, 0.0))
    moved, _ = robot.inverse_dynamics(robot.ready, rest, push, (0.0, 0.0))
    assert moved[2] - still[2] > 10.0 * 0.005
    assert moved[8] == pytest.approx(still[8])


def test_camera_looks_where_the_head_points(robot):
    q = robot.ready.copy()
    q[HEAD] = 0.5 * pi, 0.0
    R, _ = robot.camera_pose(q)
    np.testing.assert_allclose(R[:, 2], [0.0, 1.0, 0.0], atol=1e-9)
    q[HEAD] = 0.0, 0.3
    R, _ = robot.camera_pose(q)
    np.testing.assert_allclose(R[:, 2], [np.cos(0.3), 0.0, np.sin(0.3)], atol=1e-9)
    assert R[2, 1] < 0.0
    assert np.linalg.det(R) == pytest.approx(1.0)


def test_the_camera_is_where_pinocchio_has_it(robot):
    for q in np.random.default_rng(1).uniform(-1.2, 1.2, (20, 26)):
        R, p = robot.frame_pose("camera", q)
        R_BC, p_BC = robot.camera_pose(q)
        np.testing.assert_allclose(R_BC, R @ R_HC, atol=1e-15)
        np.testing.assert_allclose(p_BC, p, atol=1e-15)


def test_a_head_that_looks_elsewhere_is_refused(tmp_path):
    text = MODEL.read_text(encoding="utf-8")
    tilt = re.search(r'<joint name="head_tilt"[^>]*>', text).group()
    turned = tilt.replace('axis="0 -1 0"', 'axis="0 1 0"')
    assert turned != tilt
    path = tmp_path / "down.xml"
    path.write_text(text.replace(tilt, turned), encoding="utf-8")
    with pytest.raises(ValueError, match="unsupported axes of the head"):
        RobotModel.from_mjcf(path)


def test_a_file_without_the_joints_is_refused(tmp_path):
    path = tmp_path / "broken.xml"
    path.write_text(BROKEN, encoding="utf-8")
    with pytest.raises(ValueError, match="no position servo for l_hip_yaw"):
        RobotModel.from_mjcf(path)


def test_an_unknown_frame_is_refused(robot):
    with pytest.raises(ValueError, match="'tail'"):
        robot.frame_pose("tail", robot.ready)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<body name="l_knee_link" pos="0 0 -0.105">', 'pos="0.02 0 -0.105">', "axes of leg 'l'"),
        ('<site name="r_sole_fl" class="pad" pos="0.03625', 'pos="0.05', "soles .* differ"),
    ],
)
def test_a_robot_of_another_build_is_refused(tmp_path, old, new, message):
    text = MODEL.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "other.xml"
    path.write_text(text.replace(old, old[: old.index("pos=")] + new), encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        RobotModel.from_mjcf(path)


def test_servos_saved_by_mujoco_are_understood(tmp_path, robot):
    general = re.sub(
        r'<position kp="([\d.]+)" kv="([\d.]+)"([^/]*)inheritrange="1"/>',
        r'<general gainprm="\1" biastype="affine" biasprm="0 -\1 -\2"\3/>',
        MODEL.read_text(encoding="utf-8"),
    ).replace("<position ", "<general ")
    assert "<position" not in general
    path = tmp_path / "saved.xml"
    path.write_text(general, encoding="utf-8")
    saved = RobotModel.from_mjcf(path)
    np.testing.assert_array_equal(saved.stiffness, robot.stiffness)
    np.testing.assert_array_equal(saved.damping, robot.damping)


@pytest.mark.parametrize("bias", ["", 'biasprm="0"', 'biasprm="0 0 -1"'])
def test_an_affine_actuator_without_stiffness_is_no_position_servo(tmp_path, bias):
    text = MODEL.read_text(encoding="utf-8")
    servo = re.search(r'<position [^>]*joint="l_knee"[^>]*/>', text).group()
    path = tmp_path / "limp.xml"
    limp = f'<general biastype="affine" {bias} joint="l_knee"/>'
    path.write_text(text.replace(servo, limp), encoding="utf-8")
    with pytest.raises(ValueError, match="no position servo for l_knee"):
        RobotModel.from_mjcf(path)


def test_the_pendulum_is_lower_than_the_mass_centre_because_the_feet_stay(robot):
    trunk = robot.com(robot.ready)[2] + 5.0 / 6.0 * robot.legs[0].length
    assert 0.8 * trunk < robot.pendulum_height() < trunk


def test_the_centre_of_mass_is_that_of_the_motion(robot):
    q = robot.ready + 0.1 * np.sin(np.arange(26.0))
    robot.inverse_dynamics(q, 0.5 * q, q, (0.3, 0.1))
    moved = robot.moved_com()
    assert moved == pytest.approx(robot.com(q)[:2], abs=1e-12)
