"""Consistency of a scenario beyond the type and range of each key."""

from collections.abc import Iterator
from math import cos, hypot, radians, sin
from pathlib import Path as FilePath

from hsr8.keys import Path
from hsr8.mistakes import Mistake
from hsr8.scenario.fault import MoverAppears
from hsr8.scenario.fault_checks import fault_problems, robot_problems
from hsr8.scenario.mission import Course, Points, Tour, Walk
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Point
from hsr8.scenario.track_checks import track_problems
from hsr8.scenario.world import MAX_CYLINDERS, CircleMover, LineMover, ShuttleMover, TrackMover
from vision.errors import VisionError

MAX_CELLS = 1000
"""Maximum side of the local map, in cells."""
MAX_LEG_RATIO = 0.7
"""Maximum of the shortest leg of a drawn mission, relative to the diagonal of the field [1]."""


def check(scenario: Scenario) -> Iterator[Mistake]:
    """Yield all inconsistencies."""
    checks = (
        *(_parameters, _mission, _command, fault_problems, robot_problems),
        *(_outside, _gaps, _movers, _crowd),
    )
    for problems in checks:
        yield from problems(scenario)
    if walls := [*_long_walls(scenario)]:
        yield from walls
    else:
        yield from _overlaps(scenario)
        yield from track_problems(scenario)


def _parameters(scenario: Scenario) -> Iterator[Mistake]:
    """Parameters that contradict each other."""
    speed, limits, navigation = scenario.robot.speed, scenario.walking.limits, scenario.navigation
    for axis in ("vx", "vx_backward", "vy", "wz"):
        given, limit = getattr(speed, axis), getattr(limits, axis)
        if given > limit:
            yield Mistake(
                ("robot", "speed", axis),
                f"must be at most walking.limits.{axis} = {limit:g}, got {given:g}",
            )
    for section, lower, upper in (
        ("mission", "r_goal", "r_release"),
        ("evaluation", "d_nm", "d_fm"),
    ):
        part = getattr(navigation, section)
        low, high = getattr(part, lower), getattr(part, upper)
        if low > high:
            yield Mistake(
                ("navigation", section, lower), f"must be at most {upper} = {high:g}, got {low:g}"
            )
    grid = scenario.belief.local_map
    if grid.size > MAX_CELLS * grid.cell:
        yield Mistake(
            ("belief", "local_map", "cell"),
            f"must be at least size / {MAX_CELLS} = {grid.size / MAX_CELLS:g}, got {grid.cell:g}",
        )
    if scenario.vision.color_table:
        from vision.color import load_table  # noqa: PLC0415 (OpenCV loads slowly)

        try:
            load_table(FilePath(scenario.vision.color_table))
        except VisionError as error:
            yield Mistake(("vision", "color_table"), str(error))
    fixed = navigation.gaze.mode == "fixed" and not scenario.plugin.gaze
    if scenario.camera.source == "neck-reach" and not fixed:
        yield Mistake(("camera", "source"), 'neck-reach requires navigation.gaze.mode = "fixed"')
    if scenario.robot.body != "full" and not scenario.disturbance.empty:
        yield Mistake(("disturbance",), 'requires robot.body = "full"')


def _mission(scenario: Scenario) -> Iterator[Mistake]:
    mission, criteria, size = scenario.mission, scenario.criteria, scenario.world.size
    kind = f'a mission of kind "{mission.kind}"'
    before_goal: int | None = None  # via points; None without a goal
    if isinstance(mission, Course):
        before_goal = mission.via_points
    elif isinstance(mission, Points) and not mission.endless:
        before_goal = len(mission.points) - 1
    if criteria.goal_reached and before_goal is None:
        endless = "an endless mission" if isinstance(mission, Points) else kind
        yield Mistake(("criteria", "goal_reached"), f"{endless} has no goal")
    if before_goal is not None and criteria.min_via_points > before_goal:
        yield Mistake(
            ("criteria", "min_via_points"),
            f"must be at most the number of via points before the goal, {before_goal}, "
            f"got {criteria.min_via_points}",
        )
    if isinstance(mission, Walk):
        if criteria.min_via_points:
            yield Mistake(("criteria", "min_via_points"), f"{kind} has no via points")
        if scenario.plugin.planner:
            yield Mistake(("plugin", "planner"), f"{kind} has no planner")
        if scenario.world.encounters.n:
            yield Mistake(("world", "encounters", "n"), f"{kind} has no route to encounter on")
    if isinstance(mission, Points) and mission.endless and len(mission.points) == 1:
        yield Mistake(("mission", "points"), "an endless tour needs at least 2 points, got 1")
    if isinstance(mission, Tour | Course) and mission.leg[0] > MAX_LEG_RATIO * hypot(*size):
        yield Mistake(
            ("mission", "leg"),
            f"legs of at least {mission.leg[0]:g} m do not fit into a field of "
            f"{size[0]:g} m x {size[1]:g} m",
        )


def _command(scenario: Scenario) -> Iterator[Mistake]:
    walks = isinstance(scenario.mission, Walk)
    if walks and scenario.command.empty:
        yield Mistake(
            ("command",),
            "is missing; expected vx, vy, wz, footstep, random or stretch, "
            "for example --set command.vx=0.2",
        )
    if not walks and not scenario.command.empty:
        yield Mistake(
            ("command",), f'requires mission.kind = "walk", got "{scenario.mission.kind}"'
        )


def _outside(scenario: Scenario) -> Iterator[Mistake]:
    """Places outside the field."""
    half_x, half_y = (0.5 * side for side in scenario.world.size)
    for path, point, room in _places(scenario):
        if abs(point[0]) > half_x - room or abs(point[1]) > half_y - room:
            yield Mistake(
                path,
                f"{list(point)} is outside the field from {[-half_x, -half_y]} to "
                f"{[half_x, half_y]}" + (f", less {room:g} m at each side" if room else ""),
            )


def _places(scenario: Scenario) -> Iterator[tuple[Path, Point, float]]:
    """Key of each place, its point, and the distance to keep from the border [m]."""
    world, mission = scenario.world, scenario.mission
    if scenario.robot.start.position is not None:
        yield ("robot", "start", "position"), scenario.robot.start.position, scenario.robot.radius
    for i, obstacle in enumerate(world.obstacle):
        yield ("world", "obstacle", i, "position"), obstacle.position, obstacle.radius
    for i, wall in enumerate(world.wall):
        yield ("world", "wall", i, "start"), wall.start, wall.radius
        yield ("world", "wall", i, "end"), wall.end, wall.radius
    for i, mover in enumerate(world.mover):
        if isinstance(mover, TrackMover):
            continue
        if isinstance(mover, CircleMover):
            room = mover.path_radius + mover.radius
            yield ("world", "mover", i, "centre"), mover.centre, room
            continue
        yield ("world", "mover", i, "start"), mover.start, mover.radius
        if isinstance(mover, ShuttleMover):
            yield ("world", "mover", i, "end"), mover.end, mover.radius
    if isinstance(mission, Points):
        for i, point in enumerate(mission.points):
            yield ("mission", "points", i), point, scenario.robot.radius


def _gaps(scenario: Scenario) -> Iterator[Mistake]:
    """Gaps in walls wide enough for the robot."""
    diameter = 2.0 * scenario.robot.radius
    for i, wall in enumerate(scenario.world.wall):
        if wall.gap is not None and wall.gap >= diameter:
            yield Mistake(
                ("world", "wall", i, "gap"),
                f"must be less than 2 robot.radius = {diameter:g}, got {wall.gap:g}",
            )


def _long_walls(scenario: Scenario) -> Iterator[Mistake]:
    """Walls of too many cylinders."""
    for i, wall in enumerate(scenario.world.wall):
        n = wall.intervals(scenario.robot.radius) + 1
        if n > MAX_CYLINDERS:
            yield Mistake(
                ("world", "wall", i, "radius"),
                f"too many cylinders, got {n}; expected at most {MAX_CYLINDERS}, from a larger "
                "radius or gap",
            )


def _overlaps(scenario: Scenario) -> Iterator[Mistake]:
    """Static obstacles on the start of the robot, on a point of the mission or on each other."""
    world, robot, mission = scenario.world, scenario.robot, scenario.mission
    start = robot.start.position
    places = [("robot.start.position", start)] if start is not None else []
    if isinstance(mission, Points):
        places += [(f"mission.points[{k}]", point) for k, point in enumerate(mission.points)]
    cylinders: list[tuple[Path, float, list[Point]]] = [
        (("world", "wall", i), wall.radius, wall.positions(robot.radius))
        for i, wall in enumerate(world.wall)
    ]
    for i, a in enumerate(world.obstacle):
        path: Path = ("world", "obstacle", i, "position")
        cylinders.append((path, a.radius, [a.position]))
        for k, b in enumerate(world.obstacle[:i]):
            if _distance(a.position, b.position) < a.radius + b.radius:
                yield Mistake(path, f"overlaps world.obstacle[{k}] at {list(b.position)}")
    for path, radius, positions in cylinders:
        reach = radius + robot.radius
        for name, point in places:
            if any(_distance(position, point) < reach for position in positions):
                yield Mistake(path, f"must be at least {reach:g} m from {name} = {list(point)}")


def _movers(scenario: Scenario) -> Iterator[Mistake]:
    start = scenario.robot.start.position
    for i, mover in enumerate(scenario.world.mover):
        if isinstance(mover, TrackMover):
            continue
        if isinstance(mover, ShuttleMover) and mover.start == mover.end:
            yield Mistake(("world", "mover", i, "end"), "must differ from start")
        key, first = _initial_position(mover)
        if start is not None and _distance(first, start) < mover.radius + scenario.robot.radius:
            yield Mistake(("world", "mover", i, key), "begins at the start of the robot")


def _crowd(scenario: Scenario) -> Iterator[Mistake]:
    """Movers without ends, and reactions of single movers, in a crowd."""
    world, key = scenario.world, ("world", "crowd")
    if world.crowd == "none":
        return
    placed = {mover.motion for mover in world.mover} - {"shuttle"}
    drawn = set(world.motions) - {"shuttle"} if world.n_moving else set()
    for motion in sorted(placed | drawn):
        yield Mistake(key, f"movers need two ends, got motion {motion!r}; expected shuttle")
    if world.yield_fraction:
        yield Mistake(("world", "yield_fraction"), 'requires world.crowd = "none"')
    if any(isinstance(fault, MoverAppears) for fault in scenario.fault):
        yield Mistake(("fault",), 'mover-appears requires world.crowd = "none"')


def _initial_position(mover: ShuttleMover | LineMover | CircleMover) -> tuple[str, Point]:
    """Key and position of a mover at time zero."""
    if not isinstance(mover, CircleMover):
        return "start", mover.start
    angle = radians(mover.angle_deg)
    x, y = mover.centre
    return "centre", (x + mover.path_radius * cos(angle), y + mover.path_radius * sin(angle))


def _distance(a: Point, b: Point) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])
