"""Compiled part of visibility: which points of the floor a camera shows, and what hides them."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Marks = NDArray[np.uint8]
Camera = tuple[float, ...]

UNSEEN, FREE, COVERED = 0, 1, 2


@njit(cache=True)
def contained(dx: float, dy: float, camera: Camera) -> bool:
    """Whether one point projects into the image and lies within range.

    Args:
        dx: from the camera along x of W [m].
        dy: the same along y [m].
        camera: rows of R_WC (9,), height of the point above the camera [m], tangents of half
            the fields of view, the horizontal one negative for a camera that sees all around,
            and range [m] (13).
    """
    if dx * dx + dy * dy > camera[12] * camera[12]:
        return False
    if camera[10] < 0.0:
        return True
    dz = camera[9]
    forward = (camera[2] * dx + camera[8] * dz) + camera[5] * dy
    if forward <= 0.0:
        return False
    right = (camera[0] * dx + camera[6] * dz) + camera[3] * dy
    down = (camera[1] * dx + camera[7] * dz) + camera[4] * dy
    return bool(abs(right) <= camera[10] * forward and abs(down) <= camera[11] * forward)


@njit(cache=True)
def covered(dx: float, dy: float, discs: Array) -> bool:
    """Whether a disc nearer than one point stands on the ray to it.

    Args:
        dx: from the camera along x of W [m].
        dy: the same along y [m].
        discs: centres from the camera, squared distance and squared radius (m, 4) [m, m²].
    """
    square = dx * dx + dy * dy
    for j in range(len(discs)):
        ax, ay = discs[j, 0], discs[j, 1]
        # The ray to the point passes the disc's centre at |across| / |p|.
        if dx * ax + dy * ay > discs[j, 2]:
            across = dx * ay - dy * ax
            if across * across < discs[j, 3] * square:
                return True
    return False


@njit(cache=True)
def from_camera(eye: Array, centres: Array, radii: Array, slack: float) -> Array:
    """Discs as `covered` wants them (m, 4), widened by `slack` [m].

    Args:
        eye: position of the camera in W (3,) [m].
        centres: in W (m, 2) [m].
        radii: (m,) [m].
        slack: [m].
    """
    discs = np.empty((len(radii), 4))
    for j in range(len(radii)):
        ax, ay = centres[j, 0] - eye[0], centres[j, 1] - eye[1]
        discs[j, 0], discs[j, 1] = ax, ay
        discs[j, 2] = ax * ax + ay * ay
        discs[j, 3] = (radii[j] + slack) ** 2
    return discs


@njit(cache=True)
def expects(
    points: Array, eye: Array, camera: Camera, centres: Array, radii: Array, slack: float
) -> Mask:
    """Whether points of the floor are `contained` and not `covered`.

    Args:
        points: in W (n, 2) [m].
        eye: position of the camera in W (3,) [m].
        camera: as for `contained`.
        centres: of the discs in W (m, 2) [m].
        radii: (m,) [m].
        slack: widening of every disc [m].

    Returns:
        (n,).
    """
    discs = from_camera(eye, centres, radii, slack)
    clear = np.empty(len(points), np.bool_)
    for i in range(len(points)):
        dx, dy = points[i, 0] - eye[0], points[i, 1] - eye[1]
        clear[i] = contained(dx, dy, camera) and not covered(dx, dy, discs)
    return clear


@njit(cache=True)
def searched(
    corner: Array, cell: float, count: int, eye: Array, camera: Camera, centres: Array, radii: Array
) -> Marks:
    """What a look shows of the cells of a square grid.

    Args:
        corner: number of the first column and row from the origin of W (2,).
        cell: side of a cell [m].
        count: cells along a side.
        eye: position of the camera in W (3,) [m].
        camera: as for `contained`.
        centres: of the discs in the frame, in W (m, 2) [m].
        radii: (m,) [m].

    Returns:
        Rows along y, columns along x (count, count): UNSEEN, FREE, or COVERED by a disc, whose
        ground counts as seen although it hides half of it.
    """
    discs = from_camera(eye, centres, radii, 0.0)
    marks = np.zeros((count, count), np.uint8)
    for row in range(count):
        y = (corner[1] + row + 0.5) * cell
        for column in range(count):
            x = (corner[0] + column + 0.5) * cell
            dx, dy = x - eye[0], y - eye[1]
            if not contained(dx, dy, camera):
                continue
            for j in range(len(radii)):
                across, up, reach = x - centres[j, 0], y - centres[j, 1], radii[j] + 0.5 * cell
                if across * across + up * up < reach * reach:
                    marks[row, column] = COVERED
                    break
            if marks[row, column] == UNSEEN and not covered(dx, dy, discs):
                marks[row, column] = FREE
    return marks


@njit(cache=True)
def take_in(
    marks: Marks, seen_at: Array, log_odds: Array, time: float, evidence: tuple[float, float, float]
) -> None:
    """Write one look into a map.

    Args:
        marks: what it showed (n, n), see `searched`.
        seen_at: when each cell was seen last (n, n) [s], changed.
        log_odds: of occupancy (n, n), changed.
        time: of the look [s].
        evidence: change of the log odds of a cell seen free and of one covered, and their
            largest absolute value [1].
    """
    free, occupied, limit = evidence
    for row in range(len(marks)):
        for column in range(len(marks)):
            mark = marks[row, column]
            if mark != UNSEEN:
                seen_at[row, column] = time
                odds = log_odds[row, column] + (occupied if mark == COVERED else free)
                log_odds[row, column] = min(max(odds, -limit), limit)
