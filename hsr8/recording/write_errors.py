"""Errors of a run folder that cannot be written."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import RecordingFailed

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
