"""Minimum distances of a fair world, between surfaces except where a point is named."""

from dataclasses import dataclass
from math import radians
from typing import Self

from hsr8.scenario.schema import Scenario

START_TURN = radians(60.0)  # maximum angle between the start heading and the first via point [rad]


@dataclass(frozen=True, slots=True)
class FairDistances:
    """Minimum distances.

    Attributes:
        static_gap: between static obstacles [m].
        start_to_static: from the start, a point [m].
        start_to_mover: from the start, a point [m].
        point_to_static: from via points and goal [m].
        lane_to_static: between a mover and a static obstacle [m].
        lane_to_lane: between two movers [m].
        lane_to_goal: between a reversing mover and the goal, a point [m].
        point_to_border: from the border to points that the robot must reach [m].
        obstacle_to_border: from the border to obstacles [m].
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
