"""One tracked obstacle: detection history and motion class."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm_kernel
from navigation.belief.belief import Motion, Particles, Track
from navigation.belief.imm import Modes
from navigation.belief.particle_kernel import moments
from navigation.obstacle_kernel import deviation
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]
Estimate = tuple[Array, Array, Array, float]
"""Position (2,) [m], velocity (2,) [m/s], covariance of both (4, 4), turn rate [rad/s]."""


@dataclass(slots=True)
class TrackedObject:
    """State of one obstacle between frames; its filters are a row of the tracker's.

    Attributes:
        id: number, unique in a run.
        label: colour class.
        radius, radius_sigma: [m].
        first_time, last_time: first and latest detection [s].
        last_seen: position of the latest detection (2,) [m].
        reach_at_detection: radius of the confidence disc of that detection [m].
        motion: motion class.
        hits: number of detections.
        misses: successive misses.
        unseen_time: time in clear view since the last detection or miss [s].
        particles: while lost, else None.
        existence: likelihood of the missed detections, given the particles.
    """

    id: int
    label: str
    radius: float
    radius_sigma: float
    first_time: float
    last_time: float
    last_seen: Array
    reach_at_detection: float
    motion: Motion = Motion.UNKNOWN
    hits: int = 1
    misses: int = 0
    unseen_time: float = 0.0
    particles: Particles | None = None
    existence: float = 1.0

    def reach(self, time: float, p: TrackingParameters) -> float:
        """Return the radius of the reachable disc around its last detection [m]."""
        moving = self.motion is not Motion.STATIC
        return self.reach_at_detection + moving * p.max_speed * (time - self.last_time)

    def search_radius(self, time: float, modes: Modes, p: TrackingParameters) -> float:
        """Return the radius around its last detection in which it is searched while lost [m]."""
        return p.path_width + p.reach_factor * speed(modes) * (time - self.last_time)

    def classify(self, modes: Modes, p: TrackingParameters) -> None:
        """Update the motion class after a detection."""
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
            and speed(modes) > p.min_moving_speed
        ):
            self.motion = Motion.MOVING
        elif (
            moving < p.static_probability
            and self.hits >= p.min_static_hits
            and self.last_time - self.first_time > p.min_static_time
        ):
            self.motion = Motion.STATIC

    def track(self, time: float, p: TrackingParameters, estimate: Estimate) -> Track:
        """Return the track as of `time` [s], from `estimate` or, while lost, from the particles."""
        position, velocity, covariance, turn_rate = estimate
        if self.particles is not None:
            cloud = self.particles
            mean, covariance = moments(cloud.positions, cloud.velocities, cloud.weights)
            position, velocity = mean[:2], mean[2:4]
            turn_rate = float(cloud.weights @ cloud.turn_rates)
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


def speed(modes: Modes) -> float:
    """Return the speed of one obstacle, given that it moves [m/s]."""
    vx, vy = imm_kernel.mean(modes.weights, modes.states)[2:4].tolist()
    return sqrt(vx * vx + vy * vy)


def reach_of(covariance: Array, p: TrackingParameters) -> float:
    """Return the radius of the confidence disc of a detection of `covariance` (2, 2) [m]."""
    (xx, xy), (_, yy) = covariance.tolist()
    return p.reach_sigmas * deviation(xx, xy, yy)
