"""Skeleton of a URDF robot, before anything but the file is known."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.skeleton import Skeleton
from hsr8.robots.urdf_elements import Joint
from hsr8.robots.urdf_file import Urdf
from hsr8.robots.urdf_joints import immovable
from hsr8.robots.urdf_model import fuse
from hsr8.robots.urdf_tree import Tree

Array = NDArray[np.float64]


def skeleton_of_urdf(urdf: Urdf) -> Skeleton:
    """Return the skeleton at zero angles; joints that no servo can move are rigid."""
    tree = Tree(urdf, dict.fromkeys(immovable(urdf), 0.0))
    poses = tree.poses({})
    group = dict.fromkeys((link for link, _ in tree.group(urdf.root)), -1)
    joints: list[Joint] = []
    parents: list[int] = []
    pending = list(group)
    while pending:
        for joint in urdf.below(pending.pop(0)):
            if tree.moves(joint):
                links = [link for link, _ in tree.group(joint.child)]
                parents.append(group[joint.parent])
                group |= dict.fromkeys(links, len(joints))
                joints.append(joint)
                pending += links
    anchors = np.array([poses[j.child][:3, 3] for j in joints]).reshape(-1, 3)
    masses, coms = np.zeros(len(joints)), anchors.copy()
    for k in range(len(joints)):
        masses[k], com = _mass(urdf, group, poses, k)
        if masses[k] > 0.0:
            coms[k] = com
    return Skeleton(
        root=urdf.root,
        free=True,
        joints=tuple(j.name for j in joints),
        bodies=tuple(j.child for j in joints),
        parents=tuple(parents),
        axes=np.array([poses[j.child][:3, :3] @ j.axis for j in joints]).reshape(-1, 3),
        anchors=anchors,
        ranges=np.array([j.range for j in joints]).reshape(-1, 2),
        masses=masses,
        coms=coms,
        total_mass=float(masses.sum()) + _mass(urdf, group, poses, -1)[0],
        group=group,
        others=(),
    )


def _mass(
    urdf: Urdf, group: Mapping[str, int], poses: Mapping[str, Array], index: int
) -> tuple[float, Array]:
    """Return mass [kg] and CoM in the root (3,) [m] of the links of a group."""
    links = [urdf.links[name] for name in group if group[name] == index]
    total = fuse([(link.inertial, poses[link.name]) for link in links if link.inertial])
    return total.mass, total.com
