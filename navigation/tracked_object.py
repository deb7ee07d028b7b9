"""One obstacle as the tracker keeps it between frames, and the verdict whether it moves."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navigation.belief import Motion, Particles, Track
from navigation.belief_parameters import TrackingParameters
from navigation.track_particles import moments

Array = NDArray[np.float64]

STANDING_SPEED_SIGMA = 0.005
"""Standard deviation of the velocity of a static track as it is published [m/s]."""


@dataclass(slots=True)
class TrackedObject:
    """Filters and history of one obstacle.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        state, covariance: constant-velocity filter, x, y, vx, vy (4,), (4, 4).
        still, still_covariance: static filter, x, y (2,), (2, 2).
        radius, radius_sigma: [m].
        first_time, last_time: first and latest detection [s].
        last_seen: where the latest detection put it (2,) [m].
        evidence: log likelihood ratio of moving against standing still.
        motion: verdict.
        hits: number of detections.
        misses: detections that failed in a row although expected.
        expected_for: time in clear view since the last detection or miss [s].
        particles: hypotheses while lost, else None.
        presence: probability of what was not seen since, given the particles.
        lag: how far it lags behind going on, summed [standard deviations].
        on_course: when that sum was zero last [s].
    """

    id: int
    label: str
    state: Array
    covariance: Array
    still: Array
    still_covariance: Array
    radius: float
    radius_sigma: float
    first_time: float
    last_time: float
    last_seen: Array
    evidence: float = 0.0
    motion: Motion = Motion.UNKNOWN
    hits: int = 1
    misses: int = 0
    expected_for: float = 0.0
    particles: Particles | None = None
    presence: float = 1.0
    lag: float = 0.0
    on_course: float = 0.0

    @property
    def position(self) -> Array:
        """Best position in W (2,) [m]."""
        if self.particles is not None:
            mean: Array = self.particles.weights @ self.particles.positions
            return mean
        return self.still if self.motion is Motion.STATIC else self.state[:2]

    @property
    def speed(self) -> float:
        """Speed of the constant-velocity filter [m/s]."""
        return float(np.hypot(self.state[2], self.state[3]))

    def classify(self, p: TrackingParameters) -> None:
        """Revise the verdict after a detection."""
        if self.motion is Motion.STATIC:
            if self.evidence > p.doubt_evidence:
                self.motion = Motion.UNKNOWN
        elif self.motion is Motion.MOVING:
            if self.evidence < p.stopped_evidence:
                self.motion = Motion.STATIC
        elif (
            self.evidence > p.moving_evidence
            and self.hits >= p.moving_hits
            and self.speed > p.moving_speed
        ):
            self.motion = Motion.MOVING
        elif (
            self.evidence < p.static_evidence
            and self.hits >= p.static_hits
            and self.last_time - self.first_time > p.static_time
            and self.speed < p.static_speed
        ):
            self.motion = Motion.STATIC

    def track(self, time: float) -> Track:
        """Publish a copy as of `time` [s]."""
        if self.particles is not None:
            mean, covariance = moments(self.particles)
        elif self.motion is Motion.STATIC:
            mean = np.concatenate([self.still, np.zeros(2)])
            covariance = np.zeros((4, 4))
            covariance[:2, :2] = self.still_covariance
            covariance[2, 2] = covariance[3, 3] = STANDING_SPEED_SIGMA**2
        else:
            mean, covariance = self.state, self.covariance.copy()
        return Track(
            id=self.id,
            label=self.label,
            position=mean[:2].copy(),
            velocity=mean[2:].copy(),
            covariance=covariance,
            radius=self.radius,
            radius_sigma=self.radius_sigma,
            motion=self.motion,
            hits=self.hits,
            age=time - self.last_time,
            last_seen=self.last_seen.copy(),
            visible=self.last_time == time,
            particles=self.particles,
        )
