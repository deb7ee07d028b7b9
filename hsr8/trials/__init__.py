"""Trials of a robot: walks on an empty floor, to check and calibrate it."""
