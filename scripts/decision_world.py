"""2-D world of the decision study: layout, perfect sensing, outline of the walking body."""

from dataclasses import dataclass
from math import cos, pi, sin

from hsr8.world.field.layout import Layout
from navigation.belief.belief import Belief, Motion, Track
from navigation.decision import SpeedLimits

import numpy as np
from belief_world import view
from numpy.typing import NDArray

Array = NDArray[np.float64]

TICK = 0.02  # [s]
_HALF = (0.114, 0.137, 0.140, 0.147, 0.143, 0.137, 0.130, 0.121, 0.126, 0.128, 0.122, 0.109, 0.089)
OUTLINE = np.array([*_HALF, *_HALF[-2:0:-1]])
"""Reach of the walking body at each of `OUTLINE_BEARING` from R, feet and hands, in full
physics: the 99th percentile over a walk with turns [m]."""
OUTLINE_BEARING = np.radians(np.arange(0.0, 360.0, 15.0))
TURN_ACCELERATION = 2.0  # [rad/s²]
SLIP = np.array([0.01, 0.01, 0.01])  # of a footstep, per velocity [1]
DRIFT = np.array([0.001, 0.001, 0.003])  # of a footstep [m/s, m/s, rad/s]


@dataclass
class World:
    """2-D view of a layout.

    Attributes:
        layout: static obstacles first, movers after.
        radii: of all obstacles (n,) [m].
        beacons: position by name [m].
    """

    layout: Layout

    def __post_init__(self) -> None:
        self.radii = np.array([o.radius for o in self.layout.obstacles])
        self.beacons = {b.name: b.position for b in self.layout.beacons}
        self._movers = self.layout.motion()
        self._still = np.array([o.position for o in self.layout.static]).reshape(-1, 2)

    def state(self, time: float) -> tuple[Array, Array]:
        """Positions and velocities of all obstacles (n, 2), (n, 2)."""
        positions = np.concatenate([self._still, self._movers.positions(time)])
        velocities = np.concatenate([0.0 * self._still, self._movers.velocities(time)])
        return positions, velocities

    def gaps(self, time: float, pose: Array) -> Array:
        """Distance of the body's outline to every obstacle (n,) [m]."""
        offset = self.state(time)[0] - pose[:2]
        bearing = np.arctan2(offset[:, 1], offset[:, 0]) - pose[2]
        reach = np.interp(bearing, OUTLINE_BEARING, OUTLINE, period=2.0 * pi)
        gaps: Array = np.hypot(offset[:, 0], offset[:, 1]) - self.radii - reach
        return gaps


class SeenMap:
    """Local map of perfect sensing: everything is fresh."""

    def confidence_at(self, points: Array) -> Array:
        """One everywhere."""
        return np.ones(len(points))

    def age_at(self, points: Array) -> Array:
        """Zero everywhere."""
        return np.zeros(len(points))


def perfect_belief(time: float, pose: Array, world: World) -> Belief:
    """The truth as a belief."""
    positions, velocities = world.state(time)
    covariance = np.diag([1e-4, 1e-4, 1e-5, 1e-5])
    tracks = tuple(
        Track(
            id=i,
            label=o.color,
            position=positions[i],
            velocity=velocities[i],
            covariance=covariance,
            radius=o.radius,
            radius_sigma=0.0,
            motion=Motion.MOVING if o.motion is not None else Motion.STATIC,
            hits=99,
            age=0.0,
            last_seen=positions[i],
            visible=True,
        )
        for i, o in enumerate(world.layout.obstacles)
    )
    return Belief(
        time, pose.copy(), np.eye(3) * 1e-6, tracks, SeenMap(), view(0.0, -0.4), (), False, 0
    )


class Walker:
    """A body with rate limits, slip per footstep, and odometry that does not see it."""

    def __init__(self, pose: Array, limits: SpeedLimits, rng: np.random.Generator) -> None:
        self._limits = limits
        self.pose, self.odometry = pose.copy(), np.zeros(3)
        self.command, self.body = np.zeros(3), np.zeros(3)
        self._rng = rng
        self._slip, self._drift = np.zeros(3), np.zeros(3)
        self._ticks = 0  # of the present footstep
        self.yaw_rate = 0.0  # which pulsates with the footsteps [rad/s]

    def latch(self, command: Array) -> None:
        """Begin a footstep."""
        self.command, self._ticks = command, 0
        self._slip = self._rng.normal(0.0, SLIP)
        self._drift = self._rng.normal(0.0, DRIFT) * (np.abs(command).max() > 1e-6)

    def step(self) -> None:
        """Advance one tick."""
        change = np.array([self._limits.acceleration] * 2 + [TURN_ACCELERATION]) * TICK
        self.body = self.body + np.clip(self.command - self.body, -change, change)
        phase = 2.0 * pi * (self._ticks + 0.5) * TICK / self._limits.footstep
        self._ticks += 1
        self.yaw_rate = float(self.body[2]) * (1.0 - cos(phase))
        measured = np.array([self.body[0], self.body[1], self.yaw_rate])
        true = measured * (1.0 + self._slip) + self._drift
        for velocity, pose in ((true, self.pose), (measured, self.odometry)):
            heading = pose[2] + 0.5 * velocity[2] * TICK
            pose[0] += TICK * (cos(heading) * velocity[0] - sin(heading) * velocity[1])
            pose[1] += TICK * (sin(heading) * velocity[0] + cos(heading) * velocity[1])
            pose[2] += TICK * velocity[2]

    def motion_covariance(self, dt: float) -> Array:
        """Covariance of the odometry's error over `dt`, which lasts for a footstep each."""
        stepping = np.abs(self.command).max() > 1e-6
        speed = np.square(self.body) * np.square(SLIP) + np.square(DRIFT) * stepping
        return np.diag(speed * dt * self._limits.footstep)
