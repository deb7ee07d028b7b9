"""Errors a user may meet, each with the exit code the command line gives it."""


class Hsr8Error(Exception):
    """Base of every error of the simulator; its message is meant for people."""

    exit_code = 3


class UsageError(Hsr8Error):
    """The command line asks for something that cannot be done as asked."""

    exit_code = 2


class ScenarioError(UsageError):
    """A scenario file or a setting is wrong: what, where, why, and what is allowed."""


class ModelError(UsageError):
    """A model file is missing or wrong: in which folder, and what MuJoCo or walking says."""


class RenderingUnavailable(UsageError):
    """No OpenGL that can draw without a display was found."""


class SimulationDiverged(Hsr8Error):
    """The physics blew up: names the tick, the body and the last command."""


class RecordingFailed(Hsr8Error):
    """What a run leaves behind cannot be written: the disk is full, or the folder is gone."""
