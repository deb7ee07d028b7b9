"""Errors that a user may encounter, each with the exit code of the command line."""

INTERRUPTED = 130  # exit code after Ctrl-C
MAX_LINE, KEPT_START = 1000, 100  # characters of a line of a message, and of its start


def escaped(text: str) -> str:
    """Return a text with an escape for every character that a terminal does not print.

    These are control characters and line ends, also those that change the direction of the text.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def escaped_lines(text: str) -> str:
    """Return a text of several lines with the escapes of `escaped`."""
    return "\n".join(map(escaped, text.split("\n")))


def shortened(line: str) -> str:
    """Return a line without its middle if it is long, such as one with a list of an argument."""
    if len(line) <= MAX_LINE:
        return line
    return f"{line[:KEPT_START]} ... {line[KEPT_START - MAX_LINE :]}"


class Hsr8Error(Exception):
    """Base of every error of the simulator; its message is meant for users.

    Args:
        message: one or more lines; characters that a terminal does not print are escaped, and long
            lines shortened.
    """

    exit_code = 3

    def __init__(self, message: str = "") -> None:
        super().__init__("\n".join(shortened(escaped(line)) for line in message.split("\n")))


class UsageError(Hsr8Error):
    """Invalid command line, argument or input."""

    exit_code = 2


class ScenarioError(UsageError):
    """Invalid scenario file or setting; the message has the place, the reason and the remedy."""


class ModelError(UsageError):
    """Missing or invalid robot or field model."""


class RenderingUnavailable(UsageError):
    """OpenGL that draws without a display is not available."""


class SimulationDiverged(Hsr8Error):
    """The physics diverged; the message has the tick, the body and the last command."""


class RecordingFailed(Hsr8Error):
    """The records of a run cannot be written: the disk is full, or the folder is gone."""
