"""Files of a run folder that grow during a run, and the error when one cannot be written."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import RecordingFailed

FAILED = "failed"  # exit reason of a run whose records could not be written
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Convert an `OSError` while writing into `folder` into `RecordingFailed`.

    Raises:
        RecordingFailed: a file could not be written; earlier contents stay.
    """
    try:
        yield
    except OSError as error:
        raise failure(folder, error.strerror or str(error)) from error


def failure(folder: Path, reason: str) -> RecordingFailed:
    """Return the error of a run whose `folder` cannot be written."""
    return RecordingFailed(f"cannot write the run folder {folder}: {reason}")


class GrowingFile:
    """Binary file that records are appended to.

    Args:
        path: file to create.
        head: first bytes of the file.

    Raises:
        RecordingFailed: here and in every method, the file cannot be written.
    """

    def __init__(self, path: Path, head: bytes = b"") -> None:
        self._folder = path.parent
        with writing(self._folder):
            self._file = path.open("wb")
            self._file.write(head)

    def write(self, content: bytes) -> None:
        """Append `content`; it is buffered."""
        with writing(self._folder):
            self._file.write(content)

    def flush(self) -> None:
        """Pass all content to the operating system."""
        with writing(self._folder):
            self._file.flush()

    def close(self) -> None:
        """Flush and close the file."""
        with writing(self._folder):
            self._file.close()
