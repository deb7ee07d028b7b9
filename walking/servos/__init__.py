"""Servo setpoints: inverse kinematics and feed-forward."""
