"""Comparison of two chains of joints with each other's mirror image in the sagittal plane."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hsr8.robots.skeleton import Skeleton


@dataclass(frozen=True, slots=True)
class MirroredPair:
    """Joints of a left and a right chain, and their differences from mirror images.

    Attributes:
        left, right: indices of the joints.
        distance: of the axis of the right joint from the mirrored anchor of the left one [m].
        angle: between the axes, without their direction [rad].
        range: maximum difference of the limits [rad].
    """

    left: int
    right: int
    distance: float
    angle: float
    range: float


def mirrored_pairs(
    skeleton: Skeleton, left: Sequence[int], right: Sequence[int], plane: float = 0.0
) -> Iterator[MirroredPair]:
    """Yield the pairs of two chains of equal length.

    An anchor may be anywhere on its axis, and mirrored axes may point either way.

    Args:
        skeleton: with x forward, y to the left and z up.
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
        )
