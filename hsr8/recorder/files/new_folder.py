"""Folders that a command will make: whether it can, without making any."""

import errno
import os
from pathlib import Path

from hsr8.errors import UsageError


def require_new_folder(path: Path, what: str) -> None:
    """Make sure that the folder `path` can be made, or be written in where it is there.

    Args:
        path: of the folder.
        what: it is, for messages: ``run folder``.

    Raises:
        UsageError: it cannot.
    """
    try:
        there = path
        while not there.exists():
            there = there.parent
        if not there.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not os.access(there, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as error:
        raise UsageError(
            f"cannot write the {what} {path}: {error.strerror}; choose another with --out"
        ) from error
