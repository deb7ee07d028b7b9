"""Visibility of points of the floor: field of view, range and occlusion of the camera."""

from math import atan2, cos, pi, sqrt, tan
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from navigation.observation import CameraView, shadow_at
from navigation.transform import yaw_rotation

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Marks = NDArray[np.uint8]
Rows = NDArray[np.record]

UNSEEN, FREE, OCCUPIED = 0, 1, 2


@record_class
class Eye:
    """Camera of one frame in W."""

    position: Annotated[Array, 3]  # [m]
    rotation: Annotated[Array, 3, 3]  # R_WC, columns right, down, forward
    heading: float  # of the robot [rad]
    width: (
        float  # tangent of half the horizontal field of view, of a panoramic camera its cosine [1]
    )
    height: float  # tangent of half the vertical field of view [1]
    range: float  # maximum distance of a detection along the floor [m]
    top: float  # of an obstacle above the camera, 0 where only the foot counts [m]
    panoramic: bool


@compiled
def in_image(dx: float, dy: float, dz: float, eye: np.record) -> bool:
    """Return whether a point projects into the image; its position from the camera [m]."""
    R = eye.rotation
    forward = (R[0, 2] * dx + R[2, 2] * dz) + R[1, 2] * dy
    if forward <= 0.0:
        return False
    right = (R[0, 0] * dx + R[2, 0] * dz) + R[1, 0] * dy
    down = (R[0, 1] * dx + R[2, 1] * dz) + R[1, 1] * dy
    return bool(abs(right) <= eye.width * forward and abs(down) <= eye.height * forward)


@compiled
def in_view(dx: float, dy: float, eye: np.record, shadow: Array) -> bool:
    """Return whether the image shows an obstacle at a point of the floor: its top or its foot.

    Args:
        dx: position from the camera along x of W [m].
        dy: position from the camera along y [m].
        eye: record of type `Eye`.
        shadow: distance up to which the body hides the floor, see `CameraModel` (n,) [m].
    """
    square = dx * dx + dy * dy
    if square > eye.range * eye.range:
        return False
    if eye.panoramic:
        x, y = eye.rotation[0, 2], eye.rotation[1, 2]
        return bool(x * dx + y * dy >= eye.width * sqrt((x * x + y * y) * square))
    if eye.top < 0.0 and in_image(dx, dy, eye.top, eye):
        return True
    if not in_image(dx, dy, -eye.position[2], eye):
        return False
    reach = shadow_at(atan2(dy, dx) - eye.heading, shadow)
    return bool(square >= reach * reach)


@compiled
def occluded(dx: float, dy: float, discs: Array, edge: float = 0.0) -> bool:
    """Return whether a nearer disc intersects the ray to a point.

    Args:
        dx: position from the camera along x of W [m].
        dy: position from the camera along y [m].
        discs: see `relative_discs`.
        edge: distance from the centre of a disc within which the point is on the disc [m].
    """
    square = dx * dx + dy * dy
    for j in range(len(discs)):
        ax, ay = discs[j, 0], discs[j, 1]
        # The ray passes the disc's centre at a distance of |across| / |p|.
        if dx * ax + dy * ay > discs[j, 2]:
            if (ax - dx) * (ax - dx) + (ay - dy) * (ay - dy) <= edge * edge:
                continue
            across = dx * ay - dy * ax
            if across * across < discs[j, 3] * square:
                return True
    return False


@compiled
def relative_discs(eye: np.record, centres: Array, radii: Array, margin: float) -> Array:
    """Return discs relative to the camera: x, y, squared distance and radius (m, 4) [m, m²].

    Args:
        eye: record of type `Eye`.
        centres: centres in W (m, 2) [m].
        radii: radii (m,) [m].
        margin: enlargement of every disc [m].
    """
    discs = np.empty((len(radii), 4))
    for j in range(len(radii)):
        ax, ay = centres[j, 0] - eye.position[0], centres[j, 1] - eye.position[1]
        discs[j, 0], discs[j, 1] = ax, ay
        discs[j, 2] = ax * ax + ay * ay
        discs[j, 3] = (radii[j] + margin) * (radii[j] + margin)
    return discs


@compiled
def clearly_visible(points: Array, eye: np.record, shadow: Array, discs: Array) -> Mask:
    """Return whether points of the floor (n, 2) [m] are in view and not occluded (n,)."""
    clear = np.empty(len(points), np.bool_)
    for i in range(len(points)):
        dx, dy = points[i, 0] - eye.position[0], points[i, 1] - eye.position[1]
        clear[i] = in_view(dx, dy, eye, shadow) and not occluded(dx, dy, discs)
    return clear


@compiled
def clear_points(
    points: Array, eyes: Rows, shadow: Array, centres: Array, radii: Array, margin: float = 0.0
) -> Mask:
    """Return whether an obstacle at each point is in clear view: its top or its foot (n,).

    Args:
        points: points in W (n, 2) [m].
        eyes: record of type `Eye` (1,).
        shadow: see `in_view`.
        centres: centres of the occluding discs in W (m, 2) [m].
        radii: their radii (m,) [m].
        margin: enlargement of every disc [m].
    """
    discs = relative_discs(eyes[0], centres, radii, margin)
    return clearly_visible(points, eyes[0], shadow, discs)


@compiled
def observed_cells(
    corner: Array, cell: float, count: int, eyes: Rows, shadow: Array, centres: Array, radii: Array
) -> Marks:
    """Return which cells of a square grid a frame shows.

    Args:
        corner: index of the first column and row, counted from the origin of W (2,).
        cell: side of a cell [m].
        count: cells along a side.
        eyes: record of type `Eye` (1,).
        shadow: see `in_view`.
        centres: centres of the detected discs in W (m, 2) [m].
        radii: their radii (m,) [m].

    Returns:
        Rows along y, columns along x (count, count): UNSEEN, FREE, or OCCUPIED by a disc, whose
        whole ground counts as seen although the disc occludes half of it.
    """
    eye = eyes[0]
    discs = relative_discs(eye, centres, radii, 0.0)
    marks = np.zeros((count, count), np.uint8)
    for row in range(count):
        y = (corner[1] + row + 0.5) * cell
        for column in range(count):
            x = (corner[0] + column + 0.5) * cell
            dx, dy = x - eye.position[0], y - eye.position[1]
            if not in_view(dx, dy, eye, shadow):
                continue
            for j in range(len(radii)):
                across, up, reach = x - centres[j, 0], y - centres[j, 1], radii[j] + 0.5 * cell
                if across * across + up * up < reach * reach:
                    marks[row, column] = OCCUPIED
                    break
            if marks[row, column] == UNSEEN and not occluded(dx, dy, discs):
                marks[row, column] = FREE
    return marks


class Viewpoint(NamedTuple):
    """Camera of one frame in the field frame W, as compiled functions take it.

    Attributes:
        eye: record of type `Eye` (1,).
        shadow: distance up to which the body hides the floor, see `CameraModel` (n,) [m].
    """

    eye: Rows
    shadow: Array

    @classmethod
    def of(cls, view: CameraView, pose: Array, reach: float, margin: float = 0.0) -> "Viewpoint":
        """Transform the camera of a frame to W; a blind camera has no range.

        Args:
            view: camera in R.
            pose: x, y, heading of R in W (3,) [m, m, rad].
            reach: maximum distance of a detection along the floor [m].
            margin: border of the image that does not count [rad].
        """
        x, y, heading = pose.tolist()
        to_world = yaw_rotation(heading)
        position = to_world @ view.position
        position[0] += x
        position[1] += y
        half, top = 0.5 * view.horizontal_fov, view.model.min_top
        panoramic = half >= 0.5 * pi
        row = (
            position,
            to_world @ view.rotation,
            heading,
            cos(min(half, pi)) if panoramic else tan(max(half - margin, 0.0)),
            tan(max(0.5 * view.vertical_fov - margin, 0.0)),
            0.0 if view.blind else reach,
            top - float(position[2]) if top > 0.0 else 0.0,
            panoramic,
        )
        return cls(np.array([row], Eye), view.model.shadow)
