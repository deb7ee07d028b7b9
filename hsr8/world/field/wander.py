"""Wandering: round a smooth closed track that bends left and right, at constant speed."""

from dataclasses import dataclass
from math import floor, pi

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]

CORNERS = 192  # of the polygon that stands for the smooth track
FINE = 1024  # points from which the corners are chosen
ROUGH = 128  # points at which the bends of a track are looked at
BEND = 0.08  # least radius of curvature [m]
TRACKS = 24  # tracks drawn at a time, the first that bends gently enough is taken
BATCHES = 8
ORDER = np.arange(1, 4)  # of the waves that x and y are made of, once round being the first
WAVES = np.array(
    [
        [[1.0, 0.3, 0.08], [1.0, 0.3, 0.08]],  # loops with dents
        [[1.0, 0.2, 0.05], [0.2, 0.8, 0.05]],  # figures of eight
    ]
)  # greatest sizes of these waves [1]


@dataclass(frozen=True, slots=True)
class Wander:
    """Round a closed polygon of equal, short sides at constant speed.

    Attributes:
        track: corners of the polygon, all sides of one length [m].
        side: that length [m].
        speed: [m/s].
        offset: way it has gone at time zero, from the first corner [m].
    """

    track: tuple[Point, ...]
    side: float
    speed: float
    offset: float = 0.0

    @property
    def length(self) -> float:
        """Once round [m]."""
        return self.side * len(self.track)

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        (x, y), (x_next, y_next), share = self._where(time)
        return x + share * (x_next - x), y + share * (y_next - y)

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]; at a corner, the one it leaves with."""
        (x, y), (x_next, y_next), _ = self._where(time)
        rate = self.speed / self.side
        return rate * (x_next - x), rate * (y_next - y)

    def _where(self, time: float) -> tuple[Point, Point, float]:
        """Corner behind, corner ahead, and the share of the side between that is gone."""
        sides = (self.offset + self.speed * time) / self.side
        whole = floor(sides)
        n = len(self.track)
        return self.track[whole % n], self.track[(whole + 1) % n], sides - whole


def draw_wander(
    rng: np.random.Generator, centre: Point, extent: float, speed: float
) -> Wander | None:
    """A mover that wanders about `centre`.

    Args:
        rng: draws the track, the sense and where it begins.
        centre: middle of the box around the track [m].
        extent: longer side of that box [m].
        speed: [m/s].

    Returns:
        The law; None if no track of that extent bends gently enough.
    """
    for _ in range(BATCHES):
        size = rng.uniform(0.5, 1.0, (TRACKS, 2, 3)) * WAVES[rng.integers(len(WAVES), size=TRACKS)]
        shift = rng.uniform(-pi, pi, size.shape)
        box, bend = _shape(size, shift, ROUGH)
        scale = extent / np.ptp(box, axis=2).max(axis=1)
        gentle = np.flatnonzero(scale * bend >= BEND)
        if len(gentle) == 0:
            continue
        k = gentle[0]
        curve = _curve(size[k], shift[k], FINE)
        middle = 0.5 * (curve.max(axis=1) + curve.min(axis=1))
        track, side = _equal_sides(scale[k] * (curve - middle[:, None]).T)
        offset = float(rng.uniform(0.0, CORNERS * side))
        corners = (track + np.asarray(centre)).tolist()
        return Wander(tuple((x, y) for x, y in corners), side, speed, offset)
    return None


def _curve(size: Array, shift: Array, n: int) -> Array:
    """Points (..., n) of closed curves made of waves of some `size` and `shift` (..., h)."""
    phase = np.linspace(0.0, 2.0 * pi, n, endpoint=False)
    waves = size[..., None] * np.cos(ORDER[:, None] * phase + shift[..., None])
    points: Array = waves.sum(axis=-2)
    return points


def _shape(size: Array, shift: Array, n: int) -> tuple[Array, Array]:
    """`n` points (m, 2, n) of curves (m, 2, h) and their least radii of curvature (m,)."""
    points = _curve(size, shift, n)
    rate = _curve(size * ORDER, shift + 0.5 * pi, n)
    change = _curve(-size * ORDER**2, shift, n)
    speed = np.hypot(rate[:, 0], rate[:, 1])
    turn = np.abs(rate[:, 0] * change[:, 1] - rate[:, 1] * change[:, 0])
    least: Array = (speed**3 / np.maximum(turn, 1e-12)).min(axis=1)
    return points, least


def _equal_sides(curve: Array) -> tuple[Array, float]:
    """Corners (CORNERS, 2) of a polygon with equal sides on a closed curve, and the side [m].

    Equal arcs have nearly equal chords; a few corrections make them equal.
    """
    closed = np.vstack([curve, curve[:1]])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0.0, way[-1], CORNERS + 1)
    for _ in range(8):
        corners = np.stack([np.interp(at, way, closed[:, k]) for k in (0, 1)], axis=1)
        chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        at = np.interp(np.linspace(0.0, chord[-1], CORNERS + 1), chord, at)
    corners = np.stack([np.interp(at, way, closed[:, k]) for k in (0, 1)], axis=1)
    sides = np.hypot(*np.diff(corners, axis=0).T)
    return corners[:-1], float(sides.mean())
