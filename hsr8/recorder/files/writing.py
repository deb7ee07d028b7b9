"""Files of a run that can no longer be written: one error, whichever file it was."""

import errno
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import RecordingFailed

FAILED = "failed"  # how a run ended whose records could not be written
PROBE = 65536  # more than a full disk may still have in odd blocks [byte]
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Turns what the system says about a write into `RecordingFailed`.

    Args:
        folder: of the run.

    Raises:
        RecordingFailed: a file could not be written; what was written before stays.
    """
    try:
        yield
    except OSError as error:
        raise failure(folder, error.strerror or str(error)) from error


def failure(folder: Path, reason: str) -> RecordingFailed:
    """The error of a run whose `folder` takes no more."""
    return RecordingFailed(f"cannot write the run folder {folder}: {reason}")


def refusal(folder: Path, said: str) -> RecordingFailed:
    """The error of a library that `said` no reason of the system: the system is asked for it.

    A little more is written into `folder`, to a file without a name; where that goes well, what
    the library said must do.
    """
    try:
        with writing(folder), tempfile.TemporaryFile(dir=folder, buffering=0) as probe:
            probe.write(bytes(PROBE))
    except RecordingFailed as error:
        return error
    return failure(folder, said)
