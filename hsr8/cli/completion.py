"""``hsr8 completion``: the commands and options, for the tab key of a shell."""

from hsr8.cli.options import Completion


def main(options: Completion) -> int:
    """Print the script."""
    from hsr8.cli.main import parse  # noqa: PLC0415  the command line knows all its commands

    try:
        parse(["--tyro-print-completion", options.shell])
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else 0
    return 0
