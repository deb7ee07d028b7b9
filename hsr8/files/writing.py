"""Errors of folders that cannot be written: that of a run, that of temporary files."""

import errno
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import RecordingFailed, UsageError

FAILED = "failed"  # exit reason of a run whose records could not be written
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)


@contextmanager
def writing(folder: Path | None) -> Iterator[None]:
    """Convert an `OSError` while writing into `folder` into `RecordingFailed`.

    Raises:
        RecordingFailed: a file could not be written; earlier contents stay.
    """
    try:
        yield
    except OSError as error:
        raise failure(folder or Path(), error.strerror or str(error)) from error


def failure(folder: Path, reason: str) -> RecordingFailed:
    """Return the error of a run whose `folder` cannot be written."""
    return RecordingFailed(f"cannot write the run folder {folder}: {reason}")


def require_temporary() -> None:
    """Check that temporary files can be written.

    Raises:
        UsageError: no folder for them can be written.
    """
    try:
        tempfile.gettempdir()
    except FileNotFoundError as error:
        raise UsageError(
            "TMPDIR: no folder for temporary files can be written, got /tmp, /var/tmp and the "
            "current folder; expected TMPDIR=DIR with a writable folder"
        ) from error
