"""Gaze: the belief becomes the direction in which the camera looks."""
