"""Unexpected exceptions: one line for the user, the traceback in a file."""

import errno
import tempfile
import traceback
from pathlib import Path
from types import TracebackType
from typing import Self

from hsr8.errors import Hsr8Error, UsageError
from hsr8.plugin_file import line_of
from hsr8.recorder.files import atomic

FILE = "crash.txt"
OUTPUT_ERRORS = (errno.EPIPE, errno.ENOSPC)


class InternalError(Hsr8Error):
    """Error in hsr8 itself."""


class CrashReport:
    """Context that turns unexpected exceptions into errors and keeps their traceback.

    Exceptions of a user-defined planner or gaze become a `UsageError`, all others an
    `InternalError`.

    Args:
        folder: of ``crash.txt``; a new temporary folder by default.
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
        output_failed = isinstance(error, OSError) and error.errno in OUTPUT_ERRORS
        if not isinstance(error, Exception | SystemExit) or output_failed:
            return
        if isinstance(error, Hsr8Error):
            return
        if isinstance(error.__cause__, KeyboardInterrupt):
            # Ctrl-C during the import of a compiled module arrives as an ImportError.
            raise KeyboardInterrupt from error
        plugin = line_of(error)
        if plugin is not None:
            raise UsageError(f"{plugin}: {self._report(error)}") from error
        if isinstance(error, Exception):
            raise InternalError(f"internal error, {self._report(error)}") from error

    def _report(self, error: BaseException) -> str:
        """Write the traceback; return type, first line and file."""
        first, *_ = [*str(error).strip().splitlines(), "no message"]
        notes = getattr(error, "__notes__", [])
        summary = ", ".join([f"{type(error).__name__}: {first}", *notes])
        trace = "".join(traceback.format_exception(error))
        failure: OSError | None = None
        for folder in (self._folder, None):  # the disk of the run folder may be full
            try:
                file = (folder or Path(tempfile.mkdtemp(prefix="hsr8-"))) / FILE
                atomic.write_text(file, trace)
            except OSError as unwritable:
                failure = unwritable
            else:
                return f"{summary}\n  traceback: {file}"
        return f"{summary}\n  traceback: cannot be written: {failure}"
