"""Data association: global nearest neighbour by colour and position."""

from math import inf

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from compilation import compiled
from navigation.belief import imm, particles
from navigation.belief.tracked_object import position_of, search_radius

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.record]


@compiled
def association_costs(
    objects: Rows,
    clouds: Array,
    detections: Rows,
    labels: Indices,
    birth: Array,
    time: float,
    parameters: Rows,
) -> Array:
    """Return the association costs relative to the birth of a track (n, m).

    A lost track has the smaller of the costs of its filters and its particles. Costs of another
    colour are infinite.

    Args:
        objects: records of type `ObjectRecord` (n,).
        clouds: their particles (n, 6, k).
        detections: records of type `DetectionRecord` (m,).
        labels: colour classes of the detections (m,).
        birth: cost of the birth of a track at each detection (m,).
        time: time of the frame [s].
        parameters: record of the parameters of tracking (1,).
    """
    p = parameters[0]
    z, R = detections["position"], detections["covariance"]
    costs = imm.costs(objects["weights"], objects["states"], objects["covariances"], z, R, p.gate)
    for i in range(len(objects)):
        o = objects[i]
        if o.lost:
            reach = search_radius(o, time, p)
            lost = particles.costs(clouds[i], z, R, o.last_seen, reach, p)
            for j in range(len(lost)):
                costs[i, j] = min(costs[i, j], lost[j])
        for j in range(len(labels)):
            costs[i, j] = costs[i, j] + birth[j] if labels[j] == o.label else inf
    return costs


def assign(costs: Array) -> tuple[Indices, Indices]:
    """Assign detections to tracks at minimum total cost; costs above 0 stay unassigned.

    Args:
        costs: costs of every pair, relative to leaving both unassigned (n, m); infinite outside
            the gate.

    Returns:
        Rows (k,) and columns (k,) of the pairs, by row.
    """
    gain = np.minimum(costs, 0.0)
    rows, columns = linear_sum_assignment(gain)
    assigned = gain[rows, columns] < 0.0
    return rows[assigned], columns[assigned]


@compiled
def is_worse(a: np.record, b: np.record, p: np.record) -> bool:
    """Return whether the first of two objects has the weaker evidence, or equal evidence."""
    confirmed, other = a.hits >= p.birth_hits, b.hits >= p.birth_hits
    if confirmed != other:
        return bool(other)
    if a.last_time != b.last_time:
        return bool(a.last_time < b.last_time)
    return bool(a.hits <= b.hits)


@compiled
def distinct(objects: Rows, time: float, parameters: Rows) -> Mask:
    """Return which tracks stay if, of two of a colour that overlap too much, the worse one goes.

    Args:
        objects: records of type `ObjectRecord` (n,).
        time: time of the frame [s]; two tracks detected in it are two obstacles.
        parameters: record of the parameters of tracking (1,).
    """
    p = parameters[0]
    kept = np.ones(len(objects), np.bool_)
    for i in range(len(objects)):
        a = objects[i]
        ax, ay = position_of(a)
        for j in range(i + 1, len(objects)):
            b = objects[j]
            if a.label != b.label or a.lost or b.lost or not (kept[i] and kept[j]):
                continue
            bx, by = position_of(b)
            dx, dy = ax - bx, ay - by
            reach = p.merge_fraction * a.radius + p.merge_fraction * b.radius
            if dx * dx + dy * dy >= reach * reach or (a.last_time == time and b.last_time == time):
                continue
            kept[i if is_worse(a, b, p) else j] = False
    return kept
