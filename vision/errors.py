"""Errors of the vision package."""


class VisionError(ValueError):
    """Invalid input of vision."""
