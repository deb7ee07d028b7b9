"""The robot's numbers, read by Pinocchio from the same MJCF file as the simulator."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from walking.joints import HEAD, JOINT_NAMES
from walking.leg_kinematics import LegDimensions

Array = NDArray[np.float64]

READY = "walk_ready"
# Columns are the camera's right, down and forward in the frame of the head, which looks along x.
R_HC = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


@dataclass(frozen=True, slots=True)
class Sole:
    """Rectangle of a sole in the foot frame.

    Attributes:
        centre: middle of the sole ahead of the ankle [m].
        half_length: half of its length [m].
        half_width: half of its width [m].
    """

    centre: float
    half_length: float
    half_width: float


class RobotModel:
    """Dimensions, masses, limits and kinematics of the robot.

    Args:
        model: Pinocchio model with a free root and the joints of ``JOINT_NAMES``.
        stiffness: of each servo (26,) [N m/rad].
        servo_damping: of each servo (26,) [N m s/rad].

    Attributes:
        mass: total mass [kg].
        legs: dimensions of the left and of the right leg.
        sole: rectangle of either sole.
        ready: joint angles of the ready posture (26,) [rad].
        lower, upper: joint limits (26,) [rad].
        stiffness: of each servo (26,) [N m/rad].
        damping: of each servo with its joint (26,) [N m s/rad].

    Raises:
        ValueError: a joint, frame or the ready posture is missing.
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
        self._v, self._a = np.zeros(model.nv), np.zeros(model.nv)
        self._camera = self._frame("camera")
        self.mass = float(sum(inertia.mass for inertia in model.inertias))
        self.legs = (self._leg("l"), self._leg("r"))
        self.sole = self._sole()
        reference = {e.key(): np.array(e.data()) for e in model.referenceConfigurations}
        if READY not in reference:
            raise ValueError(f"the robot model lacks the keyframe {READY!r}")
        self.ready: Array = reference[READY][self._q_index]
        self.lower: Array = np.array(model.lowerPositionLimit)[self._q_index]
        self.upper: Array = np.array(model.upperPositionLimit)[self._q_index]
        self.stiffness = stiffness
        self.damping: Array = servo_damping + np.array(model.damping)[self._v_index]

    @classmethod
    def from_mjcf(cls, path: str | PathLike[str]) -> RobotModel:
        """Read a robot from an MJCF file.

        Raises:
            ValueError: something the library needs is missing in the file.
        """
        model = pin.buildModelFromMJCF(fspath(path))
        gains = _servo_gains(fspath(path))
        missing = [name for name in JOINT_NAMES if name not in gains]
        if missing:
            raise ValueError(f"{fspath(path)} has no position servo for {', '.join(missing)}")
        ordered = np.array([gains[name] for name in JOINT_NAMES])
        return cls(model, ordered[:, 0], ordered[:, 1])

    def com(self, joint_position: Array) -> tuple[float, float, float]:
        """Centre of mass in the base frame [m] for joint angles (26,) [rad]."""
        q = self._q
        q[self._q_index] = joint_position
        x, y, z = pin.centerOfMass(self._model, self._data, q, False).tolist()
        return x, y, z

    def joint_torque(
        self,
        position: Array,
        velocity: Array,
        acceleration: Array,
        base_acceleration: tuple[float, float],
    ) -> Array:
        """Torque that a motion of the joints asks of them, nothing touching the feet.

        Args:
            position: joint angles (26,) [rad].
            velocity: their rates (26,) [rad/s].
            acceleration: their accelerations (26,) [rad/s²].
            base_acceleration: of the level base, forward and left [m/s²].

        Returns:
            torque of each joint, gravity included (26,) [N m].
        """
        self._q[self._q_index] = position
        self._v[self._v_index] = velocity
        self._a[self._v_index] = acceleration
        self._a[0], self._a[1] = base_acceleration
        torque = pin.rnea(self._model, self._data, self._q, self._v, self._a)
        asked: Array = torque[self._v_index]
        return asked

    def camera_pose(self, joint_position: Array) -> tuple[Array, Array]:
        """Rotation R_BC (3, 3) and position p_BC (3,) [m] of the head camera."""
        q = self._q
        q[self._q_index] = joint_position
        pin.forwardKinematics(self._model, self._data, q)
        placement = pin.updateFramePlacement(self._model, self._data, self._camera)
        return placement.rotation @ R_HC, placement.translation.copy()

    def frame_pose(self, name: str, joint_position: Array) -> tuple[Array, Array]:
        """Rotation (3, 3) and position (3,) [m] of a named frame in the base frame.

        Raises:
            ValueError: there is no such frame.
        """
        q = self._q
        q[self._q_index] = joint_position
        pin.forwardKinematics(self._model, self._data, q)
        placement = pin.updateFramePlacement(self._model, self._data, self._frame(name))
        return placement.rotation.copy(), placement.translation.copy()

    def head_limits(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Lower and upper limit of pan and of tilt [rad]."""
        (pan_low, tilt_low), (pan_high, tilt_high) = (
            self.lower[HEAD].tolist(),
            self.upper[HEAD].tolist(),
        )
        return (pan_low, pan_high), (tilt_low, tilt_high)

    def _frame(self, name: str) -> int:
        if not self._model.existFrame(name):
            raise ValueError(f"the robot model lacks the frame {name!r}")
        return int(self._model.getFrameId(name))

    def _placement(self, joint: str) -> list[float]:
        place: list[float] = self._model.jointPlacements[
            self._model.getJointId(joint)
        ].translation.tolist()
        return place

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

    def _sole(self) -> Sole:
        # The four pads tile the sole, so their centres lie at its quarter points.
        pads = [
            self._model.frames[self._frame(f"l_sole_{pad}")].placement.translation.tolist()
            for pad in ("fl", "fr", "bl", "br")
        ]
        return Sole(
            centre=0.5 * (pads[0][0] + pads[2][0]),
            half_length=pads[0][0] - pads[2][0],
            half_width=pads[0][1] - pads[1][1],
        )


def _servo_gains(path: str) -> dict[str, tuple[float, float]]:
    """Stiffness and damping of every position servo, by joint; Pinocchio does not read them."""
    root = ElementTree.parse(path).getroot()
    defaults: dict[str, dict[str, str]] = {}

    def collect(element: ElementTree.Element, inherited: dict[str, str]) -> None:
        own = element.find("position")
        values = {**inherited, **(own.attrib if own is not None else {})}
        defaults[element.get("class", "main")] = values
        for child in element.findall("default"):
            collect(child, values)

    for element in root.findall("default"):
        collect(element, {})
    gains = {}
    for servo in root.iterfind("actuator/position"):
        values = {**defaults.get(servo.get("class", "main"), {}), **servo.attrib}
        gains[values["joint"]] = (float(values.get("kp", "1")), float(values.get("kv", "0")))
    return gains
