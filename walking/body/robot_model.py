"""Robot model: kinematics, dynamics and measures of a robot for the walking engine."""

from __future__ import annotations

from copy import copy
from math import asin, atan2, sqrt
from typing import cast

import numpy as np
import pinocchio as pin

from compilation.record import Records
from walking.body import kinematics
from walking.body.kinematics import FootPose, Leg
from walking.body.tree import LEFT_LEG, RIGHT_LEG, Frame, RobotTree
from walking.dimension import HSR_VIII, RobotMeasures, scale_parameters
from walking.model import Link, NeckRecord, Sole
from walking.parameters import GRAVITY, WalkingParameters
from walking.plane import Array, Point, clamp, within


class Neck:
    """Camera on two head joints in either order, or fixed to the trunk.

    Pan and tilt are the direction of the optical axis in the base frame: left and up positive.

    Args:
        tree: the robot.
    """

    def __init__(self, tree: RobotTree) -> None:
        self._lower, self._upper = tree.lower, tree.upper
        self._head = tree.head
        self._tilt_first = tree.head is not None and tree.carries(tree.head[1], tree.head[0])
        order = tree.head or ()
        moving = list(order[::-1] if self._tilt_first else order)
        self._chain, self._moving = tree.chain(moving, tree.camera), np.array(moving, np.int64)
        rest = tree.posture.copy()
        rest[moving] = 0.0
        axes, origins = np.zeros((2, 3)), np.zeros((2, 3))
        kinematics.chain_pose(self._chain, rest[moving], axes, origins)
        pan, tilt = axes[::-1] if self._tilt_first else axes
        self._signs = float(np.sign(pan[2])), -float(np.sign(tilt[1]))
        self._rest = self.angles(rest)  # of the optical axis with the head joints at zero

    def angles(self, joint_position: Array) -> Point:
        """Return pan and tilt for joint angles (n,) [rad]."""
        axes, origins = np.empty((2, 3)), np.empty((2, 3))
        R, _ = kinematics.chain_pose(self._chain, joint_position[self._moving], axes, origins)
        return atan2(R[5], R[2]), asin(clamp(R[8], 1.0))

    def range(self) -> Array:
        """Return lower and upper limit of pan and tilt (2, 2) [rad]."""
        if self._head is None:
            return np.column_stack([self._rest, self._rest])
        joints = list(self._head)
        ends = np.array([self._lower[joints], self._upper[joints]]) * self._signs + self._rest
        return np.sort(ends, axis=0).T

    def describe(self, record: NeckRecord) -> None:
        """Set the record of the neck."""
        record.movable, record.tilt_first = self._head is not None, self._tilt_first
        joints = self._head or (-1, -1)
        axes = (record.pan, record.tilt)
        values = zip(axes, joints, self._signs, self._rest, self.range(), strict=True)
        for axis, joint, sign, rest, (lower, upper) in values:
            axis.joint, axis.sign, axis.rest = joint, sign, rest
            axis.lower, axis.upper = float(lower), float(upper)


MAX_COMPLIANCE, MAX_STIFFENING = 0.9, 3.0  # of an ankle, see `_stiffen` [1]
ANKLE_USED = 0.9  # of the torque of an ankle that shifts the ZMP [1]
BENT = 5.0 / 6.0  # walking height of the hips per length of the leg [1]
SMALL = 1e-5  # step of finite differences [m]
BASE = "base"


class Dynamics:
    """Dynamic model with separate buffers, so that engines of the same robot share nothing.

    Args:
        model: model of Pinocchio.

    Attributes:
        q, v, a: position, velocity and acceleration of level base and joints in the order of
            Pinocchio, input of `forces`.
    """

    def __init__(self, model: pin.Model) -> None:
        self._model, self._data = model, model.createData()
        self.q, self.v, self.a = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)

    def forces(self) -> Array:
        """Return the generalised forces of the motion without contact, those of the base first."""
        forces: Array = pin.rnea(self._model, self._data, self.q, self.v, self.a)
        return forces


class RobotModel:
    """Kinematics and dynamics of a robot.

    Args:
        tree: the robot.

    Attributes:
        tree: the robot.
        names: names of the joints (n,).
        mass: total mass [kg].
        legs: left and right leg.
        links, order: links and their order, see `RobotTree.links` (n + 1,), (n, 2).
        neck: pan and tilt of the camera.
        sole: rectangle of each sole.
        support: part of it that the ankles can press on the floor.
        ready: joint angles of the ready posture; at first that of the parameters of HSR-VIII scaled
            to this robot, see `stand` (n,) [rad].
        indices: indices of the joints in position and velocity of the dynamic model (n,).
        lower, upper: joint limits (n,) [rad].
        dynamics: dynamics of the robot; see `with_own_buffers`.
        stiffness: stiffness of each servo, stiffened in the legs (n,) [N m/rad].
        stiffening: stiffening of the servos of soft legs by feedback of the joint angles, see
            `_stiffen` [1].
        damping: damping of each servo and its joint (n,) [N m s/rad].
    """

    def __init__(self, tree: RobotTree) -> None:
        self.tree = tree
        self.names = tree.names
        self._model = dynamic_model(tree)
        ids = [self._model.getJointId(name) for name in tree.names]
        self.indices = (
            np.array([self._model.joints[i].idx_q for i in ids]),
            np.array([self._model.joints[i].idx_v for i in ids]),
        )
        self.dynamics = Dynamics(self._model)
        self.mass = float(tree.masses.sum())
        links, self.order = tree.links()
        self.links = cast("Records[Link]", links.view(Link).reshape(-1))
        self.legs = (
            Leg.of(tree.chain(list(range(6)), tree.feet[0]), tree.posture[LEFT_LEG]),
            Leg.of(tree.chain(list(range(6, 12)), tree.feet[1]), tree.posture[RIGHT_LEG]),
        )
        self.neck = Neck(tree)
        self.sole = tree.sole
        self.support = self._support()
        self.ready = tree.posture
        self.lower, self.upper = tree.lower, tree.upper
        self.stiffness = tree.stiffness.copy()
        self.damping: Array = tree.servo_damping + tree.joint_damping
        self.stiffening = self._stiffen()
        walk = scale_parameters(WalkingParameters(), HSR_VIII, self.measures())
        self.stand(walk.pattern.pelvis_height, walk.gait.half_stance)

    def stand(self, height: float, half_stance: float) -> float:
        """Set the ready posture: level feet below the centre of mass, legs bent.

        Args:
            height: height of the hips above the floor [m].
            half_stance: foot to the middle of the stance [m].

        Returns:
            remaining error of the legs; above 1e-9 the posture is out of reach [rad].
        """
        base, error = height - self.legs[0].hip[2], 0.0
        self.ready = self.tree.posture.copy()
        for _ in range(12):  # the legs carry a part of the mass
            ahead = float(self.com(self.ready)[0]) - self.support.centre
            for leg, part, y in zip(
                self.legs, (LEFT_LEG, RIGHT_LEG), (half_stance, -half_stance), strict=True
            ):
                self.ready[part], error = leg.angles(FootPose(ahead, y, -base))
        return error

    def _support(self) -> Sole:
        """Return the part of the sole for the ZMP: all of it, if the ankles are strong enough."""
        leg = self.legs[0]
        reach = ANKLE_USED * self.tree.effort[:6] / (self.mass * GRAVITY)
        pitch = leg.pitching[2]
        roll = next(k for k in range(leg.ankle, 6) if k != pitch)
        return self.sole.pressed(float(reach[pitch]), float(reach[roll]))

    def _stiffen(self) -> float:
        """Stiffen soft legs and return the factor [1].

        An ankle softer than the weight of the robot cannot hold it upright. Setpoints moved away
        from the measured angle, s (setpoint - angle) + angle, make a servo s times as stiff.
        """
        soft = self.measures().ankle
        factor = within(soft / MAX_COMPLIANCE, 1.0, MAX_STIFFENING)
        self.stiffness[: RIGHT_LEG.stop] *= factor
        return factor

    def with_own_buffers(self) -> RobotModel:
        """Return the same robot with separate buffers for its dynamics.

        Several engines of one robot then run in turn or in threads without affecting each other.
        """
        robot = copy(self)
        robot.dynamics = Dynamics(self._model)
        return robot

    def com(self, joint_position: Array) -> Array:
        """Return the centre of mass in the base frame (3,) [m] for joint angles (n,) [rad]."""
        poses = np.empty((len(self.links), 12))
        return np.array(kinematics.tree_pass(self.links, self.order, joint_position, poses))

    def inverse_dynamics(
        self,
        position: Array,
        velocity: Array,
        acceleration: Array,
        base_acceleration: tuple[float, float],
    ) -> tuple[Array, Array]:
        """Return the forces of a motion of joints and base without contact (inverse dynamics).

        Args:
            position: joint angles (n,) [rad].
            velocity: joint rates (n,) [rad/s].
            acceleration: accelerations of the joints (n,) [rad/s²].
            base_acceleration: acceleration of the level base, forward and left [m/s²].

        Returns:
            torque of each joint, gravity included (n,) [N m]; force [N] and moment [N m] at the
            base, in its frame and about its origin (6,).
        """
        motion, (in_q, in_v) = self.dynamics, self.indices
        motion.q[in_q] = position
        motion.v[in_v] = velocity
        motion.a[in_v] = acceleration
        motion.a[:2] = base_acceleration
        forces = motion.forces()
        joints: Array = forces[in_v]
        base: Array = forces[:6].copy()
        return joints, base

    def pendulum_height(self) -> float:
        """Return the height of the equivalent pendulum [m].

        With bent knees and both feet on the floor, the legs follow an acceleration a of the base in
        part; the moment about the floor is that of the whole mass at this height accelerated by a.
        """
        q = self.ready.copy()
        rest, motion = np.zeros_like(q), np.zeros_like(q)
        height = 0.0
        for leg, part in zip(self.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
            x, y, _ = leg.foot
            height = BENT * leg.length - leg.hip[2]
            q[part] = leg.angles(FootPose(x, y, -height))[0]
            ahead, behind = (leg.angles(FootPose(x + dx, y, -height))[0] for dx in (-SMALL, SMALL))
            motion[part] = (ahead - behind) / (2.0 * SMALL)
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
        stiffness = float(self.stiffness[leg.ankle : 6].mean())
        exact = (
            leg.length,
            0.5 * (leg.foot[1] - self.legs[1].foot[1]),
            self.sole.half_width,
            sqrt(height / GRAVITY),
            weight,
            weight * height / stiffness,
        )
        return RobotMeasures(*(float(f"{measure:.6g}") for measure in exact))

    def on_link(self, frame: Frame) -> Array:
        """Return rotation, row by row, and position of a frame on its link (12,) [m]."""
        return np.array([*frame.rotation.ravel(), *frame.position])

    def frame_pose(self, frame: Frame, joint_position: Array) -> tuple[Array, Array]:
        """Return rotation (3, 3) and position (3,) [m] of a frame in the base frame."""
        poses = np.empty((len(self.links), 12))
        kinematics.tree_pass(self.links, self.order, joint_position, poses)
        pose = np.empty(12)
        kinematics.frame_pose(pose, poses[frame.joint], self.on_link(frame))
        return pose[:9].reshape(3, 3), pose[9:]

    def leg_groups(self) -> dict[str, tuple[int, ...]]:
        """Return the indices of hip, knee and ankle joints within a leg, for people."""
        knee = self.legs[0].pitching[1]
        return {"hip": tuple(range(knee)), "knee": (knee,), "ankle": tuple(range(knee + 1, 6))}

    def shoulder_signs(self) -> Point:
        """Return the signs of the shoulder joints: 1 where a positive angle swings backward [1]."""
        if self.tree.shoulders is None:
            return 0.0, 0.0
        first, second = (float(np.sign(self._axis(joint)[1])) for joint in self.tree.shoulders)
        return first, second

    def _axis(self, joint: int) -> Array:
        """Return the axis of a joint in the base frame, in the posture of the tree (3,)."""
        tree = self.tree
        frame = Frame(joint, np.eye(3), np.zeros(3))
        axis: Array = self.frame_pose(frame, tree.posture)[0] @ tree.axes[joint]
        return axis


def dynamic_model(tree: RobotTree) -> pin.Model:
    """Return the Pinocchio model of a robot with a free base."""
    model = pin.Model()
    root = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), BASE)
    ids: dict[int, int] = {-1: root}

    def add_children(parent: int) -> None:
        for joint in np.flatnonzero(tree.parents == parent).tolist():
            placement = pin.SE3(np.eye(3), tree.positions[joint])
            revolute = pin.JointModelRevoluteUnaligned(tree.axes[joint])
            ids[joint] = model.addJoint(ids[parent], revolute, placement, tree.names[joint])
            add_children(joint)

    add_children(-1)  # Pinocchio expects depth-first order
    for body, mass, inertia in zip(tree.bodies, tree.masses, tree.inertias, strict=True):
        own = pin.Inertia(float(mass), np.zeros(3), np.diag(inertia))
        model.appendBodyToJoint(ids[body.joint], own, pin.SE3(body.rotation, body.position))
    return model
