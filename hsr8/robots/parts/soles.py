"""Soles of a robot: the flat rectangle below each foot, and ankle angles at which it is level."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import atan2, cos, radians

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from hsr8.robots.file.description import RobotDescription, SoleRectangle
from hsr8.robots.file.key_mistake import KeyMistake, at_least, require_name
from hsr8.robots.parts.roles import Roles, pose_of
from hsr8.robots.parts.skeleton import BaseFrame, Posed

Array = NDArray[np.float64]

FLAT = 0.004  # height of the lowest part of a foot that counts as its sole [m]
MIN_SIDE = 0.04  # minimum length and width of a sole, of the length of the leg [1]
MAX_DIFFERENCE = 0.02  # between the left sole and the mirror image of the right one [m]
SAME = 0.002  # difference of manufacture, averaged silently [m]
MAIN_FRACTION = 0.5  # of the area of all shapes, from which one shape is the sole [1]
COVERED = 0.5  # of the outline of a foot, by a sole that is flat [1]
MIN_TILT, MAX_TILT = radians(2.0), radians(45.0)  # of soles that are not flat [rad]
SAME_FACE = cos(radians(1.0))  # minimum cosine between the normals of one face [1]
MIN_FACE = 0.4  # area of the sole, of the lower side of the foot [1]
MAX_TILT_DIFFERENCE = radians(1.0)  # between both feet [rad]
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


EDGES = ("front", "back", "left", "right", "height")


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Sole in the base frame, in the zero posture.

    Attributes:
        front, back, left, right: edges along x and y [m].
        height: height of the sole, z [m].
    """

    front: float
    back: float
    left: float
    right: float
    height: float

    @property
    def size(self) -> tuple[float, float]:
        """Length and width [m]."""
        return self.front - self.back, self.left - self.right

    def mirrored(self) -> "Rectangle":
        """Return the mirror image on the other side of the robot."""
        return Rectangle(self.front, self.back, -self.right, -self.left, self.height)

    @property
    def edges(self) -> Array:
        """Edges and height (5,) [m]."""
        return np.array([self.front, self.back, self.left, self.right, self.height])


def soles_of(
    zero: Posed, roles: Roles, description: RobotDescription
) -> tuple[tuple[Rectangle, Rectangle], list[str]]:
    """Return the left and the right sole, mirror images, and notes for people.

    Args:
        zero: the robot in the zero posture.
        roles: roles of the robot's parts.
        description: description of the robot.

    Raises:
        KeyMistake: a foot has no shape, its sole is too small or above the ankle, or the soles
            differ.
    """
    stated, both, notes = description.sole, [], list[str]()
    joints = [zero.data.joint(roles.legs[0][end]).xanchor[2] for end in (0, -1)]
    least = MIN_SIDE * float(joints[0] - joints[1])
    for side, foot in enumerate(roles.feet):
        if isinstance(stated, SoleRectangle):
            both.append(_stated(pose_of(zero, description.feet[side])[1], stated, side))
            continue
        sole, note = _of_shapes(zero, foot, None if stated is None else stated[side], least)
        both.append(sole)
        notes += note
    left, right = both
    differences = np.abs(left.edges - right.mirrored().edges)
    off = float(differences.max())
    if off > MAX_DIFFERENCE:
        raise KeyMistake(
            f"sole: the right sole is not the mirror image of the left one, got a "
            f"difference of {1e3 * off:.0f} mm at {EDGES[int(differences.argmax())]}; expected "
            f"less than {1e3 * MAX_DIFFERENCE:.0f} mm: state sole, or the zero posture in which "
            "both feet are flat"
        )
    if off > SAME:
        notes.append(f"soles differ by {1e3 * off:.1f} mm: their mean is used")
    mean = Rectangle(*(0.5 * (left.edges + right.mirrored().edges)).tolist())
    if min(mean.size) < least:
        length, width = (1e3 * side for side in mean.size)
        raise KeyMistake(
            f"sole: that of foot {description.feet[0]!r} is too small to stand on, got "
            f"{length:.3g} x {width:.3g} mm; expected at least {at_least(1e3 * least)} mm, "
            f"{MIN_SIDE:.0%} of the leg: state sole, or the zero posture in which the feet are flat"
        )
    ankle = min(float(zero.data.joint(name).xanchor[2]) for name in roles.legs[0][-2:])
    if mean.height >= ankle:
        raise KeyMistake(
            f"sole: that of foot {description.feet[0]!r} is not below its ankle, got "
            f"{1e3 * (mean.height - ankle):.0f} mm above it; expected less than 0: height is "
            "usually negative"
        )
    notes.append(f"sole {1e3 * mean.size[0]:.0f} x {1e3 * mean.size[1]:.0f} mm")
    return (mean, mean.mirrored()), notes


def flat_feet(
    model: mujoco.MjModel, feet: tuple[str, str], legs: Sequence[Sequence[str]], base: BaseFrame
) -> dict[str, float]:
    """Return angles of the ankles that turn the soles flat; none where they are, or unknown [rad].

    Args:
        model: compiled robot.
        feet: bodies of the left and the right foot.
        legs: joints of the left and the right leg, hip first.
        base: frame of the base.
    """
    robot = Posed.at(model, {}, base=base)
    left, right = (sole_tilt(foot_points(robot, foot)) for foot in feet)
    if left is None or right is None or abs(left - right) > MAX_TILT_DIFFERENCE:
        return {}
    tilt = 0.5 * (left + right)
    if not MIN_TILT < abs(tilt) < MAX_TILT:
        return {}
    axes = {name: float(robot.data.joint(name).xaxis[1]) for leg in legs for name in leg}
    ankles = [max(leg[-2:], key=lambda name: abs(axes[name])) for leg in legs]
    return {name: round(float(np.sign(axes[name])) * tilt, 4) for name in ankles}


def sole_tilt(points: Array) -> float | None:
    """Return the turn about the left axis that makes the sole of a foot level [rad].

    The sole is the largest face of the convex hull that faces the floor.

    Args:
        points: points of the foot's shapes (n, 3) [m].

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


def foot_points(zero: Posed, foot: str) -> Array:
    """Return points on the lower side of a foot's shapes in the base frame (n, 3) [m]."""
    solid, every = _shapes(zero, foot, None)
    groups = solid or every
    return np.concatenate(groups) if groups else np.zeros((0, 3))


def _stated(origin: Array, stated: SoleRectangle, side: int) -> Rectangle:
    x, y, z = origin.tolist()
    left, right = (stated.left, stated.right) if side == 0 else (-stated.right, -stated.left)
    return Rectangle(x + stated.front, x + stated.back, y + left, y + right, z + stated.height)


def _of_shapes(
    zero: Posed, foot: str, geom: str | None, least: float
) -> tuple[Rectangle, list[str]]:
    """Return the sole of a foot from one geom, or all of them, and notes.

    Colliding shapes count, all where these are missing or make no flat sole.

    Args:
        zero: the robot in the zero posture.
        foot: body of the foot.
        geom: name of the geom, if one is stated.
        least: minimum side of a sole [m].
    """
    solid, every = _shapes(zero, foot, geom)
    sole = None
    for groups in (solid, every):
        if groups and (sole is None or min(sole.size) < least):
            candidate = _lowest(groups)
            if sole is None or min(candidate.size) >= least:
                sole, points = candidate, np.concatenate(groups)[:, :2]
    if sole is None:
        raise KeyMistake(
            f"sole: missing, and foot {foot!r} has no shape; expected {{front, back, left, "
            "right, height} [m], or its mesh: state the folder of its package under packages"
        )
    outline = float(np.prod(np.ptp(points, axis=0)))
    covered = float(np.prod(sole.size)) / outline if outline else 1.0
    if covered >= COVERED:
        return sole, []
    return sole, [
        f"warning: the sole of {foot!r} covers {covered:.0%} of the foot's outline: state zero if "
        "the foot is not flat there"
    ]


def _lowest(groups: Sequence[Array]) -> Rectangle:
    """Return the rectangle of the lowest points of some shapes, or of the main one of them."""
    low = min(float(points[:, 2].min()) for points in groups)
    flat = [points[points[:, 2] < low + FLAT, :2] for points in groups]
    flat = [points for points in flat if len(points)]

    def area(points: Array) -> float:
        return float(np.prod(points.max(axis=0) - points.min(axis=0)))

    together = np.concatenate(flat)
    main = max(flat, key=area)
    points = main if area(main) > MAIN_FRACTION * area(together) else together
    (back, right), (front, left) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return Rectangle(front, back, left, right, low)


def _shapes(zero: Posed, foot: str, geom: str | None) -> tuple[list[Array], list[Array]]:
    """Return points of the colliding shapes of a foot in the base frame, and of all."""
    model = zero.model
    geoms = [g for body in _rigid(model, model.body(foot).id) for g in _geoms(model, body)]
    if geom is not None:
        names = [name for g in geoms if (name := model.geom(g).name)]
        require_name("sole", "geom", geom, names, f"foot {foot!r}")
        geoms = [model.geom(geom).id]
    solid = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
    return [_points(zero, g) for g in solid], [_points(zero, g) for g in geoms]


def _rigid(model: mujoco.MjModel, body: int) -> Iterator[int]:
    """Yield a body and those fixed to it."""
    yield body
    for child in range(body + 1, model.nbody):
        if model.body_parentid[child] == body and model.body_jntnum[child] == 0:
            yield from _rigid(model, child)


def _geoms(model: mujoco.MjModel, body: int) -> range:
    first = int(model.body_geomadr[body])
    return range(first, first + int(model.body_geomnum[body]))


def _points(zero: Posed, geom: int) -> Array:
    """Return points on the surface of a shape that span its lower side (n, 3) [m]."""
    model, data = zero.model, zero.data
    kind, size = mujoco.mjtGeom(model.geom_type[geom]), model.geom_size[geom]
    rotation, position = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        local = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])].astype(float)
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        local = corners * size
    elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        ring = size[0] * np.column_stack([np.cos(CIRCLE), np.sin(CIRCLE), np.zeros(len(CIRCLE))])
        up = np.array([0.0, 0.0, size[1]])
        local = np.concatenate([ring + up, ring - up])
    elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        ends = np.array([[0.0, 0.0, -size[1]], [0.0, 0.0, size[1]]]) @ rotation.T + position
        below: Array = ends - (0.0, 0.0, size[0])
        return below
    else:  # spheres and ellipsoids touch the floor below their centre
        reach = size[0] if kind == mujoco.mjtGeom.mjGEOM_SPHERE else float(size.min())
        lowest: Array = position[None] - (0.0, 0.0, reach)
        return lowest
    points: Array = local @ rotation.T + position
    return points
