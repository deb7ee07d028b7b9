"""Minimum distances of a fair world, between surfaces except where a point is named."""

from math import radians

from hsr8.scenario.world import ROBOT_RADIUS

STATIC_GAP = 2.0 * ROBOT_RADIUS + 0.16  # between static obstacles [m]
START_TO_STATIC = 0.35  # from the start, a point [m]
START_TO_MOVER = 0.90  # from the start, a point [m]
POINT_TO_STATIC = ROBOT_RADIUS + 0.25  # from via points and goal [m]
LANE_TO_STATIC = 0.30  # between a mover and a static obstacle [m]
LANE_TO_LANE = 0.05  # between two movers [m]
LANE_TO_GOAL = ROBOT_RADIUS + 0.30  # between a reversing mover and the goal, a point [m]
POINT_TO_BORDER = 0.35  # from the border to points that the robot must reach [m]
OBSTACLE_TO_BORDER = 0.05  # from the border to obstacles [m]
START_TURN = radians(60.0)  # maximum angle between the start heading and the first via point [rad]
