"""Errors of the vision package."""


class VisionError(ValueError):
    """Vision was handed something it cannot work on; the message says what and why."""
