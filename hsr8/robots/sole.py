"""Soles of a robot: the flat rectangle below each foot."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.description import SoleRectangle
from hsr8.robots.key_mistake import KeyMistake, require_name
from hsr8.robots.posed import Posed
from hsr8.robots.roles import Roles

Array = NDArray[np.float64]

FLAT = 0.004  # height of the lowest part of a foot that counts as its sole [m]
MIN_SIDE = 0.02  # minimum length and width of a sole [m]
MAX_DIFFERENCE = 0.02  # between the left sole and the mirror image of the right one [m]
SAME = 0.002  # difference of manufacture, averaged silently [m]
MAIN_FRACTION = 0.5  # of the area of all shapes, from which one shape is the sole [1]
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Sole in the base frame, in the zero posture.

    Attributes:
        front, back, left, right: edges along x and y [m].
        height: of the sole, z [m].
    """

    front: float
    back: float
    left: float
    right: float
    height: float

    def mirrored(self) -> "Rectangle":
        """Return the mirror image on the other side of the robot."""
        return Rectangle(self.front, self.back, -self.right, -self.left, self.height)

    @property
    def edges(self) -> Array:
        """Edges and height (5,) [m]."""
        return np.array([self.front, self.back, self.left, self.right, self.height])


def soles_of(
    zero: Posed,
    roles: Roles,
    stated: SoleRectangle | tuple[str, str] | None,
) -> tuple[tuple[Rectangle, Rectangle], list[str]]:
    """Return the left and the right sole, mirror images, and notes for people.

    Args:
        zero: the robot in the zero posture.
        roles: of the robot's parts.
        stated: by the description.

    Raises:
        KeyMistake: a foot has no shape, its sole is too small or above the ankle, or the soles
            differ.
    """
    feet, both, notes = roles.feet, [], []
    for side, foot in enumerate(feet):
        if isinstance(stated, SoleRectangle):
            sole = _stated(zero.data.xpos[zero.model.body(foot).id], stated, side)
        else:
            groups = _shapes(zero, foot, None if stated is None else stated[side])
            if not groups:
                raise KeyMistake(
                    f"sole: missing, and foot {foot!r} has no shape; expected {{front, back, left, "
                    "right, height} [m]"
                )
            sole = _lowest(groups)
        both.append(sole)
    left, right = both
    off = float(np.abs(left.edges - right.mirrored().edges).max())
    if off > MAX_DIFFERENCE:
        raise KeyMistake(
            f"sole: the right sole is not the mirror image of the left one, got a "
            f"difference of {1e3 * off:.0f} mm; expected less than {1e3 * MAX_DIFFERENCE:.0f} mm: "
            "state sole, or the zero posture in which both feet are flat"
        )
    if off > SAME:
        notes.append(f"soles differ by {1e3 * off:.1f} mm: their mean is used")
    mean = Rectangle(*(0.5 * (left.edges + right.mirrored().edges)).tolist())
    length, width = mean.front - mean.back, mean.left - mean.right
    if min(length, width) < MIN_SIDE:
        raise KeyMistake(
            f"sole: that of foot {feet[0]!r} is too small to stand on, got "
            f"{1e3 * length:.0f} x {1e3 * width:.0f} mm; expected at least "
            f"{1e3 * MIN_SIDE:.0f} mm: state sole, or the zero posture in which the feet are flat"
        )
    ankle = min(float(zero.data.joint(name).xanchor[2]) for name in roles.legs[0][-2:])
    if mean.height >= ankle:
        raise KeyMistake(
            f"sole: that of foot {feet[0]!r} is not below its ankle, got "
            f"{1e3 * (mean.height - ankle):.0f} mm above it; expected less than 0: height is "
            "usually negative"
        )
    notes.append(f"sole {1e3 * length:.0f} x {1e3 * width:.0f} mm")
    return (mean, mean.mirrored()), notes


def foot_points(zero: Posed, foot: str) -> Array:
    """Return points on the lower side of a foot's shapes in the base frame (n, 3) [m]."""
    groups = _shapes(zero, foot, None)
    return np.concatenate(groups) if groups else np.zeros((0, 3))


def _stated(origin: Array, stated: SoleRectangle, side: int) -> Rectangle:
    x, y, z = origin.tolist()
    left, right = (stated.left, stated.right) if side == 0 else (-stated.right, -stated.left)
    return Rectangle(x + stated.front, x + stated.back, y + left, y + right, z + stated.height)


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


def _shapes(zero: Posed, foot: str, geom: str | None) -> list[Array]:
    """Return points of the shapes of a foot in the base frame: colliding ones, else all."""
    model = zero.model
    geoms = [g for body in _rigid(model, model.body(foot).id) for g in _geoms(model, body)]
    if geom is not None:
        names = [name for g in geoms if (name := model.geom(g).name)]
        require_name("sole", "geom", geom, names, f"foot {foot!r}")
        return [_points(zero, model.geom(geom).id)]
    solid = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
    return [_points(zero, g) for g in solid or geoms]


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
