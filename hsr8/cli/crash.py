"""What nobody expected to fail: people get one line, the traceback goes into a file."""

import tempfile
import traceback
from pathlib import Path
from types import TracebackType
from typing import Self

from hsr8.errors import Hsr8Error, UsageError
from hsr8.plugin_file import line_of
from hsr8.recorder.files import atomic

FILE = "crash.txt"
EXPECTED = (Hsr8Error, BrokenPipeError)  # told by the command line itself


class InternalError(Hsr8Error):
    """A mistake in hsr8 itself."""


class CrashReport:
    """Turns unexpected exceptions into errors that people understand; keeps their traceback.

    Those from a planner or a gaze of one's own become a `UsageError`, all others an
    `InternalError`.

    Args:
        folder: where ``crash.txt`` goes; a new temporary folder by default.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if not isinstance(error, Exception | SystemExit) or isinstance(error, EXPECTED):
            return
        if isinstance(error.__cause__, KeyboardInterrupt):
            # Ctrl-C during the import of a compiled module arrives as an ImportError.
            raise KeyboardInterrupt from error
        own = line_of(error)
        if own is not None:
            raise UsageError(f"{own}: {self._told(error)}") from error
        if isinstance(error, Exception):
            raise InternalError(f"internal error, {self._told(error)}") from error

    def _told(self, error: BaseException) -> str:
        return f"{_what(error)}\n  traceback: {self._keep(error)}"

    def _keep(self, error: BaseException) -> str:
        """Where the traceback is; a run folder on a full disk does not take it."""
        trace = "".join(traceback.format_exception(error))
        try:
            if self._folder is not None:
                return _write(self._folder, trace)
        except OSError:
            pass
        try:
            return _write(Path(tempfile.mkdtemp(prefix="hsr8-")), trace)
        except OSError as failure:
            return f"cannot be written: {failure}"


def _what(error: BaseException) -> str:
    """Its kind, its first line, and when it happened in a run."""
    first, *_ = [*str(error).strip().splitlines(), "no message"]
    when = getattr(error, "__notes__", [])
    return ", ".join([f"{type(error).__name__}: {first}", *when])


def _write(folder: Path, trace: str) -> str:
    file = folder / FILE
    atomic.write_text(file, trace)
    return str(file)
