"""Circle crossing: people on a circle who walk to the opposite point.

Chen, Liu, Kreiss, Alahi, "Crowd-Robot Interaction", ICRA 2019, and its simulator CrowdNav
(``generate_circle_crossing_human``): each start is perturbed, and neither it nor its goal is near
another one.
"""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from hsr8.scenario.world import CircleCrossing
from hsr8.world.field.lane import distance
from hsr8.world.field.motion import Passage, Point

MAX_TRIES = 300  # per person


def draw_crossing(
    rng: np.random.Generator,
    circle: CircleCrossing,
    speed: float,
    robot_ends: Sequence[Point],
    robot_radius: float,
) -> list[Passage]:
    """Return the straight motions of the people, fewer than wanted if the circle is full.

    Args:
        rng: draws angles and perturbations.
        circle: number, sizes and distances.
        speed: `robot.speed.vx` [m/s].
        robot_ends: start and goal of the robot [m].
        robot_radius: radius of the robot [m].
    """
    taken = [(end, robot_radius) for end in robot_ends]
    passages: list[Passage] = []
    tries = 0
    while len(passages) < circle.n and tries < MAX_TRIES:
        tries += 1
        angle = float(rng.uniform(-pi, pi))
        dx, dy = (circle.perturbation * rng.uniform(-0.5, 0.5, 2)).tolist()
        x, y = circle.path_radius * cos(angle) + dx, circle.path_radius * sin(angle) + dy
        ends = np.array([(x, y), (-x, -y)])
        room = circle.radius + circle.gap
        if all((distance(ends, [point]) >= radius + room).all() for point, radius in taken):
            taken += [((x, y), circle.radius), ((-x, -y), circle.radius)]
            passages.append(Passage((x, y), (-x, -y), circle.speed_ratio * speed))
            tries = 0
    return passages
