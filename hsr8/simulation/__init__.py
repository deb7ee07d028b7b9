"""Simulation: the closed loop of world and robot, the robot side, and what they return."""
