"""World of a scenario for other tools: IR-SIM YAML, and an occupancy map as PGM and YAML.

IR-SIM (https://ir-sim.readthedocs.io) simulates discs in the plane. Both formats are YAML; values
are written as JSON, which is YAML, too.
"""

import json
from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.scenario.schema import Scenario
from hsr8.scenario.track import Track
from hsr8.world.field.layout import Beacon, Layout, Obstacle
from hsr8.world.field.motion import Circle, MotionLaw, Passage, Shuttle, Wander, pace

STEP = 0.1  # of IR-SIM [s]
CORNERS = 32  # of the polygon of a circle
ARRIVAL = 0.02  # distance at which a mover has reached a goal, in a world of scale 1 [m]
CELL = 0.02  # of the map, in a world of scale 1 [m]
OCCUPIED, FREE = 0, 254  # grey values of cells, as those of the ROS map server

Table = dict[str, Any]
Image = NDArray[np.uint8]


def irsim_yaml(layout: Layout, scenario: Scenario) -> str:
    """Return a world for IR-SIM: field, obstacles and beacons, movers, start and waypoints.

    The robot is a disc that moves in all directions at its speed limits. A mover follows the goals
    along its lane from the start; it does not appear, depart later, wait or yield. A crowd avoids
    by RVO.

    Args:
        layout: the world.
        scenario: radius and speed of the robot, duration of the run.

    Raises:
        UsageError: the world has recorded movers, which appear and leave.
    """
    if any(isinstance(mover.motion, Track) for mover in layout.movers):
        raise UsageError("--irsim: got recorded movers; expected movers on lanes")
    width, height = layout.field_size
    world = {
        "width": width,
        "height": height,
        "offset": [-0.5 * width, -0.5 * height],
        "step_time": STEP,
        "sample_time": STEP,
    }
    obstacles = [{**_disc(o), "color": _color(o)} for o in _cylinders(layout)]
    obstacles += [_mover(mover, layout, scenario.duration) for mover in layout.movers]
    lines = ["world:", *(f"  {key}: {json.dumps(value)}" for key, value in world.items())]
    lines += ["robot:", f"  - {json.dumps(_robot(layout, scenario))}", "obstacle:"]
    lines += [f"  - {json.dumps(obstacle)}" for obstacle in obstacles]
    return "\n".join(lines) + "\n"


def _cylinders(layout: Layout) -> tuple[Obstacle | Beacon, ...]:
    """Return static obstacles and beacons."""
    return (*layout.static, *layout.beacons)


def _robot(layout: Layout, scenario: Scenario) -> Table:
    speed = scenario.robot.speed
    robot: Table = {
        "kinematics": {"name": "omni"},
        "shape": {"name": "circle", "radius": scenario.robot.radius},
        "state": list(layout.start),
        "vel_min": [-speed.vx_backward, -speed.vy],
        "vel_max": [speed.vx, speed.vy],
        "goal_threshold": scenario.navigation.mission.r_goal,
    }
    heading = layout.goal_heading or 0.0
    goals = [[x, y, heading] for x, y in layout.waypoints.tolist()]
    return {**robot, "goal": [goals]} if goals else robot


def _disc(cylinder: Obstacle | Beacon) -> Table:
    return {
        "shape": {"name": "circle", "radius": cylinder.radius},
        "state": [*cylinder.position, 0.0],
    }


def _color(cylinder: Obstacle | Beacon) -> str:
    return cylinder.color if isinstance(cylinder, Obstacle) else cylinder.bottom


def _mover(mover: Obstacle, layout: Layout, duration: float) -> Table:
    motion = mover.motion
    assert motion is not None
    goals, repeats = _goals(motion, duration)
    behavior = "rvo" if layout.reactions.crowd else "dash"
    speed = pace(motion)
    limits = {"vxmax": speed, "vymax": speed} if layout.reactions.crowd else {}
    return {
        **_disc(replace(mover, position=motion.position(0.0))),
        "kinematics": {"name": "omni"},
        "goal": [[[x, y, 0.0] for x, y in goals]],
        "goal_threshold": ARRIVAL * layout.scale,
        "vel_min": [-speed, -speed],
        "vel_max": [speed, speed],
        "behavior": {"name": behavior, "loop": repeats, **limits},
        "color": mover.color,
    }


def _goals(motion: MotionLaw, duration: float) -> tuple[list[tuple[float, float]], bool]:
    """Return the goals along a lane, in order from time zero [m], and whether they repeat."""
    if isinstance(motion, Passage):
        return [motion.end], False
    if isinstance(motion, Shuttle):
        ends = [motion.end, motion.start]
        returns = motion.offset % (2.0 * motion.length) > motion.length
        return (ends[::-1] if returns else ends), True
    if isinstance(motion, Circle):
        x, y = motion.centre
        sense = 1.0 if motion.speed > 0.0 else -1.0
        angles = [motion.angle + sense * 2.0 * pi * k / CORNERS for k in range(1, CORNERS + 1)]
        return [(x + motion.radius * cos(a), y + motion.radius * sin(a)) for a in angles], True
    if isinstance(motion, Wander):
        first = int(motion.offset % motion.length // motion.side) + 1
        return [*motion.track[first:], *motion.track[:first]], True
    return [motion.position(duration)], False


def occupancy_map(layout: Layout) -> Image:
    """Return the map of the field: OCCUPIED and FREE cells (rows, columns).

    The first row is at the maximum y. Static obstacles and beacons are occupied; movers are not in
    the map.
    """
    cell = CELL * layout.scale
    cylinders = _cylinders(layout)
    reach = [np.abs(c.position) + c.radius for c in cylinders]
    half = np.max([0.5 * np.array(layout.field_size), *reach], axis=0)
    columns, rows = np.ceil(2.0 * half / cell - 1e-9).astype(int).tolist()
    half_x, half_y = 0.5 * columns * cell, 0.5 * rows * cell
    x = -half_x + (np.arange(columns) + 0.5) * cell
    y = half_y - (np.arange(rows) + 0.5) * cell
    image = np.full((rows, columns), FREE, np.uint8)
    for cylinder in cylinders:
        (cx, cy), radius = cylinder.position, cylinder.radius
        image[(x - cx) ** 2 + (y[:, None] - cy) ** 2 <= radius**2] = OCCUPIED
    return image


def write_map(layout: Layout, file: Path, image_file: Path) -> None:
    """Write the map of the ROS map server: a YAML file and its image.

    Args:
        layout: the world.
        file: new YAML file.
        image_file: new PGM file; the YAML file refers to its name.

    Raises:
        OSError: a file cannot be written.
    """
    image, cell = occupancy_map(layout), CELL * layout.scale
    rows, columns = image.shape
    image_file.write_bytes(f"P5\n{columns} {rows}\n255\n".encode() + image.tobytes())
    values = {
        "image": image_file.name,
        "mode": "trinary",
        "resolution": cell,
        "origin": [-0.5 * columns * cell, -0.5 * rows * cell, 0.0],
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    lines = [f"{key}: {json.dumps(value)}" for key, value in values.items()]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
