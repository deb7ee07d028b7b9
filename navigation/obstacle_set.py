"""Tracks as arrays, the input of all decisions."""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Motion, Track
from navigation.obstacle_kernel import deviation, deviations
from navigation.value import value

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@value
class ObstacleSet:
    """n obstacles in the field frame W.

    Attributes:
        ids: track numbers (n,).
        position: (n, 2) [m].
        velocity: over ground, zero if static (n, 2) [m/s].
        speed: its norm (n,) [m/s].
        radius: (n,) [m].
        sigma: square root of the largest eigenvalue of the position covariance (n,) [m].
        speed_sigma: square root of the largest eigenvalue of the velocity covariance (n,) [m/s].
        static, moving: classification by the tracker (n,); neither means undecided.
        age: time since the latest detection (n,) [s].
        turn_rate: of the velocity, left positive (n,) [rad/s].
    """

    ids: NDArray[np.int64]
    position: Array
    velocity: Array
    speed: Array
    radius: Array
    sigma: Array
    speed_sigma: Array
    static: Mask
    moving: Mask
    age: Array
    turn_rate: Array

    def __len__(self) -> int:
        return len(self.ids)

    @classmethod
    def from_tracks(cls, tracks: Sequence[Track]) -> "ObstacleSet":
        """Stack `tracks`; a static track has speed 0."""
        n = len(tracks)
        static = np.array([t.motion is Motion.STATIC for t in tracks], dtype=np.bool_)
        covariances = np.array([t.covariance for t in tracks], dtype=np.float64)
        sigma, speed_sigma = deviations(covariances.reshape(n, 4, 4))
        velocity = np.array([t.velocity for t in tracks], dtype=np.float64).reshape(n, 2)
        velocity[static] = 0.0
        return cls(
            ids=np.array([t.id for t in tracks], dtype=np.int64),
            position=np.array([t.position for t in tracks], dtype=np.float64).reshape(n, 2),
            velocity=velocity,
            speed=np.hypot(velocity[:, 0], velocity[:, 1]),
            radius=np.array([t.radius for t in tracks], dtype=np.float64),
            sigma=sigma,
            speed_sigma=speed_sigma,
            static=static,
            moving=np.array([t.motion is Motion.MOVING for t in tracks], dtype=np.bool_),
            age=np.array([t.age for t in tracks], dtype=np.float64),
            turn_rate=np.array([t.turn_rate for t in tracks], dtype=np.float64),
        )

    def where(self, mask: Mask) -> "ObstacleSet":
        """Return the obstacles for which `mask` (n,) holds."""
        return ObstacleSet(*(getattr(self, f.name)[mask] for f in fields(self)))


def possible_positions(tracks: Sequence[Track]) -> tuple[NDArray[np.int64], Array, Array]:
    """Return where tracks may be: at their positions, or at the particles of lost ones.

    Args:
        tracks: at least one.

    Returns:
        Index of the track (m,), position in W (m, 2) [m] and weight (m,), which sums to one for
        each track.
    """
    clouds = [track.particles for track in tracks]
    positions = [
        track.position[None] if cloud is None else cloud.positions
        for track, cloud in zip(tracks, clouds, strict=True)
    ]
    weights = [np.ones(1) if cloud is None else cloud.weights for cloud in clouds]
    owner = np.repeat(np.arange(len(clouds)), [len(w) for w in weights])
    return owner, np.concatenate(positions), np.concatenate(weights)


def max_deviation(covariance: Array) -> float:
    """Return sqrt(lambda_max) of a symmetric matrix (2, 2)."""
    (xx, xy), (_, yy) = covariance.tolist()
    return deviation(xx, xy, yy)
