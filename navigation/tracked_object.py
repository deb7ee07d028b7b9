"""One obstacle as the tracker keeps it between frames, and the verdict whether it moves."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation import mode_kernel, motion_modes, track_particles
from navigation.belief import Motion, Particles, Track
from navigation.belief_parameters import TrackingParameters
from navigation.motion_modes import STILL, Modes

Array = NDArray[np.float64]


@dataclass(slots=True)
class TrackedObject:
    """Filters and history of one obstacle.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        modes: filters of standing still, going on and having turned back.
        radius, radius_sigma: [m].
        first_time, last_time: first and latest detection [s].
        last_seen: where the latest detection put it (2,) [m].
        seen_covariance: of that (2, 2) [m²].
        best_covariance: of the most precise detection (2, 2) [m²].
        motion: verdict.
        hits: number of detections.
        misses: detections that failed in a row although expected.
        expected_for: time in clear view since the last detection or miss [s].
        particles: hypotheses while lost, else None.
        presence: probability of what was not seen since, given the particles.
    """

    id: int
    label: str
    modes: Modes
    radius: float
    radius_sigma: float
    first_time: float
    last_time: float
    last_seen: Array
    seen_covariance: Array
    best_covariance: Array
    motion: Motion = Motion.UNKNOWN
    hits: int = 1
    misses: int = 0
    expected_for: float = 0.0
    particles: Particles | None = None
    presence: float = 1.0

    @property
    def position(self) -> Array:
        """Best position in W (2,) [m]."""
        if self.particles is not None:
            mean: Array = self.particles.weights @ self.particles.positions
            return mean
        if self.motion is Motion.STATIC:
            return self.modes.states[STILL, :2]
        return motion_modes.mean(self.modes)[:2]

    @property
    def speed(self) -> float:
        """Speed if it moves [m/s]."""
        return hypot(*motion_modes.mean(self.modes)[2:4].tolist())

    def estimate(self, p: TrackingParameters) -> tuple[Array, Array]:
        """Mean (5,) and covariance (5, 5) of x, y, vx, vy, turn rate under the verdict."""
        if self.motion is not Motion.STATIC:
            return motion_modes.moments(self.modes)
        return mode_kernel.standing(
            self.modes.states,
            self.modes.covariances,
            self.best_covariance,
            p.lasting_error**2,
            p.static_velocity_sigma**2,
        )

    def reach(self, time: float, p: TrackingParameters) -> float:
        """Radius of the disc about its last sighting that it cannot have left [m]."""
        (xx, xy), (_, yy) = self.seen_covariance.tolist()
        # The larger half axis of the sighting's ellipse.
        largest = 0.5 * (xx + yy) + hypot(0.5 * (xx - yy), xy)
        known: float = p.reach_sigmas * largest**0.5
        moving = self.motion is not Motion.STATIC
        return known + moving * p.top_speed * (time - self.last_time)

    def lost_reach(self, time: float, p: TrackingParameters) -> float:
        """How far from its last sighting it is looked for while lost [m]."""
        return p.line_width + p.reach_factor * self.speed * (time - self.last_time)

    def classify(self, p: TrackingParameters) -> None:
        """Revise the verdict after a detection."""
        moving = float(self.modes.moving)
        if self.motion is Motion.STATIC:
            if moving > p.doubted:
                self.motion = Motion.UNKNOWN
        elif self.motion is Motion.MOVING:
            if moving < p.stopped:
                self.motion = Motion.STATIC
        elif moving > p.recognised and self.hits >= p.moving_hits and self.speed > p.moving_speed:
            self.motion = Motion.MOVING
        elif (
            moving < p.standing
            and self.hits >= p.static_hits
            and self.last_time - self.first_time > p.static_time
        ):
            self.motion = Motion.STATIC

    def track(self, time: float, p: TrackingParameters) -> Track:
        """Publish a copy as of `time` [s]."""
        if self.particles is not None:
            mean, covariance = track_particles.moments(self.particles)
            turn_rate = float(self.particles.weights @ self.particles.turn_rates)
        else:
            mean, covariance = self.estimate(p)
            turn_rate = float(mean[4])
        return Track(
            id=self.id,
            label=self.label,
            position=mean[:2],
            velocity=mean[2:4],
            covariance=covariance[:4, :4],
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
