"""Unexpected exceptions: one line for the user, the traceback in a file."""

import errno
import tempfile
import traceback
from bdb import BdbQuit
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from traceback import extract_tb

from hsr8.errors import Hsr8Error, UsageError
from hsr8.files import atomic
from hsr8.plugins.file import line_of

FILE = "crash.txt"
OUTPUT_ERRORS = (errno.EPIPE, errno.ENOSPC)
PATH_ERRORS = (errno.ENAMETOOLONG, errno.ELOOP)
IMPORT_ERRORS = (ImportError, OSError, MemoryError, UnicodeError)


class InternalError(Hsr8Error):
    """Error in hsr8 itself."""


@contextmanager
def crash_report(folder: Path | None = None) -> Iterator[None]:
    """Turn unexpected exceptions into errors and keep their traceback.

    Args:
        folder: folder of ``crash.txt``; a new temporary folder by default.

    Raises:
        UsageError: a plugin raised an exception, or the system rejects a path.
        Hsr8Error: a library cannot be imported, for example because memory is limited.
        InternalError: hsr8 raised an unexpected exception.
    """
    try:
        yield
    except Hsr8Error:
        raise
    except (Exception, SystemExit) as error:
        if isinstance(error, OSError) and error.errno in OUTPUT_ERRORS:
            raise
        if isinstance(error.__cause__, KeyboardInterrupt) or isinstance(error, BdbQuit):
            # Ctrl-C during the import of a compiled module arrives as an ImportError.
            raise KeyboardInterrupt from error
        if isinstance(error, OSError) and error.errno in PATH_ERRORS:
            raise UsageError(f"{error.filename}: {error.strerror}") from error
        if isinstance(error, UnicodeEncodeError) and error.reason == "surrogates not allowed":
            raise UsageError(f"{error.object}: not a name in UTF-8; expected another") from error
        if isinstance(error, IMPORT_ERRORS) and _is_importing(error):
            reason = f"{type(error).__name__}: {_first_line(error)}"
            raise Hsr8Error(f"a library cannot be imported: {reason}") from error
        plugin = line_of(error)
        if plugin is not None:
            raise UsageError(f"{plugin}: {_report(error, folder)}") from error
        if isinstance(error, SystemExit):
            raise
        raise InternalError(f"internal error, {_report(error, folder)}") from error


def _is_importing(error: BaseException) -> bool:
    """Return whether an exception comes from the code of a module that is imported."""
    return any(frame.name == "<module>" for frame in extract_tb(error.__traceback__))


def _first_line(error: BaseException) -> str:
    return [*str(error).strip().splitlines(), "no message"][0]


def _report(error: BaseException, folder: Path | None) -> str:
    """Write the traceback; return type, first line and file."""
    notes = getattr(error, "__notes__", [])
    summary = ", ".join([f"{type(error).__name__}: {_first_line(error)}", *notes])
    trace = "".join(traceback.format_exception(error))
    for parent in (folder, None):  # the disk of the run folder may be full
        try:
            file = (parent or Path(tempfile.mkdtemp(prefix="hsr8-"))) / FILE
            atomic.write_text(file, trace)
        except OSError:
            continue
        return f"{summary}\n  traceback: {file}"
    return f"{summary}\n  traceback: cannot be written"
