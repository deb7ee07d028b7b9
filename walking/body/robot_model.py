"""Robot model, read by Pinocchio from the MJCF file of the simulator."""

from __future__ import annotations

from math import asin, atan2, sqrt
from os import PathLike, fspath
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from walking.arrays import Array
from walking.body import head_kernel
from walking.body.joints import HEAD, HEAD_JOINTS, JOINT_NAMES, LEFT_LEG, RIGHT_LEG
from walking.body.leg_kinematics import FootPose, LegDimensions, foot_pose, leg_angles
from walking.body.sole import Sole
from walking.parameters import GRAVITY
from walking.robot_measures import RobotMeasures

READY = "walk_ready"
BENT = 5.0 / 6.0  # walking height of the hips per length of the leg [1]
SMALL = 1e-5  # step of finite differences [m]
SERVOS = ("position", "general")  # MJCF elements of position servos
TOLERANCE = 1e-5  # rounding error of a pose [m, rad]
# Columns are the right, down and forward axes of the camera in the head frame.
R_HC = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


class RobotModel:
    """Dimensions, masses, limits and kinematics of the robot.

    Args:
        model: Pinocchio model with a free root and the joints of ``JOINT_NAMES``.
        stiffness: of each servo (26,) [N m/rad].
        servo_damping: of each servo (26,) [N m s/rad].

    Attributes:
        mass: total mass [kg].
        legs: dimensions of the left and of the right leg.
        leg_rows: dimensions of the legs for kernels (2, 6).
        sole: rectangle of each sole.
        ready: joint angles of the ready posture (26,) [rad].
        motion: position, velocity and acceleration of level base and joints in Pinocchio's order,
            input of `forces`.
        indices: of the joints in that position and velocity (26,).
        lower, upper: joint limits (26,) [rad].
        stiffness: of each servo (26,) [N m/rad].
        damping: of each servo and its joint (26,) [N m s/rad].

    Raises:
        ValueError: a joint, frame or the ready posture is missing, the soles differ, or the axes of
            a leg or the head differ from `leg_kinematics` or `head_kernel`.
    """

    def __init__(self, model: Any, stiffness: Array, servo_damping: Array) -> None:
        missing = [name for name in JOINT_NAMES if not model.existJointName(name)]
        if missing:
            raise ValueError(f"the robot model lacks the joints {', '.join(missing)}")
        self._model = model
        self._data = model.createData()
        ids = [model.getJointId(name) for name in JOINT_NAMES]
        self._q_index = np.array([model.joints[i].idx_q for i in ids])
        self._v_index = np.array([model.joints[i].idx_v for i in ids])
        self._q = pin.neutral(model)
        self.motion = self._q, np.zeros(model.nv), np.zeros(model.nv)
        self.indices = self._q_index, self._v_index
        camera = model.frames[self._frame("camera")].placement
        origins = [*map(self._placement, HEAD_JOINTS), camera.translation.tolist()]
        self._head = np.array(origins), camera.rotation @ R_HC
        self.mass = float(sum(inertia.mass for inertia in model.inertias))
        self.legs = (self._leg("l"), self._leg("r"))
        self.leg_rows = np.array([leg.row for leg in self.legs])
        self.sole, right = self._sole("l"), self._sole("r")
        if self.sole != right:
            raise ValueError(f"the soles of the robot model differ: {self.sole} and {right}")
        reference = {e.key(): np.array(e.data()) for e in model.referenceConfigurations}
        if READY not in reference:
            raise ValueError(f"the robot model lacks the keyframe {READY!r}")
        self.ready: Array = reference[READY][self._q_index]
        self.lower: Array = np.array(model.lowerPositionLimit)[self._q_index]
        self.upper: Array = np.array(model.upperPositionLimit)[self._q_index]
        self.stiffness = stiffness
        self.damping: Array = servo_damping + np.array(model.damping)[self._v_index]
        self._check_legs()
        self._check_head()

    @classmethod
    def from_mjcf(cls, path: str | PathLike[str]) -> RobotModel:
        """Read a robot from an MJCF file.

        The file must contain the joints of ``JOINT_NAMES``, each with a position servo; sites
        ``l_foot`` and ``r_foot`` on the floor below the ankles, ``l_sole_fl`` … ``r_sole_br`` in
        the middle of each quarter of a sole, and ``camera``; and the keyframe ``walk_ready``.

        Raises:
            ValueError: a required element is missing in the file.
        """
        model = pin.buildModelFromMJCF(fspath(path))
        gains = _servo_gains(fspath(path))
        missing = [name for name in JOINT_NAMES if name not in gains]
        if missing:
            raise ValueError(f"{fspath(path)} has no position servo for {', '.join(missing)}")
        ordered = np.array([gains[name] for name in JOINT_NAMES])
        return cls(model, ordered[:, 0], ordered[:, 1])

    def com(self, joint_position: Array) -> Array:
        """Return the centre of mass in the base frame (3,) [m] for joint angles (26,) [rad]."""
        q = self._q
        q[self._q_index] = joint_position
        com: Array = pin.centerOfMass(self._model, self._data, q, False)
        return com

    def inverse_dynamics(
        self,
        position: Array,
        velocity: Array,
        acceleration: Array,
        base_acceleration: tuple[float, float],
    ) -> tuple[Array, Array]:
        """Return the forces of a motion of joints and base without contact (inverse dynamics).

        Args:
            position: joint angles (26,) [rad].
            velocity: joint rates (26,) [rad/s].
            acceleration: of the joints (26,) [rad/s²].
            base_acceleration: of the level base, forward and left [m/s²].

        Returns:
            torque of each joint, gravity included (26,) [N m]; force [N] and moment [N m] at the
            base, in its frame and about its origin (6,).
        """
        q, v, a = self.motion
        q[self._q_index] = position
        v[self._v_index] = velocity
        a[self._v_index] = acceleration
        a[0], a[1] = base_acceleration
        forces = self.forces()
        joints: Array = forces[self._v_index]
        base: Array = forces[:6].copy()
        return joints, base

    def forces(self) -> Array:
        """Return the generalised forces of `motion` without contact, those of the base first."""
        forces: Array = pin.rnea(self._model, self._data, *self.motion)
        return forces

    def moved_com(self) -> tuple[float, float]:
        """Return the centre of mass in the base frame, x, y [m], in the last call of `forces`."""
        x, y, _ = pin.centerOfMass(self._model, self._data, pin.POSITION, False).tolist()
        return x, y

    def pendulum_height(self) -> float:
        """Return the height of the equivalent pendulum [m].

        With bent knees and both feet on the floor, the legs follow an acceleration a of the base in
        part; the moment about the floor is that of the whole mass at this height accelerated by a.
        """
        q = self.ready.copy()
        rest, motion = np.zeros_like(q), np.zeros_like(q)
        for leg, part in zip(self.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
            height = BENT * leg.length - leg.hip_z
            foot = FootPose(leg.hip_x, leg.hip_y, -height, 0.0, 0.0, 0.0)
            q[part] = leg_angles(leg, foot)[0]
            ahead, behind = (
                leg_angles(leg, FootPose(foot.x + dx, foot.y, foot.z, 0.0, 0.0, 0.0))[0]
                for dx in (-SMALL, SMALL)
            )
            motion[part] = (np.array(ahead) - behind) / (2.0 * SMALL)
        _, still = self.inverse_dynamics(q, rest, rest, (0.0, 0.0))
        _, moved = self.inverse_dynamics(q, rest, motion, (1.0, 0.0))
        force, moment = (moved - still)[[0, 4]].tolist()
        return float((moment + height * force) / self.mass)

    def measures(self) -> RobotMeasures:
        """Return the measures that a walk scales with, to six digits.

        More digits are unknown, and the rounding of a file reader must not change a walk.
        """
        leg, height = self.legs[0], self.pendulum_height()
        weight = self.mass * GRAVITY
        stiffness = 0.5 * float(self.stiffness[4] + self.stiffness[5])
        exact = (
            leg.length,
            0.5 * (leg.hip_y - self.legs[1].hip_y),
            self.sole.half_width,
            sqrt(height / GRAVITY),
            weight,
            weight * height / stiffness,
        )
        return RobotMeasures(*(float(f"{measure:.6g}") for measure in exact))

    def camera_pose(self, joint_position: Array) -> tuple[Array, Array]:
        """Return rotation R_BC (3, 3) and position p_BC (3,) [m] of the head camera."""
        pan, tilt = joint_position[HEAD].tolist()
        rotation, position = np.empty((3, 3)), np.empty(3)
        head_kernel.camera_pose(pan, tilt, *self._head, rotation, position)
        return rotation, position

    def frame_pose(self, name: str, joint_position: Array) -> tuple[Array, Array]:
        """Return rotation (3, 3) and position (3,) [m] of a named frame in the base frame.

        Raises:
            ValueError: the model lacks the frame.
        """
        q = self._q
        q[self._q_index] = joint_position
        pin.forwardKinematics(self._model, self._data, q)
        placement = pin.updateFramePlacement(self._model, self._data, self._frame(name))
        return placement.rotation.copy(), placement.translation.copy()

    def _frame(self, name: str) -> int:
        if not self._model.existFrame(name):
            raise ValueError(f"the robot model lacks the frame {name!r}")
        return int(self._model.getFrameId(name))

    def _placement(self, joint: str) -> list[float]:
        index = self._model.getJointId(joint)
        position: list[float] = self._model.jointPlacements[index].translation.tolist()
        return position

    def _check_legs(self) -> None:
        """Compare the closed form of the legs with the model."""
        q = np.zeros_like(self.ready)
        bend = np.array([0.2, 0.3, -0.5, 0.9, -0.4, 0.1])
        for leg, part, side in zip(self.legs, (LEFT_LEG, RIGHT_LEG), "lr", strict=True):
            q[part] = bend
            a, b, c, d, e, f = bend.tolist()
            foot = foot_pose(leg, (a, b, c, d, e, f))
            R, p = self.frame_pose(f"{side}_foot", q)
            missed = [*(p - (foot.x, foot.y, foot.z)), atan2(R[1, 0], R[0, 0]) - foot.yaw]
            missed += [-asin(R[2, 0]) - foot.pitch, atan2(R[2, 1], R[2, 2]) - foot.roll]
            if max(map(abs, missed)) > TOLERANCE:
                raise ValueError(
                    f"robot model: unsupported axes of leg {side!r}; expected hip yaw, roll and "
                    "pitch through one point, a knee, and ankle pitch and roll through a point "
                    "straight below"
                )

    def _check_head(self) -> None:
        """Compare the closed form of the head with the model."""
        q = np.zeros_like(self.ready)
        q[HEAD] = 0.4, 0.3
        R, p = self.frame_pose("camera", q)
        R_BC, p_BC = self.camera_pose(q)
        if max(abs(R @ R_HC - R_BC).max(), abs(p - p_BC).max()) > TOLERANCE:
            raise ValueError(
                "robot model: unsupported axes of the head; expected a pan joint to the left on "
                "the base, then a tilt joint upwards"
            )

    def _leg(self, side: str) -> LegDimensions:
        hip = self._placement(f"{side}_hip_yaw")
        foot = self._model.frames[self._frame(f"{side}_foot")].placement.translation.tolist()
        return LegDimensions(
            hip_x=hip[0],
            hip_y=hip[1],
            hip_z=hip[2],
            thigh=-self._placement(f"{side}_knee")[2],
            shank=-self._placement(f"{side}_ankle_pitch")[2],
            ankle_height=-foot[2],
        )

    def _sole(self, side: str) -> Sole:
        # The four pads tile the sole, so their centres lie at its quarter points.
        pads = [
            self._model.frames[self._frame(f"{side}_sole_{pad}")].placement.translation.tolist()
            for pad in ("fl", "fr", "bl", "br")
        ]
        return Sole(
            centre=0.5 * (pads[0][0] + pads[2][0]),
            half_length=pads[0][0] - pads[2][0],
            half_width=pads[0][1] - pads[1][1],
        )


def _servo_gains(path: str) -> dict[str, tuple[float, float]]:
    """Read stiffness and damping of every position servo, by joint, which Pinocchio ignores.

    MuJoCo saves a position servo as a general actuator with affine bias; both forms are read.
    """
    root = ElementTree.parse(path).getroot()
    defaults: dict[tuple[str, str], dict[str, str]] = {}

    def collect(element: ElementTree.Element, inherited: dict[str, dict[str, str]]) -> None:
        values = dict(inherited)
        for kind in SERVOS:
            own = element.find(kind)
            values[kind] = {**inherited[kind], **(own.attrib if own is not None else {})}
            defaults[element.get("class", "main"), kind] = values[kind]
        for child in element.findall("default"):
            collect(child, values)

    for element in root.findall("default"):
        collect(element, {kind: {} for kind in SERVOS})
    gains = {}
    for kind in SERVOS:
        for servo in root.iterfind(f"actuator/{kind}"):
            name = servo.get("class", "main")
            values = {**defaults.get((name, kind), {}), **servo.attrib}
            if kind == "position":
                gain = float(values.get("kp", "1")), float(values.get("kv", "0"))
            elif values.get("biastype") == "affine":
                bias = [float(value) for value in values.get("biasprm", "").split()]
                _, stiffness, damping = (*bias, 0.0, 0.0, 0.0)[:3]  # zero by default
                gain = -stiffness, -damping
            else:
                continue
            if "joint" in values and gain[0] > 0.0:
                gains[values["joint"]] = gain
    return gains
