"""Waypoint search around static obstacles: Dijkstra's algorithm on a grid.

The univector field alone is trapped before walls and clusters.
"""

from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from navigation.parameters.motion import WaypointSearchParameters

Array = NDArray[np.float64]
Cells = NDArray[np.int64]

_STEPS = ((1, 0), (0, 1), (1, 1), (1, -1))


def search_waypoint(
    position: Array,
    target: Array,
    centres: Array,
    radii: Array,
    parameters: WaypointSearchParameters,
) -> Array:
    """Return the farthest point of the shortest path with a free line of sight (2,) [m].

    Args:
        position: position of the robot (2,) [m].
        target: destination (2,) [m].
        centres: centres of the static obstacles (n, 2) [m].
        radii: minimum distances of the robot from them (n,) [m].
        parameters: cell, reach and margin of the grid.

    Returns:
        `target` if the straight path is free or no path exists.
    """
    if _free(position, target, centres, radii):
        return target
    waypoint = target
    for point in shortest_path(position, target, centres, radii, parameters):
        distance = hypot(*(point - position).tolist())
        if distance > parameters.reach or not _free(position, point, centres, radii):
            break
        waypoint = point
    return waypoint


def shortest_path(
    position: Array,
    target: Array,
    centres: Array,
    radii: Array,
    parameters: WaypointSearchParameters,
) -> Array:
    """Return cell centres from the robot to the destination (m, 2) [m]; m = 0 without a path."""
    p = parameters
    low = np.minimum(position, target) - p.around
    shape = [ceil(side / p.cell) for side in (np.maximum(position, target) + p.around - low)]
    rows, columns = np.indices(shape)
    points = low + p.cell * (np.stack([rows.ravel(), columns.ravel()], axis=1) + 0.5)
    start, end = (int(np.argmin(np.hypot(*(points - q).T))) for q in (position, target))
    if start == end:
        return np.zeros((0, 2))
    offset = points[:, None] - centres
    open_ = ~np.any(np.hypot(offset[..., 0], offset[..., 1]) < radii, axis=1)
    open_[[start, end]] = True
    number = np.arange(len(points), dtype=np.int64).reshape(shape)
    ends = [_neighbours(number, step) for step in _STEPS]
    here, there = (np.concatenate([e[k] for e in ends]) for k in (0, 1))
    both = open_[here] & open_[there]
    here, there = here[both], there[both]
    length = np.hypot(*(points[here] - points[there]).T)
    graph = coo_array((length, (here, there)), shape=(len(points), len(points))).tocsr()
    distance, previous = dijkstra(graph, directed=False, indices=[end], return_predecessors=True)
    if not np.isfinite(distance[0, start]):
        return np.zeros((0, 2))
    cells = []
    cell = start
    while cell != end:
        cell = int(previous[0, cell])
        cells.append(cell)
    path: Array = points[cells]
    path[-1] = target
    return path


def _neighbours(number: Cells, step: tuple[int, int]) -> tuple[Cells, Cells]:
    """Return pairs of cells that are one `step` apart."""
    i, j = step
    rows, columns = number.shape
    here = number[: rows - i, max(0, -j) : columns - max(0, j)]
    there = number[i:, max(0, j) : columns - max(0, -j)]
    return here.ravel(), there.ravel()


def _free(start: Array, end: Array, centres: Array, radii: Array) -> bool:
    """Whether the segment from `start` to `end` stays outside every radius, or leads out of it."""
    along = end - start
    square = float(along @ along)
    offset = centres - start
    fraction = np.clip(offset @ along / max(square, 1e-12), 0.0, 1.0)
    gap = np.hypot(*(offset - fraction[:, None] * along).T)
    inside = np.hypot(*offset.T) < radii
    return not bool(np.any((gap < radii) & ~(inside & (fraction == 0.0))))
