"""Metrics of the tracks of a run: errors, consistency, and time until movers are recognised."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from hsr8.frame_record import FrameRecord
from hsr8.world.field.layout import Obstacle
from hsr8.world.truth.truth import Truth
from navigation.belief.belief import Motion, Track

Array = NDArray[np.float64]

# Lengths are those in a world of scale 1.
MAX_MATCH_DISTANCE = 0.3  # from a track to its obstacle [m]
MAX_RANGE = 3.5  # movers farther away are not in view [m]
SETTLING_TIME = 1.0  # time in view after which the errors of a moving track count [s]


class TrackMetrics:
    """Comparison of the tracks of every camera frame with the true obstacles.

    Args:
        obstacles: of the run's world, in the order of the truth.
        scale: of the world [1].
    """

    def __init__(self, obstacles: Sequence[Obstacle], scale: float = 1.0) -> None:
        self._scale = scale
        self._colors = [o.color for o in obstacles]
        self._movers = [_Mover() if o.motion is not None else None for o in obstacles]
        self._static = _Errors()
        self._moving = _Errors()
        self._velocity = _Errors()
        self._before: float | None = None

    def add(self, frame: FrameRecord, truth: Truth) -> None:
        """Take a frame and the truth of that time."""
        time = frame.belief.time
        dt = 0.0 if self._before is None else time - self._before
        self._before = time
        tracks = [t for t in frame.belief.tracks if t.particles is None]
        owned = owners(tracks, self._colors, truth.obstacle_positions, self._scale)
        for i, track in owned.items():
            mover = self._movers[i]
            if mover is not None:
                self._follow(mover, track, truth, i, dt=dt)
            elif track.motion is Motion.STATIC:
                error = track.position - truth.obstacle_positions[i]
                self._static.add(error, track.covariance[:2, :2])

    def result(self) -> dict[str, object]:
        """Return the results by name, with units at the end; None if nothing was measured."""
        return {
            "static_track_rmse_m": self._static.rms,
            "static_track_nees_mean": self._static.nees,
            "mover_track_rmse_m": self._moving.rms,
            "mover_track_nees_mean": self._moving.nees,
            "mover_velocity_rmse_mps": self._velocity.rms,
            "mover_velocity_nees_mean": self._velocity.nees,
            "movers_recognised_after_s": [
                m.recognised_after for m in self._movers if m is not None and m.recognised
            ],
        }

    def _follow(self, mover: "_Mover", track: Track, truth: Truth, i: int, *, dt: float) -> None:
        offset = truth.obstacle_positions[i] - truth.robot[:2]
        if not track.visible or hypot(*offset.tolist()) > MAX_RANGE * self._scale:
            return
        if mover.first_seen is None:
            mover.first_seen = truth.time
        else:
            mover.in_view += dt
        if track.motion is not Motion.MOVING:
            return
        if not mover.recognised:
            mover.recognised = True
            mover.recognised_after = truth.time - mover.first_seen
        if mover.in_view > SETTLING_TIME:
            position_error = track.position - truth.obstacle_positions[i]
            self._moving.add(position_error, track.covariance[:2, :2])
            velocity_error = track.velocity - truth.obstacle_velocities[i]
            self._velocity.add(velocity_error, track.covariance[2:, 2:])


@dataclass(slots=True)
class _Mover:
    """View of one mover so far."""

    first_seen: float | None = None
    in_view: float = 0.0
    recognised: bool = False
    recognised_after: float = 0.0


class _Errors:
    """Sums of errors in the plane."""

    def __init__(self) -> None:
        self._count = 0
        self._squares = 0.0
        self._normalised = 0.0

    def add(self, error: Array, covariance: Array) -> None:
        """Add an error (2,) with its covariance (2, 2)."""
        x, y = error.tolist()
        (xx, xy), (yx, yy) = covariance.tolist()
        self._count += 1
        self._squares += x * x + y * y
        self._normalised += (yy * x * x - (xy + yx) * x * y + xx * y * y) / (xx * yy - xy * yx) / 2

    @property
    def rms(self) -> float | None:
        """Root mean square of the error, None without errors."""
        return sqrt(self._squares / self._count) if self._count else None

    @property
    def nees(self) -> float | None:
        """Normalised estimation error squared per degree of freedom, 1 if consistent."""
        return self._normalised / self._count if self._count else None


def owners(
    tracks: Sequence[Track], colors: Sequence[str], positions: Array, scale: float = 1.0
) -> dict[int, Track]:
    """Assign tracks to obstacles of their colour, the nearest pair first.

    Args:
        tracks: of a belief.
        colors: of the obstacles (n).
        positions: of the obstacles in W (n, 2) [m].
        scale: of the world [1].

    Returns:
        Track by index of the obstacle.
    """
    by_color: dict[str, list[tuple[int, float, float]]] = {}
    for i, (color, (x, y)) in enumerate(zip(colors, positions.tolist(), strict=True)):
        by_color.setdefault(color, []).append((i, x, y))
    pairs = []
    for k, track in enumerate(tracks):
        believed_x, believed_y = track.position.tolist()
        for i, x, y in by_color.get(track.label, ()):
            distance = hypot(x - believed_x, y - believed_y)
            if distance < MAX_MATCH_DISTANCE * scale:
                pairs.append((distance, k, i))
    pairs.sort()
    owned: dict[int, Track] = {}
    taken: set[int] = set()
    for _, k, i in pairs:
        if i not in owned and k not in taken:
            owned[i] = tracks[k]
            taken.add(k)
    return owned
