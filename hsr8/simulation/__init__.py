"""Simulation: the closed loop of world and robot, the robot side, ticks and events."""
