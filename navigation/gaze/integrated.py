"""Integrated gaze: the highest centre of the gaze map, Yoo & Kim, eqs. (1)-(6).

The partial evaluations (1) to (4) are in `navigation.partial_evaluation`. Each has candidates,
directions that it asks for. A candidate votes with weight and evaluation for all gazes that show
it; the gaze map is the sum of the votes.
"""

from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from compilation.value import value
from navigation.angles import wrap
from navigation.gaze.grid import GazeGrid
from navigation.gaze.policy import Gaze, GazePolicy
from navigation.gaze.scene import GazeScene
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ROUNDING = 1e-9  # of angles, and of values relative to the maximum


class IntegratedGaze(GazePolicy[None]):
    """Gaze at the highest centre of the gaze map, eq. (6).

    Args:
        parameters: parameters of the decisions.
        grid: cells of the gaze map.
    """

    steady = True
    stabilized = True

    def __init__(self, parameters: NavigationParameters, grid: GazeGrid) -> None:
        self._parameters = parameters
        self._grid = grid

    def begin(self) -> None:
        return None

    def look(self, memory: None, scene: GazeScene, now: Gaze) -> tuple[Gaze, Array, None]:
        view = scene.belief.view
        field_of_view = view.horizontal_fov, view.vertical_fov
        gm = gaze_map(integrated_votes(scene, self._parameters), self._grid, field_of_view)
        return highest_centre(gm, self._grid, now), gm, None


@value
class Votes:
    """Weighted candidates.

    Attributes:
        pan: pan of each candidate (n,) [rad].
        tilt: tilt of each candidate (n,) [rad].
        value: weight times partial evaluation (n,) [1].
    """

    pan: Array
    tilt: Array
    value: Array


def integrated_votes(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the votes of the four partial evaluations, the terms of eq. (6)."""
    return join(
        [
            map_vote(scene, parameters),
            waypoint_vote(scene, parameters),
            self_votes(scene, parameters),
            obstacle_votes(scene, parameters),
        ]
    )


def map_vote(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the vote of psi_lm, eq. (1), at the mean of the under-confident points."""
    under = scene.map.under_confident
    if not under.any():
        return join([])
    pan = float(scene.samples.bearing[under].mean())
    tilt = -float(np.arctan2(scene.camera_height, scene.samples.distance[under]).mean())
    return one_vote(pan, tilt, parameters.gaze.w_lm * scene.map.psi)


def waypoint_vote(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the vote of psi_way, eq. (4), at the floor towards the waypoint."""
    e, p, pose = parameters.evaluation, parameters.gaze, scene.belief.pose
    dx, dy = (scene.task.target - pose[:2]).tolist()
    pan = min(max(wrap(atan2(dy, dx) - float(pose[2])), -p.max_pan), p.max_pan)
    tilt = -atan2(scene.camera_height, min(max(hypot(dx, dy), e.d_nm), e.d_fm))
    return one_vote(pan, tilt, p.w_way * scene.psi_way)


def self_votes(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the votes of psi_sf, eq. (2), at obstacles and beacons.

    The printed mean is over obstacles and beacons together, so that the gaze map stays within 1.
    Beacons are at the height of the horizon.
    """
    p = parameters.gaze
    _, pan, tilt = aims(scene, parameters)
    beacons = np.clip(scene.beacon_bearing, -p.max_pan, p.max_pan)
    pan, tilt = np.concatenate([pan, beacons]), np.concatenate([tilt, np.zeros(len(beacons))])
    return Votes(pan, tilt, np.full(len(pan), p.w_sf * scene.psi_sf / max(1, len(pan))))


def obstacle_votes(scene: GazeScene, parameters: NavigationParameters) -> Votes:
    """Return the votes of psi_ob, eq. (3), at the obstacles; their mean."""
    members, pan, tilt = aims(scene, parameters)
    return Votes(pan, tilt, parameters.gaze.w_ob * scene.psi_ob[members] / max(1, len(pan)))


def aims(scene: GazeScene, parameters: NavigationParameters) -> tuple[Mask, Array, Array]:
    """Return the obstacles of O within reach (n,), and pan and tilt to each (k,), (k,) [rad]."""
    limit, height = parameters.gaze.max_pan, parameters.evaluation.aim_height
    members = scene.attended & scene.reachable
    pan = np.clip(scene.bearing[members], -limit, limit)
    return members, pan, np.arctan2(height - scene.camera_height, scene.distance[members])


def one_vote(pan: float, tilt: float, value: float) -> Votes:
    """Return a single vote."""
    return Votes(np.array([pan]), np.array([tilt]), np.array([value]))


def join(parts: list[Votes]) -> Votes:
    """Concatenate votes."""
    nothing = np.zeros(0)
    return Votes(
        np.concatenate([nothing, *(p.pan for p in parts)]),
        np.concatenate([nothing, *(p.tilt for p in parts)]),
        np.concatenate([nothing, *(p.value for p in parts)]),
    )


def gaze_map(votes: Votes, grid: GazeGrid, field_of_view: tuple[float, float]) -> Array:
    """Return GM (tilts, pans), the sum of the regions R of all votes, eqs. (5) and (6).

    A region is a box of the field of view around the candidate. The weights of (6) are in the
    values of the votes.

    Args:
        votes: votes of the partial evaluations.
        grid: cells of the gaze map.
        field_of_view: horizontal and vertical field of view of the camera [rad].
    """
    across, above = (0.5 * angle + ROUNDING for angle in field_of_view)
    pans = np.abs(grid.pan - votes.pan[:, None]) <= across
    tilts = np.abs(grid.tilt - votes.tilt[:, None]) <= above
    total: Array = (tilts * votes.value[:, None]).T @ pans.astype(np.float64)
    return total


def highest_centre(gaze_map: Array, grid: GazeGrid, now: Gaze) -> Gaze:
    """Return theta* of eq. (6), the centre of the largest plateau of maximum GM.

    Of plateaus of equal size the one nearest to the present gaze wins, then the smaller pan.
    If the centroid is outside its plateau, the nearest member replaces it.

    Args:
        gaze_map: GM (tilts, pans).
        grid: its cells.
        now: present pan and tilt [rad].

    Returns:
        Pan and tilt [rad]; the present gaze if GM is zero everywhere.
    """
    top = float(gaze_map.max())
    if top <= 0.0:
        return now
    labels, _ = ndimage.label(gaze_map >= top - ROUNDING * max(1.0, top))
    sizes = np.bincount(labels.ravel())[1:]
    largest = (np.flatnonzero(sizes == sizes.max()) + 1).tolist()
    centres = [plateau_centre(labels == label) for label in largest]

    def order(cell: tuple[int, int]) -> tuple[float, float, int]:
        row, column = cell
        distance = abs(grid.pan[column] - now[0]) + abs(grid.tilt[row] - now[1])
        return round(float(distance), 9), float(grid.pan[column]), row

    row, column = min(centres, key=order)
    return float(grid.pan[column]), float(grid.tilt[row])


def plateau_centre(member: Mask) -> tuple[int, int]:
    """Return row and column of the member nearest to the centroid of a plateau (tilts, pans)."""
    rows, columns = np.nonzero(member)
    centre_row, centre_column = float(rows.mean()), float(columns.mean())
    row, column = round(centre_row), round(centre_column)
    if member[row, column]:
        return row, column
    nearest = int(np.argmin((rows - centre_row) ** 2 + (columns - centre_column) ** 2))
    return int(rows[nearest]), int(columns[nearest])
