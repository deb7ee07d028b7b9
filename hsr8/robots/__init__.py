"""Robots: description files, MJCF and URDF models, and their normal form."""
