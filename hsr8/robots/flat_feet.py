"""Ankle angles at which the soles of an unknown robot are flat on the floor."""

from math import atan2, cos, radians

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from hsr8.robots.posed import Posed
from hsr8.robots.sole import foot_points

Array = NDArray[np.float64]

MIN_TILT, MAX_TILT = radians(2.0), radians(45.0)  # of soles that are not flat [rad]
SAME_FACE = cos(radians(1.0))  # minimum cosine between the normals of one face [1]
MIN_FACE = 0.4  # area of the sole, of the lower side of the foot [1]
MAX_DIFFERENCE = radians(1.0)  # between both feet [rad]


def flat_feet(
    model: mujoco.MjModel, feet: tuple[str, str], legs: tuple[tuple[str, ...], tuple[str, ...]]
) -> dict[str, float]:
    """Return angles of the ankles that turn the soles flat; none where they are, or unknown [rad].

    Args:
        model: compiled robot.
        feet: bodies of the left and the right foot.
        legs: joints of the left and the right leg, hip first.
    """
    if model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        return {}
    robot = Posed.at(model, {})
    left, right = (sole_tilt(foot_points(robot, foot)) for foot in feet)
    if left is None or right is None or abs(left - right) > MAX_DIFFERENCE:
        return {}
    tilt = 0.5 * (left + right)
    if not MIN_TILT < abs(tilt) < MAX_TILT:
        return {}
    axes = {name: float(robot.data.xaxis[model.joint(name).id, 1]) for leg in legs for name in leg}
    ankles = [max(leg[-2:], key=lambda name: abs(axes[name])) for leg in legs]
    return {name: round(float(np.sign(axes[name])) * tilt, 4) for name in ankles}


def sole_tilt(points: Array) -> float | None:
    """Return the turn about the left axis that makes the sole of a foot level [rad].

    The sole is the largest face of the convex hull that faces the floor.

    Args:
        points: of the foot's shapes (n, 3) [m].

    Returns:
        None where the foot has no such face.
    """
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):  # points in a plane
        return None
    corners, normals = hull.points[hull.simplices], hull.equations[:, :3]
    sides = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    lower = normals[:, 2] < -cos(MAX_TILT)
    if not lower.any():
        return None
    normals, areas = normals[lower], areas[lower]
    faces = (normals @ normals.T > SAME_FACE) @ areas
    best = int(faces.argmax())
    if faces[best] < MIN_FACE * areas.sum():
        return None
    x, _, z = normals[best].tolist()
    return atan2(x, -z)
