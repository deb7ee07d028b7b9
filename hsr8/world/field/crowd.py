"""Crowd: movers with goals that avoid one another by optimal reciprocal collision avoidance.

The settings are those of CrowdNav (Chen, Liu, Kreiss, Alahi, ICRA 2019), whose robot has a radius
of 0.3 m and a speed of 1 m/s: HSR-VIII with 0.12 m and 0.2 m/s has 0.4 of its lengths and twice its
durations. Only the margin is wider: with that of CrowdNav, people overlap by a few millimetres in
dense worlds.
"""

from math import hypot, isnan, nan

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.layout import Beacon, Layout, Obstacle
from hsr8.world.field.motion import Movers, Passage, Point, Shuttle
from navigation.baselines.half_planes import HalfPlane, orca_plane, solve

Array = NDArray[np.float64]

HALF, FULL = 0.5, 1.0  # responsibility of two that avoid each other, and for static obstacles
# In a world of scale 1 and for a robot as fast as HSR-VIII:
PERIOD = 0.5  # of decisions [s]
HORIZON = 10.0  # collision-free time [s]
MARGIN = 0.01  # added to the radii [m]
ARRIVAL = 2.0  # time to the goal below which a member slows down [s]
REACHED = 0.05  # distance from the goal at which a shuttle turns round [m]


class Crowd:
    """Movers with goals that avoid one another, static obstacles and, if they see it, the robot.

    Goals are the ends of the lanes: a shuttle goes back and forth, a passage departs at its time
    and stays. Optimal reciprocal collision avoidance: each takes half of the avoidance, all of it
    with static obstacles.
    """

    reacts = True

    def __init__(self, layout: Layout) -> None:
        movers, reactions, scale = layout.movers, layout.reactions, layout.scale
        motions = [m.motion for m in movers if isinstance(m.motion, Passage | Shuttle)]
        laws = Movers(motions)
        self._seen_radius = reactions.robot_radius if reactions.sees_robot else None
        self._reached, duration = REACHED * scale, reactions.time_scale
        self._period, self._horizon = PERIOD * duration, HORIZON * duration
        self._arrival = ARRIVAL * duration
        margin = MARGIN * scale
        self._radii = [mover.radius + margin for mover in movers]
        fixed: tuple[Obstacle | Beacon, ...] = (*layout.static, *layout.beacons)
        self._fixed = [(o.position, o.radius) for o in fixed]
        self._speeds = laws.top_speeds().tolist()
        self._departs = [m.depart if isinstance(m, Passage) else 0.0 for m in motions]
        self._turns = [isinstance(m, Shuttle) for m in motions]
        returns = [
            isinstance(m, Shuttle) and m.offset % (2.0 * m.length) > m.length for m in motions
        ]
        ends = [(m.end, m.start) for m in motions]
        self._goals = [end[back] for end, back in zip(ends, returns, strict=True)]
        self._others = [end[not back] for end, back in zip(ends, returns, strict=True)]
        self._time = 0.0
        self._robot: Point = (nan, nan)
        self._positions = laws.positions(0.0)
        self._velocities = np.zeros_like(self._positions)

    def react(self, time: float, robot: Point) -> None:
        elapsed = time - self._time
        first = isnan(self._robot[0])
        if not first and elapsed < self._period - 1e-9:
            return
        self._positions, self._time = self.positions(time), time
        moved = [a - b for a, b in zip(robot, self._robot, strict=True)]
        velocity = (0.0, 0.0) if first else (moved[0] / elapsed, moved[1] / elapsed)
        self._robot = robot
        self._velocities = np.array(self._decisions((*robot, *velocity)))

    def positions(self, times: float | Array) -> Array:
        elapsed = np.asarray(times, dtype=float)[..., None, None] - self._time
        positions: Array = self._positions + elapsed * self._velocities
        return positions

    def velocities(self, times: float | Array) -> Array:
        return np.broadcast_to(self._velocities, (*np.shape(times), *self._velocities.shape))

    def clocks(self, times: float | Array) -> Array:
        return np.zeros((*np.shape(times), 0))

    def state_bytes(self) -> bytes:
        numbers = (self._time, self._positions, self._velocities, self._goals, self._robot)
        return b"".join(np.array(n).tobytes() for n in numbers)

    def _decisions(self, robot: tuple[float, ...]) -> list[Point]:
        """Return the velocities of all members [m/s]; `robot` is x, y, vx, vy."""
        members = np.hstack([self._positions, self._velocities]).tolist()
        bodies = [(*m, r, HALF) for m, r in zip(members, self._radii, strict=True)]
        others = [(*at, 0.0, 0.0, radius, FULL) for at, radius in self._fixed]
        visible = () if self._seen_radius is None else ((*robot, self._seen_radius, HALF),)
        decisions = []
        for i, (body, top_speed) in enumerate(zip(bodies, self._speeds, strict=True)):
            near = [*bodies[:i], *bodies[i + 1 :], *others, *visible]
            near.sort(key=lambda other: hypot(other[0] - body[0], other[1] - body[1]))
            planes = [plane for other in near if (plane := self._plane(body, other, top_speed))]
            decisions.append(solve(planes, 0, self._preferred(i), top_speed))
        return decisions

    def _plane(
        self, body: tuple[float, ...], other: tuple[float, ...], top_speed: float
    ) -> HalfPlane | None:
        """Return the half-plane of velocities; None if it allows all up to the top speed.

        A body is x, y, vx, vy, radius and the responsibility for avoiding it.
        """
        x, y, vx, vy, radius, _ = body
        ox, oy, ux, uy, other_radius, responsibility = other
        reach = radius + other_radius
        # The half-plane is at that fraction of the change of velocity that leads to a meeting.
        fastest = (2.0 / responsibility - 1.0) * top_speed + hypot(ux, uy)
        if hypot(ox - x, oy - y) - reach > self._horizon * fastest:
            return None
        return orca_plane(
            (ox - x, oy - y),
            (vx - ux, vy - uy),
            (vx, vy),
            radius=reach,
            horizon=self._horizon,
            footstep=self._period,
            responsibility=responsibility,
        )

    def _preferred(self, i: int) -> Point:
        """Return the preferred velocity of a member towards its goal [m/s]."""
        if self._time < self._departs[i]:
            return 0.0, 0.0
        (gx, gy), (x, y) = self._goals[i], self._positions[i].tolist()
        if self._turns[i] and hypot(gx - x, gy - y) < self._reached:
            self._goals[i], self._others[i] = self._others[i], self._goals[i]
            gx, gy = self._goals[i]
        distance = hypot(gx - x, gy - y)
        speed = min(self._speeds[i], distance / self._arrival)
        return (
            (speed * (gx - x) / distance, speed * (gy - y) / distance) if distance else (0.0, 0.0)
        )
