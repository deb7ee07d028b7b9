"""Gaze control: chooses pan and tilt of the head from the belief."""
