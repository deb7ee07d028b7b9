"""Limbs of an unknown robot: pairs of mirrored chains, and the directions up and left."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.parts.skeleton import LEG_JOINTS, BaseFrame, Skeleton, mirrored_pairs

Array = NDArray[np.float64]

MAX_SHIFT = 0.03  # of a mirrored axis, in sizes of the robot [1]
MAX_TURN = np.radians(5.0)  # of a mirrored axis [rad]
STANDING = np.cos(np.radians(30.0))  # minimum cosine between the hips above the feet and z [1]
PITCHING = 3  # joints of a leg
BENT = (-0.4, 0.8, -0.35)  # pitch of hip, knee and ankle in a bent leg, about the left axis [rad]
MIN_LEG_JOINTS = 3  # of a chain that is reported as an incomplete leg
LEVEL = 0.05  # difference of height of feet on one floor, in sizes of the robot [1]
LONGER = 1.2  # ratio of a thigh or shank to one that ends in toes [1]
MIN_TOE = 0.01  # centre of mass of a foot forward of its ankle, in sizes of the robot [1]
SIDES = ("lr", "gd", "id", "sd", "ed", "hm", "zy")  # first letters of left and right


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
        skeleton: skeleton with y to the left and z up; x points forward or backward.
        rotation: rotation of the frame of the root to that of `skeleton` (3, 3).
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


def not_hinged(joint: str) -> str:
    """Return that a joint is not a hinge."""
    return (
        f"joint {joint!r} is a slide or ball joint; expected hinge joints: three at the hip, a "
        "knee, two at the ankle"
    )


def no_stance(skeleton: Skeleton) -> str:
    """Return why no frame lets a robot stand on two mirrored legs."""
    if not skeleton.joints:
        return "the model has no hinge joints; expected legs of six"
    if skeleton.others:
        return not_hinged(skeleton.others[0])
    limbs = list(_limbs(skeleton))
    low = sorted(skeleton.ends(), key=lambda end: float(skeleton.anchors[end, 2]))[:2]
    if len(low) < 2 or all({*low} != {limb.left[-1], limb.right[-1]} for limb in limbs):
        named = " and ".join(repr(skeleton.joints[end]) for end in low)
        return (
            f"the chains of joints that end lowest, at {named}, are not mirror images of each "
            "other; expected a left and a right leg, alike at zero angles"
        )
    lowest = sorted(limbs, key=lambda limb: _end_height(skeleton, limb))
    ends = {limb: _end_height(skeleton, limb) for limb in lowest}
    standing = [e for e in ends if ends[e] - ends[lowest[0]] < LEVEL * size_of(skeleton)]
    if len({end for limb in standing for end in (limb.left[-1], limb.right[-1])}) > 2:
        return f"{2 * len(standing)} chains end lowest, at one height; expected two legs"
    legs = lowest[0]
    names = [", ".join(skeleton.joints[j] for j in leg) for leg in _sides(legs)]
    pitching = len(skeleton.pitching(legs.left))
    return (
        f"the chains that end lowest have {len(legs.left)} hinge joints, of which {pitching} "
        f"pitch, {names[0]} and {names[1]}; expected {LEG_JOINTS}: three at the hip, a knee, two "
        "at the ankle, below the base at zero angles"
    )


def turned_back(stance: Stance) -> Stance:
    """Return the stance that faces the other direction."""
    half = np.diag([-1.0, -1.0, 1.0])
    limbs = [Limb(limb.right, limb.left, -limb.plane) for limb in stance.limbs]
    return Stance(
        skeleton=stance.skeleton.within(BaseFrame(half, np.zeros(3))),
        rotation=half @ stance.rotation,
        legs=limbs[stance.limbs.index(stance.legs)],
        limbs=tuple(limbs),
    )


def foot_joint(skeleton: Skeleton, leg: Sequence[int]) -> int:
    """Return the position in a leg of the joint that moves the foot: the last, but for toes.

    Three of the six joints up to it pitch: hip, knee and ankle, with thigh and shank between.

    Args:
        skeleton: skeleton with y to the left.
        leg: joints.
    """
    best, longest = len(leg) - 1, 0.0
    for last in range(len(leg) - 1, LEG_JOINTS - 2, -1):
        six = leg[last + 1 - LEG_JOINTS : last + 1]
        pitching = skeleton.pitching(six)
        if len(pitching) != PITCHING:
            continue
        hip, knee, ankle = skeleton.anchors[pitching]
        shorter = float(min(np.linalg.norm(knee - hip), np.linalg.norm(ankle - knee)))
        if shorter > LONGER * longest:
            best, longest = last, shorter
    return best


def bent(
    skeleton: Skeleton, legs: Sequence[Sequence[int]], zero: Mapping[str, float]
) -> dict[str, float]:
    """Return the angles of bent legs by joint [rad].

    Args:
        skeleton: skeleton with y to the left.
        legs: six joints of each leg, of which three pitch.
        zero: angles of straight legs, where not zero [rad].
    """
    angles = {}
    for leg in legs:
        pitching = skeleton.pitching(leg)
        for joint, angle in zip(pitching, BENT, strict=True):
            name, sign = skeleton.joints[joint], float(np.sign(skeleton.axes[joint, 1]))
            angles[name] = zero.get(name, 0.0) + sign * angle
    return angles


def side_vote(left: str, right: str) -> int:
    """Return 1 if two names differ as left and right do, -1 if as right and left, else 0."""
    one, other = left.lower(), right.lower()
    letters = next((a + b for a, b in zip(one, other, strict=False) if a != b), "")
    return 1 if letters in SIDES else -1 if letters[::-1] in SIDES else 0


def toe_vote(skeleton: Skeleton, left: Sequence[int], right: Sequence[int]) -> int:
    """Return 1 if the masses of the feet are forward of the ankles, -1 if behind, else 0."""
    forward = 0.0
    for leg in (left, right):
        ankle = skeleton.pitching(leg)[-1]
        forward += 0.5 * float(skeleton.coms[leg[-1], 0] - skeleton.anchors[ankle, 0])
    return int(np.sign(forward)) if abs(forward) > MIN_TOE * size_of(skeleton) else 0


def _rotations() -> Iterator[Array]:
    """Yield frames with axes along those of the root; x has one of its two directions."""
    for up, sign in ((2, 1.0), (1, 1.0), (1, -1.0), (0, 1.0), (0, -1.0), (2, -1.0)):
        for left in (k for k in (1, 0, 2) if k != up):
            y, z = np.eye(3)[left], sign * np.eye(3)[up]
            yield np.array([np.cross(y, z), y, z])


def _stance(skeleton: Skeleton, rotation: Array) -> Stance | None:
    turned = skeleton.within(BaseFrame(rotation, np.zeros(3)))
    limbs = tuple(_limbs(turned))
    legs = [limb for limb in limbs if _may_stand(turned, limb)]
    if not legs:
        return None
    lowest = min(legs, key=lambda limb: _end_height(turned, limb))
    others = [e for e in turned.ends() if e not in (lowest.left[-1], lowest.right[-1])]
    level = _end_height(turned, lowest) + LEVEL * size_of(turned)
    below = [e for e in others if turned.anchors[e, 2] < level]
    if any(
        lowest.left[0] not in turned.chain(e) and lowest.right[0] not in turned.chain(e)
        for e in below
    ):
        return None
    return Stance(turned, rotation, lowest, limbs)


def _may_stand(skeleton: Skeleton, limb: Limb) -> bool:
    """Return whether the end of a limb is below its first joint and three joints pitch."""
    joints = limb.left[-LEG_JOINTS - 1 :]
    if len(limb.left) < MIN_LEG_JOINTS or len(skeleton.pitching(joints)) < PITCHING:
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
