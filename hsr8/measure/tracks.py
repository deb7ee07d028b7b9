"""Metrics of the tracks of a run: errors, consistency, and time until movers are recognised."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.measure.statistics import mean, root_mean
from hsr8.recording.table import Table
from hsr8.world.field.layout import Layout
from navigation.belief.belief import Motion

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]

# Lengths are those in a world of scale 1.
MAX_MATCH_DISTANCE = 0.3  # from a track to its obstacle [m]
MAX_RANGE = 3.5  # movers farther away are not in view [m]
SETTLING_TIME = 1.0  # time in view after which the errors of a moving track count [s]


def track_metrics(
    frames: Table, truth: dict[str, Array], layout: Layout, undisturbed: Mask
) -> dict[str, object]:
    """Compare the tracks of every camera frame with the true obstacles.

    Args:
        frames: camera frames of the run.
        truth: columns of the records at the frames.
        layout: layout of the run's world.
        undisturbed: frames in which consistency is measured (f,).

    Returns:
        Results by name, with units at the end; None if nothing was measured.
    """
    tracks = frames["tracks"]
    tracked = np.flatnonzero(~tracks["lost"])
    chosen, obstacle = owners(
        tracks["label"][tracked],
        tracks["position"][tracked],
        tracks.parents[tracked],
        [o.color for o in layout.obstacles],
        truth["obstacle_positions"],
        scale=layout.scale,
    )
    chosen = tracked[chosen]
    row, motion = tracks.parents[chosen], tracks["motion"][chosen]
    position = truth["obstacle_positions"][row, obstacle]
    away = np.hypot(*(position - truth["robot"][row, :2]).T)
    visible = tracks["visible"][chosen] & (away <= MAX_RANGE * layout.scale)
    time = frames["time"]
    elapsed = np.diff(time, prepend=time[:1])
    settled = np.zeros(len(chosen), dtype=bool)
    recognised_after = []
    movers = [i for i, o in enumerate(layout.obstacles) if o.motion is not None]
    for i in movers:
        views = np.flatnonzero(visible & (obstacle == i))
        recognised = views[motion[views] == Motion.MOVING.value]
        if not len(recognised):
            continue
        first, last = truth["time"][row[[views[0], recognised[0]]]].tolist()
        recognised_after.append(last - first)
        in_view = elapsed[row[views]]
        in_view[0] = 0.0
        settled[views] = np.cumsum(in_view) > SETTLING_TIME
    moving = settled & (motion == Motion.MOVING.value)
    static = ~np.isin(obstacle, movers) & (motion == Motion.STATIC.value)
    error = tracks["position"][chosen] - position
    velocity_error = tracks["velocity"][chosen] - truth["obstacle_velocities"][row, obstacle]
    covariance = tracks["covariance"][chosen]
    of_position, of_velocity = covariance[:, :2, :2], covariance[:, 2:, 2:]
    calm = undisturbed[row]
    return {
        **_errors("static_track", "rmse_m", error, of_position, counted=static, calm=calm),
        **_errors("mover_track", "rmse_m", error, of_position, counted=moving, calm=calm),
        **_errors(
            "mover_velocity", "rmse_mps", velocity_error, of_velocity, counted=moving, calm=calm
        ),
        "movers_recognised_after_s": recognised_after,
    }


def _errors(
    name: str, unit: str, error: Array, covariance: Array, *, counted: Mask, calm: Mask
) -> dict[str, object]:
    """Return root mean square and consistency of errors (n, 2) with covariances (n, 2, 2).

    The normalised estimation error squared (NEES) is per degree of freedom, 1 if consistent. Only
    the errors `counted` (n,) count, in the NEES only those that are `calm` (n,), too.
    """
    root = root_mean(np.sum(np.square(error[counted]), axis=1))
    x, y = error[counted & calm].T
    xx, xy, yx, yy = covariance[counted & calm].reshape(-1, 4).T
    normalised = (yy * x * x - (xy + yx) * x * y + xx * y * y) / (xx * yy - xy * yx) / 2
    return {f"{name}_{unit}": root, f"{name}_nees_mean": mean(normalised)}


def owners(
    labels: NDArray[Any],
    positions: Array,
    rows: Indices,
    colors: Sequence[str],
    obstacles: Array,
    *,
    scale: float,
) -> tuple[Indices, Indices]:
    """Assign the tracks of every frame to obstacles of their colour, the nearest pair first.

    Args:
        labels: labels of the tracks (t,).
        positions: positions of the tracks in W (t, 2) [m].
        rows: frame of each track (t,).
        colors: colours of the obstacles (n).
        obstacles: positions in W in every frame (f, n, 2) [m].
        scale: scale of the world [1].

    Returns:
        Numbers of the owning tracks (k,) and of their obstacles (k,).
    """
    places = np.reshape(obstacles, (len(obstacles), len(colors), 2))[rows]
    offset = places - positions[:, None]
    distance = np.hypot(offset[..., 0], offset[..., 1])
    same = labels[:, None] == np.array(colors, dtype=object)
    tracks, near = np.nonzero(same & (distance < MAX_MATCH_DISTANCE * scale))
    order = np.lexsort((near, tracks, distance[tracks, near], rows[tracks]))
    owned: dict[tuple[int, int], int] = {}
    taken: set[int] = set()
    for row, k, i in np.stack((rows[tracks], tracks, near), axis=1)[order].tolist():
        if k not in taken and (row, i) not in owned:
            owned[row, i] = k
            taken.add(k)
    return np.array([*owned.values()], dtype=np.intp), np.array([i for _, i in owned], np.intp)
