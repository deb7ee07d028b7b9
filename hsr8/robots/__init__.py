"""Robots: description files, models in MJCF or URDF, and the normal form that the simulator uses."""
