"""``hsr8 robot``: dispatch to the commands for robots."""

from importlib import import_module

from hsr8.cli.options import Robot


def main(options: Robot) -> int:
    """Run one of the commands."""
    kind = type(options.action).__name__.removeprefix("Robot").lower()
    code: int = import_module(f"hsr8.cli.robot_{kind}").main(options.action)
    return code
