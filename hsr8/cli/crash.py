"""Our own mistakes: people get one line, the traceback goes into a file."""

import tempfile
import traceback
from pathlib import Path
from types import TracebackType
from typing import Self

from hsr8.errors import Hsr8Error
from hsr8.recorder import atomic

FILE = "crash.txt"
EXPECTED = (Hsr8Error, BrokenPipeError)  # told by the command line itself


class InternalError(Hsr8Error):
    """A mistake in hsr8 itself."""


class CrashReport:
    """Turns unexpected exceptions into `InternalError` and keeps their traceback.

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
        if not isinstance(error, Exception) or isinstance(error, EXPECTED):
            return
        if isinstance(error.__cause__, KeyboardInterrupt):
            # Ctrl-C during the import of a compiled module arrives as an ImportError.
            raise KeyboardInterrupt from error
        what = str(error).strip().splitlines()
        raise InternalError(
            f"internal error, {type(error).__name__}: {what[0] if what else 'no message'}"
            f"\n  traceback: {self._keep(''.join(traceback.format_exception(error)))}"
        ) from error

    def _keep(self, trace: str) -> str:
        """Where the traceback is; a run folder on a full disk does not take it."""
        try:
            if self._folder is not None:
                return _write(self._folder, trace)
        except OSError:
            pass
        try:
            return _write(Path(tempfile.mkdtemp(prefix="hsr8-")), trace)
        except OSError as error:
            return f"cannot be written: {error}"


def _write(folder: Path, trace: str) -> str:
    file = folder / FILE
    atomic.write_text(file, trace)
    return str(file)
