"""Input: regular files of limited size, so that no pipe, device or sparse file stops a reader."""

import errno
import os
import stat

MAX_SIZE = 64_000_000  # of a text [byte]


def require_regular(path: str | os.PathLike[str]) -> None:
    """Require a regular file, or a link to one.

    Raises:
        OSError: there is no such file, or it is a folder, pipe, device or socket.
    """
    mode = os.stat(path).st_mode
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "not a regular file")


def read_bytes(path: str | os.PathLike[str], limit: int = MAX_SIZE) -> bytes:
    """Return the content of a regular file of at most `limit` bytes.

    Raises:
        OSError: it cannot be read, is not regular or is larger.
    """
    require_regular(path)
    with open(path, "rb") as file:
        content = file.read(limit + 1)
    if len(content) > limit:
        raise OSError(errno.EFBIG, f"larger than {limit / 1e6:g} MB")
    return content


def read_text(path: str | os.PathLike[str], limit: int = MAX_SIZE) -> str:
    """Return the UTF-8 text of a regular file; errors as `read_bytes`.

    Raises:
        UnicodeDecodeError: it is not UTF-8.
    """
    return read_bytes(path, limit).decode("utf-8")
