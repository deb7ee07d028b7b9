"""The 2-D world of the decision study: cylinders, perfect sensing, a disc that walks."""

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from belief_world import COLOURS, Obstacle, view
from numpy.typing import NDArray

from navigation.belief import Belief, Motion, Track
from navigation.decision import SpeedLimits

Array = NDArray[np.float64]

TICK, STEP_TICKS = 0.02, 17  # [s], of a footstep
S_ROBOT = 0.12  # radius of the robot [m]
LIMITS = SpeedLimits(0.20, 0.10, 0.08, 0.8, 0.3, STEP_TICKS * TICK)
TURN_ACCELERATION = 2.0  # [rad/s²]
SLIP = np.array([0.06, 0.06, 0.04])  # of a footstep, per velocity [1]
DRIFT = np.array([0.005, 0.005, 0.02])  # of a footstep [m/s, m/s, rad/s]


@dataclass
class World:
    """Everything drawn from the seed."""

    obstacles: list[Obstacle]
    start: Array
    waypoints: Array
    goal_heading: float

    def state(self, time: float) -> tuple[Array, Array]:
        """Positions and velocities of all obstacles (n, 2), (n, 2)."""
        states = [o.state(time) for o in self.obstacles]
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])


def draw_world(
    rng: np.random.Generator, statics: int, movers: int, ratio: tuple[float, float]
) -> World:
    """Draw a fair world; start again when a rule cannot be kept."""
    while True:
        world = _try_world(rng, statics, movers, ratio)
        if world is not None:
            return world


def _try_world(
    rng: np.random.Generator, statics: int, movers: int, ratio: tuple[float, float]
) -> World | None:
    points: list[Array] = []
    for _ in range(500):
        p = rng.uniform(-2.1, 2.1, 2)
        if all(np.hypot(*(p - q)) >= 1.2 for q in points):
            points.append(p)
        if len(points) == 6:
            break
    else:
        return None
    obstacles: list[Obstacle] = []
    for _ in range(2000):
        p, r = rng.uniform(-2.2, 2.2, 2), float(rng.uniform(0.05, 0.12))
        far = all(np.hypot(*(p - q)) >= S_ROBOT + 0.25 + r for q in points)
        gaps = all(np.hypot(*(p - o.start)) >= 2 * S_ROBOT + 0.16 + r + o.radius for o in obstacles)
        if far and gaps:
            obstacles.append(Obstacle(COLOURS[len(obstacles) % 4], p, p, 0.0, r))
        if len(obstacles) == statics:
            break
    else:
        return None
    still = np.array([o.start for o in obstacles])
    still_radius = np.array([o.radius for o in obstacles])
    for _ in range(3000):
        if len(obstacles) == statics + movers:
            break
        a, way = rng.uniform(-2.2, 2.2, 2), float(rng.uniform(-pi, pi))
        r, length = float(rng.uniform(0.05, 0.12)), float(rng.uniform(0.8, 2.5))
        b = a + length * np.array([cos(way), sin(way)])
        speed = 0.20 * float(rng.uniform(*ratio))
        mover = Obstacle(
            COLOURS[int(rng.integers(4))], a, b, speed, r, float(rng.uniform(0, 2 * length))
        )
        lane = a + np.linspace(0.0, 1.0, 30)[:, None] * (b - a)
        apart = np.linalg.norm(lane[:, None] - still, axis=2) - still_radius - r
        ends = min(float(np.hypot(*(e - points[-1]))) for e in (a, b))
        if (
            np.abs(b).max() < 2.3
            and apart.min() >= 0.30
            and ends >= S_ROBOT + 0.3 + r
            and np.hypot(*(mover.state(0.0)[0] - points[0])) >= 0.9 + r
        ):
            obstacles.append(mover)
    else:
        return None
    start = np.array([*points[0], rng.uniform(-pi, pi)])
    return World(obstacles, start, np.array(points[1:]), float(rng.uniform(-pi, pi)))


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
            label=o.label,
            position=positions[i],
            velocity=velocities[i],
            covariance=covariance,
            radius=o.radius,
            radius_sigma=0.0,
            motion=Motion.MOVING if o.speed else Motion.STATIC,
            hits=99,
            age=0.0,
            last_seen=positions[i],
            visible=True,
        )
        for i, o in enumerate(world.obstacles)
    )
    return Belief(
        time, pose.copy(), np.eye(3) * 1e-6, tracks, SeenMap(), view(0.0, -0.4), (), False, 0
    )


class Walker:
    """Disc with a body: rate limits, slip per footstep, odometry that does not see it."""

    def __init__(self, pose: Array, rng: np.random.Generator) -> None:
        self.pose, self.odometry = pose.copy(), np.zeros(3)
        self.command, self.body = np.zeros(3), np.zeros(3)
        self._rng = rng
        self._scale = np.array([1 + 0.03 * float(rng.standard_normal()), 1.0, 1.0])
        self._slip, self._drift = np.zeros(3), np.zeros(3)

    def latch(self, command: Array) -> None:
        """Begin a footstep."""
        self.command = command
        self._slip = self._rng.normal(0.0, SLIP)
        self._drift = self._rng.normal(0.0, DRIFT) * (np.abs(command).max() > 1e-6)

    def step(self) -> None:
        """Advance one tick."""
        change = np.array([LIMITS.acceleration] * 2 + [TURN_ACCELERATION]) * TICK
        self.body = self.body + np.clip(self.command - self.body, -change, change)
        true = self.body * (1.0 + self._slip) * self._scale + self._drift
        for velocity, pose in ((true, self.pose), (self.body, self.odometry)):
            heading = pose[2] + 0.5 * velocity[2] * TICK
            pose[0] += TICK * (cos(heading) * velocity[0] - sin(heading) * velocity[1])
            pose[1] += TICK * (sin(heading) * velocity[0] + cos(heading) * velocity[1])
            pose[2] += TICK * velocity[2]

    def motion_covariance(self, dt: float) -> Array:
        """Covariance of the odometry's error over `dt`, which lasts for a footstep each."""
        stepping = np.abs(self.command).max() > 1e-6
        speed = np.square(self.body) * (np.square(SLIP) + 0.03**2) + np.square(DRIFT) * stepping
        return np.diag(speed * dt * LIMITS.footstep)
