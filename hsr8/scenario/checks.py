"""What a scenario must satisfy beyond the type and range of each key."""

from collections.abc import Iterator
from math import cos, hypot, radians, sin
from pathlib import Path as FilePath

from hsr8.scenario.fault_checks import fault_problems
from hsr8.scenario.key_lines import Path
from hsr8.scenario.mission import Course, Points, Tour, Walk
from hsr8.scenario.problem import Problem
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Point
from hsr8.scenario.world import ROBOT_RADIUS, CircleMover, Mover, ShuttleMover
from vision.errors import VisionError

MAX_CELLS = 1000
"""Largest side of the local map, in cells."""

# Section, and two of its keys of which the first must be below the second.
BELOW: tuple[tuple[Path, str, str], ...] = ((("vision",), "min_radius", "max_radius"),)
NOT_ABOVE: tuple[tuple[Path, str, str], ...] = (
    (("navigation", "mission"), "r_goal", "r_release"),
    (("navigation", "evaluation"), "d_nm", "d_fm"),
)


def check(scenario: Scenario) -> list[Problem]:
    """Everything that does not fit together, empty when all does."""
    return [
        *_speeds(scenario),
        *_colors(scenario),
        *_ordered(scenario),
        *_local_map(scenario),
        *_mission(scenario),
        *_command(scenario),
        *_disturbance(scenario),
        *fault_problems(scenario),
        *_inside(scenario),
        *_free(scenario),
        *_walls_free(scenario),
    ]


def _speeds(scenario: Scenario) -> Iterator[Problem]:
    speed, limits = scenario.robot.speed, scenario.walking.limits
    for axis in ("vx", "vx_backward", "vy", "wz"):
        given, limit = getattr(speed, axis), getattr(limits, axis)
        if given > limit:
            yield Problem(
                ("robot", "speed", axis),
                f"must be at most walking.limits.{axis} = {limit:g}, got {given:g}",
            )


def _colors(scenario: Scenario) -> Iterator[Problem]:
    """The file of the colour table is one."""
    path = scenario.vision.color_table
    if not path:
        return
    from vision.color_file import load_table  # noqa: PLC0415 (OpenCV takes its time)

    try:
        load_table(FilePath(path))
    except VisionError as error:
        yield Problem(("vision", "color_table"), str(error))


def _ordered(scenario: Scenario) -> Iterator[Problem]:
    """What begins does so before it ends, what is let go was held."""
    for section, lower, upper in BELOW:
        low, high = _bounds(scenario, section, lower, upper)
        if low >= high:
            yield Problem((*section, lower), f"{low:g} must be below {upper} = {high:g}")
    for section, lower, upper in NOT_ABOVE:
        low, high = _bounds(scenario, section, lower, upper)
        if low > high:
            yield Problem((*section, lower), f"{low:g} must not be above {upper} = {high:g}")


def _bounds(scenario: Scenario, section: Path, lower: str, upper: str) -> tuple[float, float]:
    part: object = scenario
    for key in section:
        part = getattr(part, str(key))
    return getattr(part, lower), getattr(part, upper)


def _local_map(scenario: Scenario) -> Iterator[Problem]:
    grid = scenario.belief.local_map
    if grid.size > MAX_CELLS * grid.cell:
        yield Problem(
            ("belief", "local_map", "cell"),
            f"a map of {grid.size:g} m has more than {MAX_CELLS} cells of {grid.cell:g} m a side",
        )


def _mission(scenario: Scenario) -> Iterator[Problem]:
    mission, criteria = scenario.mission, scenario.criteria
    before_goal: int | None = None  # via points; none where there is no goal
    if isinstance(mission, Course):
        before_goal = mission.via_points
    elif isinstance(mission, Points) and not mission.endless:
        before_goal = len(mission.points) - 1
    if criteria.goal_reached and before_goal is None:
        which = "an endless mission" if isinstance(mission, Points) else "a mission"
        yield Problem(("criteria", "goal_reached"), f'{which} of kind "{mission.kind}" has no goal')
    if before_goal is not None and criteria.min_via_points > before_goal:
        yield Problem(
            ("criteria", "min_via_points"),
            f"{criteria.min_via_points} are more than before the goal, {before_goal}",
        )
    if criteria.min_via_points and isinstance(mission, Walk):
        yield Problem(("criteria", "min_via_points"), 'a mission of kind "walk" has no via points')
    if scenario.plugin.planner and isinstance(mission, Walk):
        yield Problem(("plugin", "planner"), 'a mission of kind "walk" asks no planner')
    if scenario.world.encounters.n and isinstance(mission, Walk):
        yield Problem(
            ("world", "encounters", "n"), 'a mission of kind "walk" has no way to meet on'
        )
    if isinstance(mission, Points) and mission.endless and len(mission.points) == 1:
        yield Problem(("mission", "points"), "an endless tour needs at least 2 points, got 1")
    if isinstance(mission, Tour | Course):
        diagonal = hypot(*scenario.world.size)
        if mission.leg[0] > 0.7 * diagonal:
            yield Problem(
                ("mission", "leg"),
                f"legs of at least {mission.leg[0]:g} m do not fit into a field of "
                f"{scenario.world.size[0]:g} m x {scenario.world.size[1]:g} m",
            )


def _command(scenario: Scenario) -> Iterator[Problem]:
    walks = isinstance(scenario.mission, Walk)
    if walks and scenario.command.empty:
        yield Problem(
            ("command",),
            "nothing is asked: give vx, vy, wz [m/s, rad/s], footstep, random or stretch, "
            "for example --set command.vx=0.2",
        )
    if not walks and not scenario.command.empty:
        yield Problem(
            ("command",),
            f'a mission of kind "{scenario.mission.kind}" finds its own velocities; '
            'mission.kind = "walk" obeys them',
        )


def _disturbance(scenario: Scenario) -> Iterator[Problem]:
    disturbance = scenario.disturbance
    if scenario.robot.body != "full" and not disturbance.empty:
        yield Problem(
            ("disturbance",),
            f'a {scenario.robot.body} body has no dynamics to push; robot.body = "full" has',
        )


def _inside(scenario: Scenario) -> Iterator[Problem]:
    """Things placed by hand stand in the field."""
    half_x, half_y = (0.5 * side for side in scenario.world.size)
    for path, point, room in _places(scenario):
        if abs(point[0]) > half_x - room or abs(point[1]) > half_y - room:
            yield Problem(
                path,
                f"{list(point)} is outside the field, which reaches from "
                f"{[-half_x, -half_y]} to {[half_x, half_y]}"
                + (f", with {room:g} m to spare" if room else ""),
            )


def _places(scenario: Scenario) -> Iterator[tuple[Path, Point, float]]:
    world, mission = scenario.world, scenario.mission
    if scenario.robot.start.position is not None:
        yield ("robot", "start", "position"), scenario.robot.start.position, ROBOT_RADIUS
    for i, obstacle in enumerate(world.obstacle):
        yield ("world", "obstacle", i, "position"), obstacle.position, obstacle.radius
    for i, wall in enumerate(world.wall):
        yield ("world", "wall", i, "start"), wall.start, wall.radius
        yield ("world", "wall", i, "end"), wall.end, wall.radius
    for i, mover in enumerate(world.mover):
        if isinstance(mover, CircleMover):
            room = mover.path_radius + mover.radius
            yield ("world", "mover", i, "centre"), mover.centre, room
            continue
        yield ("world", "mover", i, "start"), mover.start, mover.radius
        if isinstance(mover, ShuttleMover):
            yield ("world", "mover", i, "end"), mover.end, mover.radius
    if isinstance(mission, Points):
        for i, point in enumerate(mission.points):
            yield ("mission", "points", i), point, ROBOT_RADIUS


def _free(scenario: Scenario) -> Iterator[Problem]:
    """No obstacle placed by hand stands on the robot, on a point, or in another obstacle."""
    world, mission = scenario.world, scenario.mission
    start = scenario.robot.start.position
    points = mission.points if isinstance(mission, Points) else ()
    for i, obstacle in enumerate(world.obstacle):
        path: Path = ("world", "obstacle", i, "position")
        reach = obstacle.radius + ROBOT_RADIUS
        if start is not None and _apart(obstacle.position, start) < reach:
            yield Problem(
                path,
                f"{list(obstacle.position)} is on the start of the robot at {list(start)}: "
                f"they must be {reach:g} m apart (radius {obstacle.radius:g} and robot "
                f"{ROBOT_RADIUS:g})",
            )
        for k, point in enumerate(points):
            if _apart(obstacle.position, point) < reach:
                yield Problem(path, f"stands on mission.points[{k}] = {list(point)}")
        for k, other in enumerate(world.obstacle[:i]):
            if _apart(obstacle.position, other.position) < obstacle.radius + other.radius:
                yield Problem(path, f"stands in world.obstacle[{k}] at {list(other.position)}")
    for i, mover in enumerate(world.mover):
        if isinstance(mover, ShuttleMover) and mover.start == mover.end:
            yield Problem(("world", "mover", i, "end"), "is the same point as start")
        key, begin = _begin(mover)
        if start is not None and _apart(begin, start) < mover.radius + ROBOT_RADIUS:
            yield Problem(
                ("world", "mover", i, key), f"begins on the start of the robot at {list(start)}"
            )


def _walls_free(scenario: Scenario) -> Iterator[Problem]:
    """No wall stands on the robot or on a point."""
    start, mission = scenario.robot.start.position, scenario.mission
    places = [("the start of the robot at", start)] if start is not None else []
    if isinstance(mission, Points):
        places += [(f"mission.points[{k}] =", point) for k, point in enumerate(mission.points)]
    for i, wall in enumerate(scenario.world.wall):
        reach = wall.radius + ROBOT_RADIUS
        for name, place in places:
            if any(_apart(cylinder, place) < reach for cylinder in wall.positions()):
                yield Problem(("world", "wall", i), f"stands on {name} {list(place)}")


def _begin(mover: Mover) -> tuple[str, Point]:
    """Where a mover is at time zero, and the key that says so."""
    if not isinstance(mover, CircleMover):
        return "start", mover.start
    angle = radians(mover.angle_deg)
    x, y = mover.centre
    return "centre", (x + mover.path_radius * cos(angle), y + mover.path_radius * sin(angle))


def _apart(a: Point, b: Point) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])
