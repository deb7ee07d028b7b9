"""The tracks as arrays, the form in which all decisions are computed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navigation.belief import Motion, Track

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class ObstacleSet:
    """n obstacles in the field frame W.

    Attributes:
        ids: track numbers (n,).
        position: (n, 2) [m].
        velocity: over ground, zero if static (n, 2) [m/s].
        speed: its norm (n,) [m/s].
        radius: (n,) [m].
        sigma: square root of the largest eigenvalue of the position covariance (n,) [m].
        speed_sigma: the same of the velocity (n,) [m/s].
        static, moving: verdicts of the tracker (n,); neither means undecided.
        age: time since last seen (n,) [s].
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

    def __len__(self) -> int:
        return len(self.ids)

    @classmethod
    def from_tracks(cls, tracks: Sequence[Track]) -> "ObstacleSet":
        """Stack `tracks`; a track classified static has speed 0."""
        n = len(tracks)
        static = np.array([t.motion is Motion.STATIC for t in tracks], dtype=np.bool_)
        covariance = np.array([t.covariance for t in tracks]).reshape(n, 4, 4)
        velocity = np.array([t.velocity for t in tracks], dtype=np.float64).reshape(n, 2)
        velocity[static] = 0.0
        return cls(
            ids=np.array([t.id for t in tracks], dtype=np.int64),
            position=np.array([t.position for t in tracks], dtype=np.float64).reshape(n, 2),
            velocity=velocity,
            speed=np.hypot(velocity[:, 0], velocity[:, 1]),
            radius=np.array([t.radius for t in tracks], dtype=np.float64),
            sigma=largest_deviation(covariance[:, :2, :2]),
            speed_sigma=largest_deviation(covariance[:, 2:, 2:]),
            static=static,
            moving=np.array([t.motion is Motion.MOVING for t in tracks], dtype=np.bool_),
            age=np.array([t.age for t in tracks], dtype=np.float64),
        )

    def where(self, mask: Mask) -> "ObstacleSet":
        """The obstacles for which `mask` (n,) holds."""
        return ObstacleSet(
            self.ids[mask],
            self.position[mask],
            self.velocity[mask],
            self.speed[mask],
            self.radius[mask],
            self.sigma[mask],
            self.speed_sigma[mask],
            self.static[mask],
            self.moving[mask],
            self.age[mask],
        )


def largest_deviation(covariance: Array) -> Array:
    """sqrt(lambda_max) of symmetric 2 x 2 matrices of shape (..., 2, 2), shape (...)."""
    mean = 0.5 * (covariance[..., 0, 0] + covariance[..., 1, 1])
    half = 0.5 * (covariance[..., 0, 0] - covariance[..., 1, 1])
    largest = mean + np.hypot(half, covariance[..., 0, 1])
    deviation: Array = np.sqrt(np.maximum(largest, 0.0))
    return deviation
