"""Compiled robot in a posture, and its skeleton: the hinge joints as axes in space.

A *group* is a set of bodies that move together with one hinge; the base is the group -1.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.key_mistake import label

Array = NDArray[np.float64]

HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
FREE = int(mujoco.mjtJoint.mjJNT_FREE)
BALL = int(mujoco.mjtJoint.mjJNT_BALL)
MIN_LIMITS = 0.3  # difference of the limits of a knee that shows where it bends [rad]
PARALLEL = 0.9  # minimum cosine of an axis that counts as a yaw or pitch axis [1]
CANTED = 0.5  # the same of the pitch axis of a hip, which may be canted [1]
LEG_JOINTS = 6
LIMIT_MARGIN = 0.02  # distance of a clipped angle from its limit, by the range [1]
BELOW_HIP = 3  # joints of a leg below the hip: knee and ankle


@dataclass(frozen=True, slots=True, eq=False)
class BaseFrame:
    """Frame of the base: x forward, y to the left, z up.

    Attributes:
        rotation: axes of the frame in the body with the free joint, as rows (3, 3).
        origin: origin of the frame in that body (3,) [m].
    """

    rotation: Array
    origin: Array

    @property
    def is_body(self) -> bool:
        """Whether the frame is that of the body."""
        return bool((self.rotation == np.eye(3)).all() and not self.origin.any())


SAME = BaseFrame(np.eye(3), np.zeros(3))
"""Base frame of a robot whose body with the free joint has x forward and z up."""


@dataclass(frozen=True, slots=True, eq=False)
class Posed:
    """Compiled robot in a posture.

    Attributes:
        model: compiled robot.
        data: state of the robot, with all places computed.
    """

    model: mujoco.MjModel
    data: mujoco.MjData

    @classmethod
    def at(
        cls,
        model: mujoco.MjModel,
        angles: Mapping[str, float],
        height: float = 0.0,
        base: BaseFrame = SAME,
    ) -> "Posed":
        """Return a robot with its base level at a height [m] above the origin.

        Args:
            model: compiled robot, its free joint first.
            angles: angles of joints; zero by default [rad].
            height: height of the base [m].
            base: frame of the base.
        """
        data = mujoco.MjData(model)
        data.qpos[:] = 0.0
        data.qpos[2:4] = height, 1.0
        data.qpos[model.jnt_qposadr[model.jnt_type == BALL]] = 1.0
        if not base.is_body:
            data.qpos[3:7] = quaternion_of(base.rotation)
            data.qpos[:3] -= base.rotation @ base.origin
        for name, angle in angles.items():
            data.qpos[model.joint(name).qposadr[0]] = angle
        mujoco.mj_forward(model, data)
        return cls(model, data)

    def box(self, geom: int) -> tuple[Array, Array, Array]:
        """Return centre (3,) [m], axes (3, 3) and half sides (3,) [m] of the box around a geom."""
        rotation, box = self.data.geom_xmat[geom].reshape(3, 3), self.model.geom_aabb[geom]
        return self.data.geom_xpos[geom] + rotation @ box[:3], rotation, box[3:]


@dataclass(frozen=True, slots=True, eq=False)
class Skeleton:
    """Hinge joints in the order parent before child, n of them.

    Attributes:
        root: body that carries the others.
        free: whether it has a free joint.
        joints: names.
        bodies: body that each joint moves.
        parents: index of the joint above; -1 for none.
        axes: unit vectors in the root (n, 3).
        anchors: points on the axes in the root (n, 3) [m].
        ranges: lower and upper limit, infinite without limits (n, 2) [rad].
        masses: masses of each group (n,) [kg].
        coms: centre of mass of each group in the root (n, 3) [m]; the anchor without mass.
        total_mass: mass of all groups and of the root [kg].
        group: index of the group of each body, by name.
        others: names of joints that are neither hinges nor the free joint.
    """

    root: str
    free: bool
    joints: tuple[str, ...]
    bodies: tuple[str, ...]
    parents: tuple[int, ...]
    axes: Array
    anchors: Array
    ranges: Array
    masses: Array
    coms: Array
    total_mass: float
    group: Mapping[str, int]
    others: tuple[str, ...]

    def chain(self, joint: int) -> tuple[int, ...]:
        """Return the joints from the root down to `joint`; none for -1."""
        joints = []
        while joint >= 0:
            joints.append(joint)
            joint = self.parents[joint]
        return tuple(joints[::-1])

    def ends(self) -> tuple[int, ...]:
        """Return the joints that carry no other joint."""
        return tuple(j for j in range(len(self.joints)) if j not in self.parents)

    def mass_below(self, joint: int) -> float:
        """Return the mass that a joint moves [kg]."""
        return float(self.masses[self._below(joint)].sum())

    def com_below(self, joint: int) -> Array:
        """Return the centre of the mass that a joint moves, in the root (3,) [m]."""
        moved = self._below(joint)
        masses = self.masses[moved]
        if not masses.sum():
            anchor: Array = self.anchors[joint].copy()
            return anchor
        com: Array = np.average(self.coms[moved], axis=0, weights=masses)
        return com

    def _below(self, joint: int) -> list[int]:
        return [j for j in range(len(self.joints)) if joint in self.chain(j)]

    def within(self, base: BaseFrame) -> "Skeleton":
        """Return the skeleton in the frame of the base."""
        if base.is_body:
            return self
        return replace(
            self,
            axes=self.axes @ base.rotation.T,
            anchors=(self.anchors - base.origin) @ base.rotation.T,
            coms=(self.coms - base.origin) @ base.rotation.T,
        )

    def is_pitch(self, joint: int) -> bool:
        """Return whether the axis of a joint points to the left or to the right."""
        return bool(abs(self.axes[joint, 1]) > PARALLEL)

    def pitching(self, leg: Sequence[int]) -> list[int]:
        """Return the pitching joints of a leg: hip, knee and ankle, if it has one of each.

        The hip may pitch about a canted axis: the joint counts that is nearest to the left.
        """
        hip = max(leg[:-BELOW_HIP], key=lambda j: abs(self.axes[j, 1]), default=-1)
        canted = hip >= 0 and abs(self.axes[hip, 1]) > CANTED
        return [j for j in leg if (j == hip and canted) or self.is_pitch(j)]

    def range_about_left(self, joint: int) -> tuple[float, float]:
        """Return the range of a pitching joint about the left axis [rad]."""
        lower, upper = self.ranges[joint].tolist()
        return (-upper, -lower) if self.axes[joint, 1] < 0.0 else (lower, upper)

    def bend(self, leg: Sequence[int], zero: float = 0.0) -> int:
        """Return how the range of a knee bends it: 1 forward, -1 backward, 0 both or unknown.

        Args:
            leg: joints of the leg, of which the second that pitches is the knee.
            zero: angle of the straight knee about the left axis [rad].
        """
        knee = self.pitching(leg)[1]
        lower, upper = (limit - zero for limit in self.range_about_left(knee))
        one_sided = isfinite(lower) and isfinite(upper) and abs(lower + upper) > MIN_LIMITS
        return int(np.sign(lower + upper)) if one_sided else 0

    def is_yaw(self, joint: int) -> bool:
        """Return whether the axis of a joint is vertical."""
        return bool(abs(self.axes[joint, 2]) > PARALLEL)


def root_of(model: mujoco.MjModel) -> int:
    """Return the body of the world with most joints: the root of the robot in a model.

    Args:
        model: compiled model, with at least one body.
    """
    joints = np.bincount(model.body_rootid[model.jnt_bodyid], minlength=model.nbody)
    return int(joints[1:].argmax()) + 1 if model.nbody > 1 else 0


def skeleton_of(
    model: mujoco.MjModel, root: int, angles: Mapping[str, float] | None = None
) -> Skeleton:
    """Return the skeleton of the bodies at and below `root`.

    Args:
        model: compiled model.
        root: id of the body.
        angles: angles of joints, by name; default 0 [rad].
    """
    data = mujoco.MjData(model)
    for j in range(model.njnt):
        if model.jnt_type[j] == HINGE:
            data.qpos[model.jnt_qposadr[j]] = (angles or {}).get(model.joint(j).name, 0.0)
    mujoco.mj_kinematics(model, data)
    origin, rotation = data.xpos[root].copy(), data.xmat[root].reshape(3, 3).copy()
    tree = [b for b in range(root, model.nbody) if is_below(model, b, root)]
    hinges: list[int] = []
    parents: list[int] = []
    others: list[str] = []
    group = {root: -1}
    for body in tree:
        last = group[int(model.body_parentid[body])] if body != root else -1
        first = int(model.body_jntadr[body])
        for j in range(first, first + int(model.body_jntnum[body])):
            if model.jnt_type[j] == HINGE:
                parents.append(last)
                hinges.append(j)
                last = len(hinges) - 1
            elif body != root or model.jnt_type[j] != FREE:
                others.append(label(model.joint(j).name, j))
        group[body] = last
    n = len(hinges)
    anchors = (data.xanchor[hinges] - origin) @ rotation
    masses, moments = np.zeros(n), np.zeros((n, 3))
    for body, g in group.items():
        if g >= 0:
            masses[g] += model.body_mass[body]
            moments[g] += model.body_mass[body] * ((data.xipos[body] - origin) @ rotation)
    heavy = masses > 0.0
    coms = anchors.copy()
    coms[heavy] = moments[heavy] / masses[heavy, None]
    limited = model.jnt_limited[hinges].astype(bool)
    joints = model.body_jntadr[root], model.body_jntnum[root]
    return Skeleton(
        root=label(model.body(root).name, root),
        free=any(model.jnt_type[j] == FREE for j in range(joints[0], sum(joints))),
        joints=tuple(label(model.joint(j).name, j) for j in hinges),
        bodies=tuple(label(model.body(b).name, int(b)) for b in model.jnt_bodyid[hinges]),
        parents=tuple(parents),
        axes=data.xaxis[hinges] @ rotation,
        anchors=anchors,
        ranges=np.where(limited[:, None], model.jnt_range[hinges], [[-np.inf, np.inf]]),
        masses=masses,
        coms=coms,
        total_mass=float(model.body_mass[tree].sum()),
        group={label(model.body(b).name, b): g for b, g in group.items()},
        others=tuple(others),
    )


def path_up(model: mujoco.MjModel, body: int) -> list[int]:
    """Return a body and those above it, without the world."""
    path = []
    while body > 0:
        path.append(body)
        body = int(model.body_parentid[body])
    return path


def is_below(model: mujoco.MjModel, body: int, root: int) -> bool:
    """Return whether a body is `root` or below it."""
    while body > root:
        body = int(model.body_parentid[body])
    return body == root


def matrix_of(quaternion: Array) -> Array:
    """Return the rotation (3, 3) of a unit quaternion w-x-y-z (4,)."""
    flat = np.empty(9)
    mujoco.mju_quat2Mat(flat, np.asarray(quaternion, float))
    return flat.reshape(3, 3)


def quaternion_of(rotation: Array) -> Array:
    """Return the unit quaternion w-x-y-z (4,) of a rotation (3, 3)."""
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
    return quaternion


@dataclass(frozen=True, slots=True)
class MirroredPair:
    """Joints of a left and a right chain, and their differences from mirror images.

    Attributes:
        left, right: indices of the joints.
        distance: distance of the right axis from the mirrored anchor of the left one [m].
        angle: angle between the axes, without their direction [rad].
        range: maximum difference of the limits [rad].
        reversed: whether an equal angle of both turns them in opposite directions of the image.
    """

    left: int
    right: int
    distance: float
    angle: float
    range: float
    reversed: bool


def mirrored_pairs(
    skeleton: Skeleton, left: Sequence[int], right: Sequence[int], plane: float = 0.0
) -> Iterator[MirroredPair]:
    """Yield the pairs of two chains of equal length.

    An anchor may be anywhere on its axis, and mirrored axes may point either way.

    Args:
        skeleton: skeleton with x forward, y to the left and z up.
        left: indices of joints.
        right: indices of their counterparts.
        plane: y of the plane of symmetry [m].
    """
    for a, b in zip(left, right, strict=True):
        axis = skeleton.axes[a] * [-1.0, 1.0, -1.0]
        anchor = skeleton.anchors[a] * [1.0, -1.0, 1.0] + [0.0, 2.0 * plane, 0.0]
        cosine = float(axis @ skeleton.axes[b])
        limits = skeleton.ranges[a] if cosine > 0.0 else -skeleton.ranges[a][::-1]
        same = limits == skeleton.ranges[b]
        differences = np.subtract(limits, skeleton.ranges[b], where=~same, out=np.zeros(2))
        yield MirroredPair(
            left=a,
            right=b,
            distance=float(
                np.linalg.norm(np.cross(skeleton.anchors[b] - anchor, skeleton.axes[b]))
            ),
            angle=float(np.arccos(min(1.0, abs(cosine)))),
            range=float(np.abs(differences).max()),
            reversed=cosine <= 0.0,
        )


def clip_to_range(angle: float, lower: float, upper: float) -> float:
    """Return an angle that is inside its range; one outside moves in by 2 % of the range [rad]."""
    if lower <= angle <= upper:
        return angle
    margin = LIMIT_MARGIN * (upper - lower)
    return min(max(angle, lower + margin), upper - margin)
