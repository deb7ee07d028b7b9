"""Tracks as one structured array, readable one by one as `Track`."""

from collections.abc import Iterator, Sequence
from math import sqrt
from typing import Annotated, overload

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from navigation.belief.belief import Motion, Particles, Track

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.record]

MOTIONS = (Motion.STATIC, Motion.MOVING, Motion.UNKNOWN)
STATIC, MOVING, UNKNOWN = range(3)
X, Y, VX, VY, TURN_RATE, WEIGHT = range(6)  # rows of a cloud of particles


@record_class
class TrackRecord:
    """Record of a track: the fields of `Track`, speed and major standard deviations."""

    id: int
    label: int  # index in the labels of the set
    position: Annotated[Array, 2]  # [m]
    velocity: Annotated[Array, 2]  # [m/s]
    covariance: Annotated[Array, 4, 4]  # of position and velocity
    radius: float  # [m]
    radius_sigma: float  # [m]
    motion: int  # index in MOTIONS
    hits: int
    age: float  # [s]
    last_seen: Annotated[Array, 2]  # [m]
    visible: bool
    cloud: int  # index in the clouds of the set, -1 for none
    reach: float  # [m]
    turn_rate: float  # [rad/s]
    speed: float  # [m/s]
    sigma: float  # major standard deviation of the position [m]
    speed_sigma: float  # major standard deviation of the velocity [m/s]


NUMBERS = ("id", "radius", "radius_sigma", "hits", "age", "visible", "reach", "turn_rate")
VECTORS = ("position", "velocity", "covariance", "last_seen")
"""Fields of `Track` that are those of its record."""


@compiled
def deviation(xx: float, xy: float, yy: float) -> float:
    """Return the square root of the larger eigenvalue of a symmetric matrix (2, 2)."""
    half = 0.5 * (xx - yy)
    return sqrt(max(0.5 * (xx + yy) + sqrt(half * half + xy * xy), 0.0))


@compiled
def measure(rows: Rows) -> None:
    """Set speed and major standard deviations of tracks in place; a static track has speed 0."""
    for i in range(len(rows)):
        row = rows[i]
        if row.motion == STATIC:
            row.velocity[0] = row.velocity[1] = 0.0
        vx, vy, P = row.velocity[0], row.velocity[1], row.covariance
        row.speed = sqrt(vx * vx + vy * vy)
        row.sigma = deviation(P[0, 0], P[0, 1], P[1, 1])
        row.speed_sigma = deviation(P[2, 2], P[2, 3], P[3, 3])


def max_deviation(covariance: Array) -> float:
    """Return sqrt(lambda_max) of a symmetric matrix (2, 2)."""
    (xx, xy), (_, yy) = covariance.tolist()
    return deviation(xx, xy, yy)


class Tracks(Sequence[Track]):
    """n tracks in the field frame W, the input of all decisions.

    Args:
        rows: records of type `TrackRecord` (n,), not changed later.
        clouds: particles of the lost tracks: x, y, vx, vy, turn rate, weight (k, 6, m).
        labels: colour classes, to which the records refer.

    Attributes:
        rows, clouds, labels: arguments.
        ids: track numbers (n,).
        position: (n, 2) [m].
        velocity: over ground, zero if static (n, 2) [m/s].
        speed: its norm (n,) [m/s].
        radius: (n,) [m].
        sigma: square root of the largest eigenvalue of the position covariance (n,) [m].
        static: whether the tracker has classified each as static (n,).
        lost: tracks with particles (n,).
        age: time since the latest detection (n,) [s].
    """

    def __init__(self, rows: Rows, clouds: Array, labels: Sequence[str]) -> None:
        self.rows, self.clouds, self.labels = rows.view(TrackRecord), clouds, labels
        self.ids: Ints = rows["id"]
        self.position: Array = rows["position"]
        self.velocity: Array = rows["velocity"]
        self.speed: Array = rows["speed"]
        self.radius: Array = rows["radius"]
        self.sigma: Array = rows["sigma"]
        self.static: Mask = rows["motion"] == STATIC
        self.lost: Mask = rows["cloud"] >= 0
        self.age: Array = rows["age"]
        self._tracks: list[Track] | None = None

    @classmethod
    def of(cls, tracks: Sequence[Track]) -> "Tracks":
        """Return tracks as one array; without a copy if they are one."""
        if isinstance(tracks, Tracks):
            return tracks
        labels = sorted({t.label for t in tracks})
        rows, clouds = np.zeros(len(tracks), TrackRecord), list[Array]()
        for row, t in zip(rows, tracks, strict=True):
            row.id, row.label, row.motion = t.id, labels.index(t.label), MOTIONS.index(t.motion)
            row.position, row.velocity, row.covariance = t.position, t.velocity, t.covariance
            row.radius, row.radius_sigma, row.hits, row.age = (
                t.radius,
                t.radius_sigma,
                t.hits,
                t.age,
            )
            row.last_seen, row.visible, row.reach = t.last_seen, t.visible, t.reach
            row.turn_rate, row.cloud = t.turn_rate, -1
            if t.particles is not None:
                row.cloud = len(clouds)
                p = t.particles
                clouds.append(np.vstack([p.positions.T, p.velocities.T, p.turn_rates, p.weights]))
        measure(rows)
        return cls(rows, np.array(clouds) if clouds else np.zeros((0, 6, 1)), labels)

    def __len__(self) -> int:
        return len(self.rows)

    @overload
    def __getitem__(self, index: int) -> Track: ...

    @overload
    def __getitem__(self, index: slice) -> "Tracks": ...

    def __getitem__(self, index: int | slice) -> "Track | Tracks":
        if isinstance(index, slice):
            return Tracks(self.rows[index], self.clouds, self.labels)
        return self._views()[index]

    def __iter__(self) -> Iterator[Track]:
        return iter(self._views())

    def where(self, mask: Mask) -> "Tracks":
        """Return the tracks for which `mask` (n,) holds."""
        return Tracks(self.rows[mask], self.clouds, self.labels)

    def moved(self, time: float) -> "Tracks":
        """Return the tracks at constant velocity after `time` [s]."""
        rows = self.rows.copy()
        rows["position"] += time * rows["velocity"]
        return Tracks(rows, self.clouds, self.labels)

    def _views(self) -> list[Track]:
        """Return the tracks one by one, made at the first call."""
        if self._tracks is None:
            columns = [self.rows[name].tolist() for name in NUMBERS]
            columns += [list(self.rows[name]) for name in VECTORS]
            self._tracks = [
                Track(
                    label=self.labels[label],
                    motion=MOTIONS[motion],
                    particles=_particles(self.clouds[cloud]) if cloud >= 0 else None,
                    **dict(zip((*NUMBERS, *VECTORS), values, strict=True)),
                )
                for label, motion, cloud, *values in zip(
                    *(self.rows[name].tolist() for name in ("label", "motion", "cloud")),
                    *columns,
                    strict=True,
                )
            ]
        return self._tracks


def join(first: Sequence[Track], second: Sequence[Track]) -> Tracks:
    """Return the tracks of two sets in one."""
    a, b = Tracks.of(first), Tracks.of(second)
    rows = np.concatenate([a.rows, b.rows])
    rows["label"][len(a) :] += len(a.labels)
    rows["cloud"][len(a) :][b.lost] += len(a.clouds)
    clouds = b.clouds if not len(a.clouds) else a.clouds
    if len(a.clouds) and len(b.clouds):
        clouds = np.concatenate([a.clouds, b.clouds])
    return Tracks(rows, clouds, (*a.labels, *b.labels))


def _particles(cloud: Array) -> Particles:
    """Return a cloud (6, m) as particles."""
    return Particles(cloud[:VX].T, cloud[VX:TURN_RATE].T, cloud[TURN_RATE], cloud[WEIGHT])
