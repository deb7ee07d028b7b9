"""Belief: detections become the robot's pose, tracks of obstacles and a map of what was seen."""
