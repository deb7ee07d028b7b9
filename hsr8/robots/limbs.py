"""Limbs of an unknown robot: pairs of mirrored chains, and the directions up and left."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.mirror import mirrored_pairs
from hsr8.robots.roles import LEG_JOINTS
from hsr8.robots.skeleton import Skeleton

Array = NDArray[np.float64]

MAX_SHIFT = 0.03  # of a mirrored axis, in sizes of the robot [1]
MAX_TURN = np.radians(5.0)  # of a mirrored axis [rad]
STANDING = np.cos(np.radians(30.0))  # minimum cosine between the hips above the feet and z [1]
PITCHING = 3  # joints of a leg
MIN_LEG_JOINTS = 3  # of a chain that is reported as an incomplete leg


@dataclass(frozen=True, slots=True)
class Limb:
    """Mirrored chains from the trunk outwards: joints that only the one side has.

    Attributes:
        left: joints of the chain at larger y.
        right: joints of the other one.
        plane: y of the plane of symmetry [m].
    """

    left: tuple[int, ...]
    right: tuple[int, ...]
    plane: float


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """Robot on its legs.

    Attributes:
        skeleton: with y to the left and z up; x points forward or backward.
        rotation: of the frame of the root to that of `skeleton` (3, 3).
        legs: chains that end lowest.
        limbs: all of them, `legs` included.
    """

    skeleton: Skeleton
    rotation: Array
    legs: Limb
    limbs: tuple[Limb, ...]


def size_of(skeleton: Skeleton) -> float:
    """Return the largest extent of the joints [m]."""
    return float(np.ptp(skeleton.anchors, axis=0).max()) if len(skeleton.joints) else 0.0


def find_stance(skeleton: Skeleton) -> Stance | None:
    """Return the first frame in which the robot stands on mirrored legs.

    z up is preferred to other directions, then legs of six joints, then y to the left.
    """
    stances = [s for rotation in _rotations() if (s := _stance(skeleton, rotation)) is not None]

    def preference(stance: Stance) -> tuple[bool, bool]:
        return stance.rotation[2, 2] < 1.0, len(stance.legs.left) < LEG_JOINTS

    return min(stances, key=preference, default=None)


def turned_back(stance: Stance) -> Stance:
    """Return the stance that faces the other direction."""
    half = np.diag([-1.0, -1.0, 1.0])
    limbs = [Limb(limb.right, limb.left, -limb.plane) for limb in stance.limbs]
    return Stance(
        skeleton=stance.skeleton.turned(half),
        rotation=half @ stance.rotation,
        legs=limbs[stance.limbs.index(stance.legs)],
        limbs=tuple(limbs),
    )


def foot_joint(skeleton: Skeleton, leg: tuple[int, ...]) -> int:
    """Return the position in a leg of the joint that moves the foot: the last, but for toes.

    Args:
        skeleton: with y to the left.
        leg: joints.
    """
    for last in range(len(leg) - 1, LEG_JOINTS - 2, -1):
        six = leg[last + 1 - LEG_JOINTS : last + 1]
        if sum(map(skeleton.is_pitch, six)) == PITCHING:
            return last
    return len(leg) - 1


def _rotations() -> Iterator[Array]:
    """Yield frames with axes along those of the root; x has one of its two directions."""
    for up, sign in ((2, 1.0), (1, 1.0), (1, -1.0), (0, 1.0), (0, -1.0), (2, -1.0)):
        for left in (k for k in (1, 0, 2) if k != up):
            y, z = np.eye(3)[left], sign * np.eye(3)[up]
            yield np.array([np.cross(y, z), y, z])


def _stance(skeleton: Skeleton, rotation: Array) -> Stance | None:
    turned = skeleton.turned(rotation)
    limbs = tuple(_limbs(turned))
    legs = [limb for limb in limbs if _may_stand(turned, limb)]
    if not legs:
        return None
    lowest = min(legs, key=lambda limb: _end_height(turned, limb))
    others = [e for e in turned.ends() if e not in (lowest.left[-1], lowest.right[-1])]
    below = [e for e in others if turned.anchors[e, 2] < _end_height(turned, lowest)]
    if any(
        lowest.left[0] not in turned.chain(e) and lowest.right[0] not in turned.chain(e)
        for e in below
    ):
        return None
    return Stance(turned, rotation, lowest, limbs)


def _may_stand(skeleton: Skeleton, limb: Limb) -> bool:
    """Return whether the end of a limb is below its first joint and three joints pitch."""
    joints = limb.left[-LEG_JOINTS - 1 :]
    if len(limb.left) < MIN_LEG_JOINTS or sum(map(skeleton.is_pitch, joints)) < PITCHING:
        return False
    up = sum(skeleton.anchors[side[0]] - skeleton.anchors[side[-1]] for side in _sides(limb))
    return bool(up[2] > STANDING * np.linalg.norm(up))


def _sides(limb: Limb) -> tuple[tuple[int, ...], tuple[int, ...]]:
    return limb.left, limb.right


def _end_height(skeleton: Skeleton, limb: Limb) -> float:
    return float(skeleton.anchors[[limb.left[-1], limb.right[-1]], 2].mean())


def _limbs(skeleton: Skeleton) -> Iterator[Limb]:
    """Yield every pair of chains that are mirror images."""
    size = size_of(skeleton)
    for a, b in combinations(skeleton.ends(), 2):
        one, other = skeleton.chain(a), skeleton.chain(b)
        common = sum(i == j for i, j in zip(one, other, strict=False))
        one, other = one[common:], other[common:]
        if len(one) != len(other) or skeleton.coms[a, 1] == skeleton.coms[b, 1]:
            continue
        left, right = (one, other) if skeleton.coms[a, 1] > skeleton.coms[b, 1] else (other, one)
        plane = float(skeleton.coms[[a, b], 1].mean())
        plane = 0.0 if abs(plane) < MAX_SHIFT * size else plane
        pairs = mirrored_pairs(skeleton, left, right, plane)
        if all(p.distance < MAX_SHIFT * size and p.angle < MAX_TURN for p in pairs):
            yield Limb(left, right, plane)
