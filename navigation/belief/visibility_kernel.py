"""Compiled part of visibility: field of view, range and occlusion of points of the floor."""

from math import atan2, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Marks = NDArray[np.uint8]
Camera = tuple[float, ...]

UNSEEN, FREE, OCCUPIED = 0, 1, 2


@compiled
def in_image(dx: float, dy: float, dz: float, camera: Camera) -> bool:
    """Return whether a point projects into the image; its position from the camera [m]."""
    forward = (camera[2] * dx + camera[8] * dz) + camera[5] * dy
    if forward <= 0.0:
        return False
    right = (camera[0] * dx + camera[6] * dz) + camera[3] * dy
    down = (camera[1] * dx + camera[7] * dz) + camera[4] * dy
    return bool(abs(right) <= camera[10] * forward and abs(down) <= camera[11] * forward)


@compiled
def in_shadow(dx: float, dy: float, heading: float, shadow: Array) -> bool:
    """Return whether the robot's own body hides a point of the floor.

    Args:
        dx: from the camera along x of W [m].
        dy: from the camera along y [m].
        heading: of the robot [rad].
        shadow: distance up to which the body hides the floor, in equal steps of the bearing (n,).
    """
    step = round((atan2(dy, dx) - heading) * len(shadow) / (2.0 * pi))
    reach = shadow[int(step) % len(shadow)]
    return bool(dx * dx + dy * dy < reach * reach)


@compiled
def in_view(dx: float, dy: float, camera: Camera, shadow: Array) -> bool:
    """Return whether the image shows an obstacle at a point of the floor: its top or its foot.

    Args:
        dx: from the camera along x of W [m].
        dy: from the camera along y [m].
        camera: rows of R_WC (9,), height of the floor above the camera [m], tangents of half
            the fields of view, range [m], height of the top of an obstacle above the camera, 0
            where only the foot counts [m], and heading [rad] (15). A panoramic camera has a
            negative horizontal tangent, then the cosine of half its horizontal field of view.
        shadow: see `in_shadow`.
    """
    if dx * dx + dy * dy > camera[12] * camera[12]:
        return False
    if camera[10] < 0.0:
        across = (camera[2] * camera[2] + camera[5] * camera[5]) * (dx * dx + dy * dy)
        return bool(camera[2] * dx + camera[5] * dy >= camera[11] * sqrt(across))
    if camera[13] < 0.0 and in_image(dx, dy, camera[13], camera):
        return True
    return in_image(dx, dy, camera[9], camera) and not in_shadow(dx, dy, camera[14], shadow)


@compiled
def occluded(dx: float, dy: float, discs: Array) -> bool:
    """Return whether a nearer disc intersects the ray to a point.

    Args:
        dx: from the camera along x of W [m].
        dy: from the camera along y [m].
        discs: see `relative_discs`.
    """
    square = dx * dx + dy * dy
    for j in range(len(discs)):
        ax, ay = discs[j, 0], discs[j, 1]
        # The ray passes the disc's centre at a distance of |across| / |p|.
        if dx * ax + dy * ay > discs[j, 2]:
            across = dx * ay - dy * ax
            if across * across < discs[j, 3] * square:
                return True
    return False


@compiled
def relative_discs(eye: Array, centres: Array, radii: Array, margin: float) -> Array:
    """Return discs relative to the camera: x, y, squared distance and radius (m, 4) [m, m²].

    Args:
        eye: position of the camera in W (3,) [m].
        centres: in W (m, 2) [m].
        radii: (m,) [m].
        margin: enlargement of every disc [m].
    """
    discs = np.empty((len(radii), 4))
    for j in range(len(radii)):
        ax, ay = centres[j, 0] - eye[0], centres[j, 1] - eye[1]
        discs[j, 0], discs[j, 1] = ax, ay
        discs[j, 2] = ax * ax + ay * ay
        discs[j, 3] = (radii[j] + margin) * (radii[j] + margin)
    return discs


@compiled
def in_clear_view(
    points: Array,
    eye: Array,
    camera: Camera,
    shadow: Array,
    centres: Array,
    radii: Array,
    margin: float,
) -> Mask:
    """Return whether points of the floor are in view and not occluded (n,).

    Args:
        points: in W (n, 2) [m].
        eye: position of the camera in W (3,) [m].
        camera: see `in_view`.
        shadow: see `in_shadow`.
        centres: of the discs in W (m, 2) [m].
        radii: (m,) [m].
        margin: enlargement of every disc [m].
    """
    discs = relative_discs(eye, centres, radii, margin)
    clear = np.empty(len(points), np.bool_)
    for i in range(len(points)):
        dx, dy = points[i, 0] - eye[0], points[i, 1] - eye[1]
        clear[i] = in_view(dx, dy, camera, shadow) and not occluded(dx, dy, discs)
    return clear


@compiled
def observed_cells(
    corner: Array,
    cell: float,
    count: int,
    eye: Array,
    camera: Camera,
    shadow: Array,
    centres: Array,
    radii: Array,
) -> Marks:
    """Return which cells of a square grid a frame shows.

    Args:
        corner: index of the first column and row, counted from the origin of W (2,).
        cell: side of a cell [m].
        count: cells along a side.
        eye: position of the camera in W (3,) [m].
        camera: see `in_view`.
        shadow: see `in_shadow`.
        centres: of the detected discs in W (m, 2) [m].
        radii: (m,) [m].

    Returns:
        Rows along y, columns along x (count, count): UNSEEN, FREE, or OCCUPIED by a disc, whose
        whole ground counts as seen although the disc occludes half of it.
    """
    discs = relative_discs(eye, centres, radii, 0.0)
    marks = np.zeros((count, count), np.uint8)
    for row in range(count):
        y = (corner[1] + row + 0.5) * cell
        for column in range(count):
            x = (corner[0] + column + 0.5) * cell
            dx, dy = x - eye[0], y - eye[1]
            if not in_view(dx, dy, camera, shadow):
                continue
            for j in range(len(radii)):
                across, up, reach = x - centres[j, 0], y - centres[j, 1], radii[j] + 0.5 * cell
                if across * across + up * up < reach * reach:
                    marks[row, column] = OCCUPIED
                    break
            if marks[row, column] == UNSEEN and not occluded(dx, dy, discs):
                marks[row, column] = FREE
    return marks


@compiled
def update_grid(
    marks: Marks, seen_at: Array, log_odds: Array, time: float, evidence: tuple[float, float, float]
) -> None:
    """Update a grid by one frame, in place.

    Args:
        marks: of the frame (n, n), see `observed_cells`.
        seen_at: time at which each cell was last seen (n, n) [s].
        log_odds: of occupancy (n, n).
        time: of the frame [s].
        evidence: change of the log odds of a free and of an occupied cell, and their maximum
            absolute value [1].
    """
    free, occupied, limit = evidence
    for row in range(len(marks)):
        for column in range(len(marks)):
            mark = marks[row, column]
            if mark != UNSEEN:
                seen_at[row, column] = time
                odds = log_odds[row, column] + (occupied if mark == OCCUPIED else free)
                log_odds[row, column] = min(max(odds, -limit), limit)
