"""One obstacle as the tracker keeps it between frames, and the verdict whether it moves."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm, track_particles
from navigation.belief.belief import Motion, Particles, Track
from navigation.belief.imm import Modes
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]
Estimate = tuple[Array, Array, Array, float]
"""Position (2,) [m], velocity (2,) [m/s], covariance of both (4, 4), turn rate [rad/s]."""


@dataclass(slots=True)
class TrackedObject:
    """History of one obstacle; its filters are a row of the tracker's.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        radius, radius_sigma: [m].
        first_time, last_time: first and latest detection [s].
        last_seen: where the latest detection put it (2,) [m].
        known_reach: radius of the disc about it that surely contained its axis then [m].
        motion: verdict.
        hits: number of detections.
        misses: detections that failed in a row although expected.
        expected_for: time in clear view since the last detection or miss [s].
        particles: hypotheses while lost, else None.
        presence: probability of what was not seen since, given the particles.
    """

    id: int
    label: str
    radius: float
    radius_sigma: float
    first_time: float
    last_time: float
    last_seen: Array
    known_reach: float
    motion: Motion = Motion.UNKNOWN
    hits: int = 1
    misses: int = 0
    expected_for: float = 0.0
    particles: Particles | None = None
    presence: float = 1.0

    def reach(self, time: float, p: TrackingParameters) -> float:
        """Radius of the disc about its last sighting that it cannot have left [m]."""
        moving = self.motion is not Motion.STATIC
        return self.known_reach + moving * p.max_speed * (time - self.last_time)

    def lost_reach(self, time: float, modes: Modes, p: TrackingParameters) -> float:
        """How far from its last sighting it is looked for while lost, by its filters [m]."""
        speed = imm.speed(modes)
        return p.path_width + p.reach_factor * speed * (time - self.last_time)

    def classify(self, modes: Modes, p: TrackingParameters) -> None:
        """Revise the verdict after a detection, by its filters."""
        moving = float(modes.moving)
        if self.motion is Motion.STATIC:
            if moving > p.static_exit_probability:
                self.motion = Motion.UNKNOWN
        elif self.motion is Motion.MOVING:
            if moving < p.moving_exit_probability:
                self.motion = Motion.STATIC
        elif (
            moving > p.moving_probability
            and self.hits >= p.min_moving_hits
            and imm.speed(modes) > p.min_moving_speed
        ):
            self.motion = Motion.MOVING
        elif (
            moving < p.static_probability
            and self.hits >= p.min_static_hits
            and self.last_time - self.first_time > p.min_static_time
        ):
            self.motion = Motion.STATIC

    def track(self, time: float, p: TrackingParameters, estimate: Estimate) -> Track:
        """Publish it as of `time` [s]: `estimate`, or what its particles say if it is lost."""
        position, velocity, covariance, turn_rate = estimate
        if self.particles is not None:
            mean, covariance = track_particles.moments(self.particles)
            position, velocity = mean[:2], mean[2:4]
            turn_rate = float(self.particles.weights @ self.particles.turn_rates)
        return Track(
            id=self.id,
            label=self.label,
            position=position,
            velocity=velocity,
            covariance=covariance,
            radius=self.radius,
            radius_sigma=self.radius_sigma,
            motion=self.motion,
            hits=self.hits,
            age=time - self.last_time,
            last_seen=self.last_seen.copy(),
            visible=self.last_time == time,
            particles=self.particles,
            reach=self.reach(time, p),
            turn_rate=turn_rate,
        )


def reach_of(covariance: Array, p: TrackingParameters) -> float:
    """Radius of the disc about a sighting of `covariance` (2, 2) that surely contains its axis."""
    (xx, xy), (_, yy) = covariance.tolist()
    # The larger half axis of the sighting's ellipse.
    largest = 0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy)
    reach: float = p.reach_sigmas * largest**0.5
    return reach
