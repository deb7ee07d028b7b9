"""Wandering movers: constant speed along a smooth closed track with left and right bends."""

from math import pi

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.motion import Point, Wander

Array = NDArray[np.float64]

CORNERS = 192  # of the polygon that approximates the track
FINE = 1024  # samples of the curve from which the corners are chosen
COARSE = 128  # samples of the curve for its curvature
MIN_BEND_RADIUS = 0.08  # in a world of scale 1 [m]
TRACKS = 24  # drawn at a time; the first one with gentle bends is used
BATCHES = 8
ORDER = np.arange(1, 4)  # of the harmonics of x and y
AMPLITUDES = np.array(
    [
        [[1.0, 0.3, 0.08], [1.0, 0.3, 0.08]],  # loops with dents
        [[1.0, 0.2, 0.05], [0.2, 0.8, 0.05]],  # figures of eight
    ]
)  # maximum amplitudes of the harmonics [1]


def draw_wander(
    rng: np.random.Generator, centre: Point, extent: float, speed: float, scale: float = 1.0
) -> Wander | None:
    """Draw a mover that wanders around `centre`.

    Args:
        rng: draws track and offset.
        centre: centre of the bounding box of the track [m].
        extent: longer side of that box [m].
        speed: speed of the mover [m/s].
        scale: scale of the world [1].

    Returns:
        The law; None if no track of that extent has gentle bends.
    """
    for _ in range(BATCHES):
        size = (
            rng.uniform(0.5, 1.0, (TRACKS, 2, 3))
            * AMPLITUDES[rng.integers(len(AMPLITUDES), size=TRACKS)]
        )
        shift = rng.uniform(-pi, pi, size.shape)
        box, bend = _shape(size, shift, COARSE)
        size_ratio = extent / np.ptp(box, axis=2).max(axis=1)
        gentle = np.flatnonzero(size_ratio * bend >= MIN_BEND_RADIUS * scale)
        if len(gentle) == 0:
            continue
        k = gentle[0]
        curve = _curve(size[k], shift[k], FINE)
        middle = 0.5 * (curve.max(axis=1) + curve.min(axis=1))
        track, side = _equal_sides(size_ratio[k] * (curve - middle[:, None]).T)
        offset = float(rng.uniform(0.0, CORNERS * side))
        corners = (track + np.asarray(centre)).tolist()
        return Wander(tuple((x, y) for x, y in corners), side, speed, offset)
    return None


def _curve(size: Array, shift: Array, n: int) -> Array:
    """Return points (..., n) of closed curves with harmonics of `size` and `shift` (..., h)."""
    phase = np.linspace(0.0, 2.0 * pi, n, endpoint=False)
    harmonics = size[..., None] * np.cos(ORDER[:, None] * phase + shift[..., None])
    points: Array = harmonics.sum(axis=-2)
    return points


def _shape(size: Array, shift: Array, n: int) -> tuple[Array, Array]:
    """Return `n` points (m, 2, n) of curves (m, 2, h) and their minimum bend radii (m,)."""
    points = _curve(size, shift, n)
    rate = _curve(size * ORDER, shift + 0.5 * pi, n)
    change = _curve(-size * ORDER**2, shift, n)
    speed = np.hypot(rate[:, 0], rate[:, 1])
    turn = np.abs(rate[:, 0] * change[:, 1] - rate[:, 1] * change[:, 0])
    radius: Array = (speed**3 / np.maximum(turn, 1e-12)).min(axis=1)
    return points, radius


def _equal_sides(curve: Array) -> tuple[Array, float]:
    """Return a polygon (CORNERS, 2) with equal sides on a closed curve, and the side [m].

    Equal arcs have nearly equal chords; a few iterations make them equal.
    """
    closed = np.vstack([curve, curve[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0.0, arc[-1], CORNERS + 1)
    for _ in range(8):
        corners = np.stack([np.interp(at, arc, closed[:, k]) for k in (0, 1)], axis=1)
        chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        at = np.interp(np.linspace(0.0, chord[-1], CORNERS + 1), chord, at)
    corners = np.stack([np.interp(at, arc, closed[:, k]) for k in (0, 1)], axis=1)
    sides = np.hypot(*np.diff(corners, axis=0).T)
    return corners[:-1], float(sides.mean())
