"""One attempt to draw a world: objects are drawn one after the other, each at a fair position."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, pi, radians, sin
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.mission import Course, Points, Tour
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track import Recording
from hsr8.scenario.world import Mover, TrackMover
from hsr8.world.field.circle_crossing import draw_crossing
from hsr8.world.field.encounter import NominalWalk, course_to, passage_through, starts_near
from hsr8.world.field.lane import Lane, apart_at_all_times, distance, motion_law
from hsr8.world.field.layout import Layout, Obstacle, beacons_of, sizes_of
from hsr8.world.field.motion import Circle, MotionLaw, Point, Shuttle
from hsr8.world.field.wander import draw_wander

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

COLORS = ("red", "green", "blue", "violet")
BATCH = 64  # candidate positions drawn at a time
MAX_BATCHES = 30  # per object
MAX_LANES = 300  # per mover
# Maximum offset of a lane between walls from the route, along x and y, in a world of scale 1 [m].
ROUTE_OFFSET = 0.30
START_TURN = radians(60.0)  # maximum angle between the start heading and the first via point [rad]


@dataclass(frozen=True, slots=True)
class FairDistances:
    """Minimum distances.

    Attributes:
        static_gap: distance between static obstacles [m].
        start_to_static: distance from the start, a point [m].
        start_to_mover: distance from the start, a point [m].
        point_to_static: distance from via points and goal [m].
        lane_to_static: distance between a mover and a static obstacle [m].
        lane_to_lane: distance between two movers [m].
        lane_to_goal: distance between a reversing mover and the goal, a point [m].
        point_to_border: distance from the border to points that the robot must reach [m].
        obstacle_to_border: distance from the border to obstacles [m].
    """

    static_gap: float
    start_to_static: float
    start_to_mover: float
    point_to_static: float
    lane_to_static: float
    lane_to_lane: float
    lane_to_goal: float
    point_to_border: float
    obstacle_to_border: float

    @classmethod
    def of(cls, scenario: Scenario) -> Self:
        """Return the distances for the robot and the scale of a world."""
        radius, scale = scenario.robot.radius, scenario.world.scale
        return cls(
            static_gap=2.0 * radius + 0.16 * scale,
            start_to_static=0.35 * scale,
            start_to_mover=0.90 * scale,
            point_to_static=radius + 0.25 * scale,
            lane_to_static=0.30 * scale,
            lane_to_lane=0.05 * scale,
            lane_to_goal=radius + 0.30 * scale,
            point_to_border=0.35 * scale,
            obstacle_to_border=0.05 * scale,
        )


class CrowdedError(Exception):
    """No room for an object in this attempt."""


class Attempt:
    """Draws one world.

    Args:
        scenario: scenario with sections world, mission and robot.
        rng: draws everything.

    Attributes:
        tried: lanes tried for movers, without encounters [1].
    """

    def __init__(self, scenario: Scenario, rng: np.random.Generator) -> None:
        self._scenario = scenario
        self._world = scenario.world
        self._sizes = sizes_of(scenario.world)
        self._rng = rng
        self.tried = 0
        self._fair = FairDistances.of(scenario)
        self._half = 0.5 * np.asarray(scenario.world.size)
        self._static: list[Obstacle] = []
        self._lanes: list[Lane] = []

    def layout(self) -> Layout:
        """Draw lanes, which need most room, then static obstacles, start, points and encounters.

        Raises:
            CrowdedError: an object has no room.
        """
        world = self._world
        start = self._scenario.robot.start.position
        points = self._given_points()
        self._lanes = [lane for mover in world.mover for lane in self._placed(mover, start)]
        self._static = [self._cylinder(o.position, o.radius, o.color) for o in world.obstacle]
        for wall in world.wall:
            for k, position in enumerate(wall.positions(self._scenario.robot.radius)):
                # Neighbours differ in colour, so that vision can separate them.
                color = COLORS[k % len(COLORS)]
                self._static.append(self._cylinder(position, wall.radius, color))
        for _ in range(world.n_moving):
            self._lanes.append(self._draw_mover(start, points))
        self._draw_static(start, points)
        if start is None:
            start = self._draw_point("the start", self._start_clear)
        if points is None:
            points = self._draw_points(start)
        self._draw_encounters(start, points)
        self._draw_circle([start, *points[-1:]])
        return Layout(
            field_size=world.size,
            obstacles=(*self._static, *(lane.obstacle for lane in self._lanes)),
            beacons=beacons_of(world, self._sizes),
            start=(*start, self._start_heading(start, points)),
            waypoints=np.array(points, dtype=float).reshape(-1, 2),
            goal_heading=self._goal_heading(),
            endless=self._is_endless(),
            sizes=self._sizes,
            scale=world.scale,
        )

    def _cylinder(
        self, position: Point, radius: float, color: str, motion: MotionLaw | None = None
    ) -> Obstacle:
        """Return an obstacle, with a motion a mover."""
        return Obstacle(position, radius, self._sizes.top, color, motion)

    def _placed(self, mover: Mover, start: Point | None) -> list[Lane]:
        """Return the movers of a section; those of a recording begin at a drawn time."""
        if not isinstance(mover, TrackMover):
            return [self._lane(motion_law(mover), mover.radius, mover.color)]
        recording = Recording(self._scenario, mover)
        begin = recording.start
        if mover.latest_start is not None:
            begin = float(self._rng.uniform(begin, mover.latest_start))
        lanes = [
            self._lane(track, mover.radius, mover.color or COLORS[k % len(COLORS)])
            for k, track in enumerate(recording.tracks(begin))
        ]
        if mover.latest_start is not None and start is not None:
            room = mover.radius + self._fair.start_to_mover
            if any(
                distance(np.array([start]), [lane.obstacle.position])[0] < room for lane in lanes
            ):
                raise CrowdedError("the start among recorded movers")
        return lanes

    def _lane(self, motion: MotionLaw, radius: float, color: str) -> Lane:
        """Return a mover with its lane."""
        mover = self._cylinder(motion.position(0.0), radius, color, motion)
        return Lane.of(mover, self._world.scale, self._scenario.time_scale)

    def _given_points(self) -> list[Point] | None:
        mission = self._scenario.mission
        if isinstance(mission, Points):
            return list(mission.points)
        return None if isinstance(mission, Tour | Course) else []

    def _is_endless(self) -> bool:
        mission = self._scenario.mission
        return isinstance(mission, Tour) or (isinstance(mission, Points) and mission.endless)

    def _has_goal(self) -> bool:
        return isinstance(self._scenario.mission, Course | Points) and not self._is_endless()

    def _goal_heading(self) -> float | None:
        mission = self._scenario.mission
        if isinstance(mission, Course | Points) and mission.goal_heading_deg is not None:
            return radians(mission.goal_heading_deg)
        return float(self._rng.uniform(-pi, pi)) if isinstance(mission, Course) else None

    def _start_heading(self, start: Point, points: Sequence[Point]) -> float:
        given = self._scenario.robot.start.heading_deg
        if given is not None:
            return radians(given)
        turn = float(self._rng.uniform(-1.0, 1.0))
        if not points:
            return turn * pi
        ahead = float(np.arctan2(points[0][1] - start[1], points[0][0] - start[0]))
        return float(np.angle(np.exp(1j * (ahead + turn * START_TURN))))

    def _draw_static(self, start: Point | None, points: Sequence[Point] | None) -> None:
        for _ in range(self._world.n_static):
            radius = self._radius()

            def clear(p: Array, radius: float = radius) -> Mask:
                free: Mask = self._static_gap(p) - radius >= self._fair.static_gap
                if start is not None:
                    free &= distance(p, [start]) - radius >= self._fair.start_to_static
                if points:
                    free &= distance(p, points) - radius >= self._fair.point_to_static
                for lane in self._lanes:
                    gap = distance(p, lane.path) - radius - lane.obstacle.radius
                    free &= gap >= self._fair.lane_to_static
                return free

            margin = radius + self._fair.obstacle_to_border
            position = self._draw_point("static obstacles", clear, margin)
            self._static.append(self._cylinder(position, radius, self._color()))

    def _draw_points(self, start: Point) -> list[Point]:
        """Draw the via points of a tour, or the via points and the goal of a course."""
        mission = self._scenario.mission
        assert isinstance(mission, Tour | Course)
        shortest, longest = mission.leg
        course = isinstance(mission, Course)
        points: list[Point] = []
        for k in range(mission.via_points + course):
            last = points[-1] if points else start
            # A tour may return to earlier points, a course never does.
            others = [start, *points] if course else [last]
            is_goal = course and k == mission.via_points

            def clear(
                p: Array, last: Point = last, others: list[Point] = others, is_goal: bool = is_goal
            ) -> Mask:
                free: Mask = self._static_gap(p) >= self._fair.point_to_static
                free &= distance(p, others) >= shortest
                free &= distance(p, [last]) <= longest
                if is_goal:
                    for lane in self._lanes:
                        gap = distance(p, lane.ends) - lane.obstacle.radius
                        free &= gap >= self._fair.lane_to_goal
                return free

            points.append(self._draw_point("via points", clear))
        return points

    def _draw_mover(self, start: Point | None, points: Sequence[Point] | None) -> Lane:
        goal = points[-1] if points and self._has_goal() else None
        route = [start, *points] if start is not None and points else []
        for _ in range(MAX_LANES):
            self.tried += 1
            motion = self._draw_motion(route)
            if motion is None:
                continue
            lane = self._lane(motion, self._radius(), self._color())
            if self._lane_clear(lane, start, goal):
                return lane
        raise CrowdedError("moving obstacles")

    def _draw_motion(self, route: Sequence[Point]) -> MotionLaw | None:
        rng, world = self._rng, self._world
        x, y = rng.uniform(-self._half, self._half).tolist()
        if world.wall and route:
            # Between walls only movers near the route matter.
            walk = NominalWalk(route, 1.0)
            (along_x, along_y), _ = walk.at(walk.duration * float(rng.random()))
            offset = ROUTE_OFFSET * world.scale
            x = along_x + float(rng.uniform(-offset, offset))
            y = along_y + float(rng.uniform(-offset, offset))
        centre = (x, y)
        angle = float(rng.uniform(-pi, pi))
        length = float(rng.uniform(*world.lane))
        speed = float(rng.uniform(*world.speed_ratio)) * self._scenario.robot.speed.vx
        kind = world.motions[int(rng.integers(len(world.motions)))]
        if kind == "circle":
            sense = 1.0 if rng.random() < 0.5 else -1.0
            return Circle(centre, 0.5 * length, sense * speed, angle)
        if kind == "wander":
            return draw_wander(rng, centre, length, speed, world.scale)
        dx, dy = 0.5 * length * cos(angle), 0.5 * length * sin(angle)
        return Shuttle(
            (centre[0] - dx, centre[1] - dy),
            (centre[0] + dx, centre[1] + dy),
            speed,
            offset=float(rng.uniform(0.0, 2.0 * length)),
        )

    def _lane_clear(self, lane: Lane, start: Point | None, goal: Point | None) -> bool:
        radius = lane.obstacle.radius
        if (np.abs(lane.path) > self._half - radius - self._fair.obstacle_to_border).any():
            return False
        if (self._static_gap(lane.path) - radius < self._fair.lane_to_static).any():
            return False
        at_first = np.array([lane.obstacle.position])
        if (
            start is not None
            and distance(at_first, [start])[0] - radius < self._fair.start_to_mover
        ):
            return False
        if (
            goal is not None
            and (distance(lane.ends, [goal]) - radius < self._fair.lane_to_goal).any()
        ):
            return False
        return all(self._lanes_clear(lane, other) for other in self._lanes)

    def _lanes_clear(self, lane: Lane, other: Lane) -> bool:
        """Return whether two lanes keep their distance, or cross without a meeting."""
        room = self._fair.lane_to_lane + lane.obstacle.radius + other.obstacle.radius
        if (distance(lane.path, other.path) >= room).all():
            return True
        return (lane.crosses or other.crosses) and apart_at_all_times(
            lane, other, room, self._scenario.time_scale
        )

    def _draw_encounters(self, start: Point, points: Sequence[Point]) -> None:
        encounters = self._world.encounters
        if encounters.n == 0 or not points:
            return
        top_speed = self._scenario.robot.speed.vx
        walk = NominalWalk([start, *points], encounters.pace * top_speed)
        interval = walk.duration / encounters.n
        for k in range(encounters.n):
            for _ in range(MAX_LANES):
                time = interval * (k + float(self._rng.random()))
                speed = top_speed * float(self._rng.uniform(*encounters.speed_ratio))
                bearing = radians(float(self._rng.uniform(*encounters.bearing_deg)))
                side = 1.0 if self._rng.random() < 0.5 else -1.0
                radius = self._radius()
                point, velocity = walk.at(time)
                course = course_to(velocity, speed, side * bearing)
                if course is None:
                    continue
                reach = self._half - radius - 2.0 * self._fair.obstacle_to_border
                motion = passage_through(point, course, time, tuple(reach.tolist()))
                if motion is None or starts_near(motion, walk, radius + self._fair.start_to_mover):
                    continue
                lane = self._lane(motion, radius, self._color())
                # The mover stays at its end, which must not block a point.
                gaps = distance(lane.ends, points) - radius
                if (gaps >= self._fair.lane_to_goal).all() and self._lane_clear(lane, start, None):
                    self._lanes.append(lane)
                    break
            else:
                raise CrowdedError("movers on collision courses")

    def _draw_circle(self, ends: Sequence[Point]) -> None:
        circle, robot = self._world.circle, self._scenario.robot
        passages = draw_crossing(self._rng, circle, robot.speed.vx, ends, robot.radius)
        if len(passages) < circle.n:
            raise CrowdedError("people on the circle")
        self._lanes += [self._lane(p, circle.radius, self._color()) for p in passages]

    def _start_clear(self, p: Array) -> Mask:
        free: Mask = self._static_gap(p) >= self._fair.start_to_static
        for lane in self._lanes:
            gap = distance(p, [lane.obstacle.position]) - lane.obstacle.radius
            free &= gap >= self._fair.start_to_mover
        return free

    def _draw_point(
        self, objects: str, clear: Callable[[Array], Mask], margin: float | None = None
    ) -> Point:
        reach = self._half - (self._fair.point_to_border if margin is None else margin)
        if (reach <= 0.0).any():
            raise CrowdedError(objects)
        for _ in range(MAX_BATCHES):
            candidates = self._rng.uniform(-reach, reach, (BATCH, 2))
            free = np.flatnonzero(clear(candidates))
            if len(free):
                x, y = candidates[free[0]].tolist()
                return x, y
        raise CrowdedError(objects)

    def _static_gap(self, p: Array) -> Array:
        """Return the distance of points (n, 2) to the nearest static surface (n,) [m]."""
        if not self._static:
            return np.full(len(p), np.inf)
        centres = np.array([o.position for o in self._static])
        radii = np.array([o.radius for o in self._static])
        gaps = np.hypot(*(p[:, None] - centres[None]).transpose(2, 0, 1)) - radii
        nearest: Array = gaps.min(axis=1)
        return nearest

    def _radius(self) -> float:
        return float(self._rng.uniform(*self._world.radius))

    def _color(self) -> str:
        return COLORS[int(self._rng.integers(len(COLORS)))]
